# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input: one clear line, the right exit status, no half-made file, an existing file untouched."""
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest
from support.program import PROGRAM, SMALL, leapmap, sweep

BAD = {
    "unknown key": ('[design]\nslop = 0.4', ["slop", "slope"]),
    "missing axis bound": ('[design]\nslope = { from = 0.1, count = 3 }', ["'to'", "missing"]),
    "negative mass ratio": ('[design]\nmass_ratio = -1', ["mass_ratio", "-1"]),
    "slope of 91 degrees": ('[design]\nslope = "91 deg"', ["slope", "91 deg"]),
    "NaN": ('[design]\nslope = nan', ["slope", "nan"]),
    "count 0": ('[design]\nslope = { from = 0.1, to = 0.2, count = 0 }', ["count"]),
    "log axis from 0": ('[design]\nmass_ratio = { from = 0, to = 1, count = 3, scale = "log" }', ["log"]),
    "unreadable CSV": ('[design]\npoints = "nowhere.csv"', ["nowhere.csv"]),
    "a label without an end": ('[design]\npoints = "endless.csv"', ["endless.csv:2", "quote"]),
    "a label too long": ('[design]\npoints = "long.csv"', ["label of design 0", "200 bytes"]),
    "labels and nothing else": ('[design]\npoints = "labels.csv"', ["labels.csv:1", "parameter"]),
    "a column too many": ('[design]\npoints = "wide.csv"', ["wide.csv:2", "2 values"]),
}


@pytest.mark.parametrize("kind", BAD)
def test_a_bad_spec_ends_with_status_2_one_line_and_no_file(kind, tmp_path):
    text, words = BAD[kind]
    (tmp_path / "wide.csv").write_text("slope\n0.1,0.2\n")
    (tmp_path / "endless.csv").write_text('label,slope\n"one,0.2\n')
    (tmp_path / "long.csv").write_text(f"label,slope\n{'x' * 201},0.2\n")
    (tmp_path / "labels.csv").write_text("label\none\n")
    (tmp_path / "bad.toml").write_text(text + "\n")
    before = set(os.listdir(tmp_path))
    done = leapmap("sweep", tmp_path / "bad.toml", "-o", tmp_path / "map.h5")
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1 and done.stderr.endswith("\n"), done.stderr
    for word in words + ["allowed"]:
        assert word in done.stderr
    assert set(os.listdir(tmp_path)) == before


@pytest.mark.parametrize("arguments", [
    [], ["swep"], ["sweep"], ["sweep", "/nowhere.toml"], ["hop", "--slope", "91deg"], ["hop", "--slope"], ["hop", "--sloop", "1"],
    ["hop", "--slope", "steep"], ["hop", "--trace", ""], ["sweep", "x.toml", "-o", ""], ["stability", "-o", ""], ["hop", "--trace-interval", "-1"], ["sweep", "x.toml", "--threads", "0"], ["info"],
    ["hop", "--set", "design.slope={values=[0.1,0.2]}"], ["hop", "--set", "tolerance=1e-3\nslope=9"],
    ["hop", "--set", 'method="a\\nb"'], ["hop", "--slope", "0.4raddeg"], ["hop", "--trace-interval", "nan", "--trace", "/tmp/x.h5"],
])
def test_bad_usage_ends_with_status_2_and_one_line(arguments):
    done = leapmap(*arguments)
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("arguments", [
    ["hop", "--trace-interval", "0.01"], ["info", "m.h5", "--limit", "3"], ["info", "m.h5", "--spec", "--failed"],
    ["sweep", "x.toml", "--retry-failed", "--overwrite"], ["gait", "--set", "scene.jumps=5"], ["gait", "--set", "jumps=5"],
])
def test_an_option_without_use_is_refused_by_its_name(arguments):
    done = leapmap(*arguments)
    assert done.returncode == 2 and done.stdout == "" and done.stderr.count("\n") == 1
    assert next(word for word in ("jumps", "trace-interval", "limit", "failed", "overwrite") if any(word in a for a in arguments)) in done.stderr


def test_a_sweep_without_a_file_to_write_is_refused(tmp_path):
    (tmp_path / "spec.toml").write_text(SMALL)
    done = leapmap("sweep", tmp_path / "spec.toml")
    assert done.returncode == 2 and "output.file" in done.stderr


def test_an_existing_map_is_untouched_without_overwrite_and_replaced_with_it(tmp_path):
    path = sweep(tmp_path)
    before = path.read_bytes()
    done = leapmap("sweep", tmp_path / "spec.toml", "-o", path)
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "--overwrite" in done.stderr
    assert path.read_bytes() == before
    done = leapmap("sweep", tmp_path / "spec.toml", "-o", path, "--overwrite", "--set", "runway=2")
    assert done.returncode == 0
    assert path.read_bytes() != before
    assert sorted(os.listdir(tmp_path)) == ["map.h5", "spec.toml"]


def test_a_trace_replaces_a_trace_but_nothing_else(tmp_path):
    (tmp_path / "notes.h5").write_text("precious")
    done = leapmap("hop", "--trace", tmp_path / "notes.h5")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and (tmp_path / "notes.h5").read_text() == "precious"
    assert [leapmap("hop", "--trace", tmp_path / "trace.h5").returncode for _ in range(2)] == [0, 0]


@pytest.mark.parametrize("target", ["/proc/map.h5", "/dev/null/map.h5"])
def test_an_unwritable_place_ends_with_status_3_and_one_line(target, tmp_path):
    (tmp_path / "spec.toml").write_text(SMALL)
    done = leapmap("sweep", tmp_path / "spec.toml", "-o", target)
    assert done.returncode == 3, done.stderr
    assert done.stderr.count("\n") == 1
    trace = leapmap("hop", "--trace", target)
    assert trace.returncode == 3 and trace.stderr.count("\n") == 1


def test_a_folder_that_may_not_be_written_ends_with_status_3():
    if os.geteuid() == 0 and not shutil.which("setpriv"):
        pytest.skip("root may write anywhere, and setpriv is not there to become somebody else")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "spec.toml").write_text(SMALL)
        shutil.copy(PROGRAM, folder / "leapmap")
        locked = folder / "locked"
        locked.mkdir(mode=0o555)
        folder.chmod(0o755)
        become = ["setpriv", "--reuid=65534", "--clear-groups"] if os.geteuid() == 0 else []
        done = subprocess.run([*become, folder / "leapmap", "sweep", folder / "spec.toml", "-o", locked / "map.h5"],
                              capture_output=True, text=True)
        assert done.returncode == 3, done.stderr
        assert done.stderr.count("\n") == 1
        assert os.listdir(locked) == []


def test_a_bad_design_is_a_status_and_the_sweep_goes_on(tmp_path):
    path = sweep(tmp_path, '[design]\nslope = { values = [0.4] }\nmass_ratio = { values = [2, 3] }\n[numerics]\nmethod = "gsl-rk8pd"\nmax_steps = 20\naudit = 0\n')
    text = leapmap("info", path).stdout
    assert "failed" in text
