# SPDX-License-Identifier: GPL-3.0-or-later
"""What callers give is read once at the entry: empty shapes, masks, wrong types and sizes."""
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import leapmap

CYCLE = {}
CYCLE["a"] = CYCLE


@pytest.mark.parametrize("friction", ["sticking", "coulomb"])
@pytest.mark.parametrize("shape", [(0,), (0, 3), (3, 0)])
def test_no_designs_have_no_derivatives_and_no_outcomes(friction, shape):
    gradients = leapmap.gradient(slope=np.zeros(shape), friction=friction)
    assert gradients and all(values.shape == shape for values in gradients.values())
    assert leapmap.solve(slope=np.zeros(shape), friction=friction).jump_height.shape == shape
    problem = leapmap.DesignProblem(slope={"from": 0.1, "to": 0.5}, maximize="jump_height")
    assert len(problem.judge([])[0]) == 0 and len(problem.batch_fitness([])) == 0


MASKED = np.ma.masked_array([0.4, 0.2], mask=[0, 1])


@pytest.mark.parametrize(
    "call",
    [
        lambda: leapmap.solve(slope=MASKED),
        lambda: leapmap.gradient(slope=MASKED),
        lambda: leapmap.sweep({"design": {"slope": MASKED}}),
        lambda: leapmap.sweep({}, slope=MASKED),
        lambda: leapmap.sweep({"design": {"slope": {"values": MASKED}}}),
        lambda: leapmap.sweep({}, slope=np.ma.masked),
        lambda: leapmap.fit(
            {"t": np.arange(9) * 0.01, "phi": np.ma.masked_array(np.full(9, 3.1), np.arange(9) == 4)},
            slope=0.4,
        ),
        lambda: leapmap.design(slope={"from": 0.1, "to": 0.5}, mass_ratio=MASKED, maximize="jump_height"),
    ],
)
def test_masked_values_are_refused_everywhere(call):
    with pytest.raises(ValueError, match="slope|phi|mass_ratio"):
        call()


def test_a_mask_that_hides_nothing_is_none():
    plain, masked = [0.4, 0.2], np.ma.masked_array([0.4, 0.2], mask=[0, 0])
    assert (leapmap.solve(slope=masked).jump_height == leapmap.solve(slope=plain).jump_height).all()
    assert (leapmap.sweep({"design": {"slope": masked}}).slope == plain).all()


@pytest.mark.parametrize(
    "call, name",
    [
        (lambda: leapmap.solve(friction=None), "friction"),
        (lambda: leapmap.solve(method=None), "method"),
        (lambda: leapmap.solve(tolerance="x"), "tolerance"),
        (lambda: leapmap.solve(threads=float("nan")), "threads"),
        (lambda: leapmap.solve(threads=float("inf")), "threads"),
        (lambda: leapmap.solve(jumps=True), "jumps"),
        (lambda: leapmap.solve(jumps=10**30), "jumps"),
        (lambda: leapmap.trace(interval=None), "interval"),
        (lambda: leapmap.gradient(of=None), "of"),
        (lambda: leapmap.scatter(scatter="x"), "scatter"),
        (lambda: leapmap.scatter(scatter={"slope": {"normal": 0.1}}, goal="x"), "goal"),
        (lambda: leapmap.sweep({"design": CYCLE}), "a"),
        (lambda: leapmap.sweep({}, threads=1.5), "threads"),
        (lambda: leapmap.sweep({}, threads=-3), "threads"),
        (lambda: leapmap.sweep({}, threads="2"), "threads"),
        (lambda: leapmap.sweep(""), "spec"),
        (lambda: leapmap.design(maximize=None), "maximize"),
        (lambda: leapmap.design(maximize="jump_height", slope={"from": 0.1, "to": 0.2}, seed=1.7), "seed"),
        (lambda: leapmap.fit({"t": [1], 3: [1]}), "data"),
        (lambda: leapmap.fit("x.csv", model=None), "model"),
        (lambda: leapmap.fit("x.csv", error=float("nan")), "error"),
        (lambda: leapmap.design(maximize="jump_height", slope=[0.1, 0.3]), "slope"),
    ],
)
def test_a_wrong_argument_is_refused_by_its_name(call, name):
    with pytest.raises((ValueError, TypeError), match=name):
        call()


def test_whole_numbers_of_numpy_pass():
    assert leapmap.solve(jumps=np.int64(2)).jumps == leapmap.solve(jumps=2).jumps


def test_errors_hold_no_control_characters_and_are_never_empty(tmp_path):
    (tmp_path / "x.csv").write_bytes(b"\xff\xfes\0l\0o\0")
    with pytest.raises(ValueError, match="UTF-16"):
        leapmap.fit(str(tmp_path / "x.csv"))
    with pytest.raises(ValueError, match=r"\\x00"):
        leapmap.solve(slope="2\0 deg")


def test_a_sweep_larger_than_memory_is_refused_before_it_begins(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    begin = time.monotonic()
    axis = np.linspace(0.1, 0.5, 5000)
    with pytest.raises((MemoryError, OSError), match="GB"):
        leapmap.sweep({"design": {"slope": axis, "mass_ratio": 1 + axis, "offset_ratio": axis[:1000]}})
    assert time.monotonic() - begin < 20 and not list(tmp_path.iterdir())


def test_sigterm_leaves_no_temporary_map(tmp_path):
    script = ("import leapmap, numpy as np; leapmap.sweep({'design': {'slope': np.linspace(.1, .8, 2000), "
              "'mass_ratio': np.linspace(1, 9, 2000)}})")
    process = subprocess.Popen(
        [sys.executable, "-c", script],
        env=dict(os.environ, TMPDIR=str(tmp_path), PYTHONPATH=str(Path(leapmap.__file__).parents[1])),
        stderr=subprocess.DEVNULL,
    )
    for _ in range(300):
        if any(tmp_path.iterdir()):
            break
        time.sleep(0.05)
    assert any(tmp_path.iterdir()), "or it tests nothing"
    time.sleep(0.3)
    process.send_signal(signal.SIGTERM)
    assert process.wait(60) == -signal.SIGTERM
    assert not list(tmp_path.iterdir())


def test_another_python_is_told_which_one_to_use(tmp_path):
    package = tmp_path / "leapmap"
    package.mkdir()
    source = os.path.dirname(leapmap.__file__)
    for name in os.listdir(source):
        if name.endswith(".py"):
            (package / name).write_text(open(os.path.join(source, name)).read())
    (package / "_core.cpython-399-x86_64-linux-gnu.so").write_bytes(b"")
    done = subprocess.run(
        [sys.executable, "-c", "import leapmap"],
        env=dict(os.environ, PYTHONPATH=str(tmp_path)),
        capture_output=True,
        text=True,
    )
    assert "cpython-399" in done.stderr and "allowed" in done.stderr and "circular" not in done.stderr


def test_what_is_misspelled_gets_a_suggestion():
    for call, meant in ((lambda: leapmap.solve(slop=0.4),
                         "slope"), (lambda: leapmap.solve(fields=["jump_hight"]), "jump_height"),
                        (lambda: leapmap.design(slope={"from": 0.1, "to": 0.5}, goal=
                                                {"jump_tme": {"at_most": 1}}, maximize="jump_height"),
                         "jump_time")):
        with pytest.raises(ValueError, match=rf"did you mean {meant}\?"):
            call()
