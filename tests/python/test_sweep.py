# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap.sweep and leapmap.load: specs as files and as dictionaries, in memory and on disk."""
import os
import subprocess
import sys
import types

import h5py
import numpy as np
import pytest

import leapmap
from support.program import SMALL

GRID = {"design": {"slope": np.linspace(0.1, 0.8, 9), "mass_ratio": [1, 2, 3]}, "numerics": {"audit": 0.1}}


def test_a_dictionary_is_swept_in_memory_and_agrees_with_solve():
    ds = leapmap.sweep(GRID)
    o = leapmap.solve(slope=GRID["design"]["slope"][:, None], mass_ratio=[1.0, 2.0, 3.0])
    assert ds.jump_height.dims == ("slope", "mass_ratio") and ds.jump_height.values.shape == (9, 3)
    np.testing.assert_array_equal(ds.status, o.status)
    # lanes and neighbours move roundings
    np.testing.assert_allclose(ds.jump_height, o.jump_height, rtol=1e-13)
    assert ds.attrs["audit_designs"] > 0


def test_progress_is_told_and_may_use_h5py(tmp_path):
    seen = []

    def tell(done, total):
        with h5py.File(tmp_path / "log.h5", "a") as log:
            log.attrs["done"] = done
        seen.append((done, total))
    leapmap.sweep(GRID, progress=tell)
    assert seen == sorted(seen) and seen[-1] == (27, 27)


def test_keys_and_values_of_a_dictionary_are_those_of_a_spec(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "x.csv").write_text("slope\n0.3\n0.4\n")
    assert leapmap.sweep({"design": {"points": "x.csv"}}).jump_height.shape == (2,)
    by_values = leapmap.sweep({"design": {"slope": {"values": [0.3, 0.4]}}})
    by_texts = leapmap.sweep({
        "design": {"slope": {"from": "10 deg", "to": "20 deg", "step": "5 deg"}},
        "scene": {"runway": np.int64(5)}
    })
    assert by_values.slope.values.tolist() == [0.3, 0.4] and by_texts.slope.shape == (3,)
    assert leapmap.sweep(types.MappingProxyType(GRID)).equals(leapmap.sweep(GRID))


def test_a_specs_file_is_written_read_refused_overwritten_and_resumed(tmp_path):
    spec, file = tmp_path / "small.toml", tmp_path / "out.h5"
    spec.write_text(SMALL + f'[output]\nfile = "{file}"\n')
    ds = leapmap.sweep(spec)
    assert file.exists() and ds.jump_height.shape == (12, 11, 2)
    with pytest.raises(ValueError, match="out.h5"):
        leapmap.sweep(spec)
    again = leapmap.sweep(spec, resume=True)
    assert again.jump_time.values.tobytes() == ds.jump_time.values.tobytes()
    other = leapmap.sweep(spec, overwrite=True, tolerance=1e-12, fields=["jump_time"])
    assert list(other.data_vars) == ["jump_time"]
    elsewhere = leapmap.sweep(spec, tmp_path / "other.h5")
    assert elsewhere.equals(ds) and leapmap.load(tmp_path / "other.h5").equals(ds)
    assert leapmap.sweep(spec, in_memory=True).equals(ds)


@pytest.mark.parametrize("spec, says", [
    ({"design": {"slope": "steep"}}, "slope"),
    ({"design": {"slop": 1.0}}, "slop"),
    ({"design": 1.0}, "design = 1.0 is not a section"),
    ({"design": {"slope": np.zeros((2, 2))}}, "is not a value of a spec"),
    ({"design": {"slope": ["10 deg", 0.2]}}, "slope = .* is not a value of a spec"),
    ({"design": {"slope": None}}, "slope = None is not a value of a spec"),
    ({"design": {"bad key\n": 1.0}}, "bad key"),
    ({"output": {"file": "a\rb\x7f.h5", "precision": "f2"}}, "f2"),
])
def test_refuses_what_is_no_spec(spec, says):
    with pytest.raises(ValueError, match=says):
        leapmap.sweep(spec)


def test_resume_and_overwrite_have_no_use_in_memory():
    for given in ({"resume": True}, {"overwrite": True}):
        with pytest.raises(ValueError, match="no effect in memory"):
            leapmap.sweep(GRID, **given)


def test_ctrl_c_of_a_sweep_in_memory_promises_no_file():
    code = (
        "import leapmap, os, signal, threading\nthreading.Timer(0.7, lambda: os.kill(os.getpid(), "
        "signal.SIGINT)).start()\n"
        "try:\n    leapmap.sweep({'design': {'mass_ratio': {'from': 1, 'to': 9, 'count': 900000}}, 'scene': "
        "{'friction': 'coulomb'}})\n"
        "except KeyboardInterrupt as error:\n    print('interrupted:', error)\n")
    path = "import os, sys; sys.path.insert(0, os.environ['LEAPMAP_BUILD'] + '/python')\n"
    done = subprocess.run([sys.executable, "-c", path + code], capture_output=True, text=True, timeout=120)
    assert done.stdout == "interrupted: stopped\n", done.stderr


def test_files_that_are_no_maps_or_cannot_be_written_are_told(tmp_path):
    (tmp_path / "text.h5").write_text("no map")
    with pytest.raises(ValueError, match="text.h5"):
        leapmap.load(tmp_path / "text.h5")
    with pytest.raises((OSError, ValueError), match="nowhere"):
        leapmap.sweep(GRID,
                      tmp_path / "nowhere" / "deep" / "map.h5" if os.geteuid() else "/proc/nowhere/map.h5")
    with pytest.raises(ValueError, match="missing.toml: cannot be read"):
        leapmap.sweep(tmp_path / "missing.toml")


def test_an_error_of_the_progress_function_ends_the_sweep():
    def fails(done, total):
        raise RuntimeError("enough")
    with pytest.raises(RuntimeError, match="enough"):
        leapmap.sweep(GRID, progress=fails)


def test_ctrl_c_keeps_what_is_done_and_resume_ends_with_the_same_bits(tmp_path):
    spec = {
        "design": {
            "slope": {"from": "2 deg", "to": "50 deg", "count": 1500},
            "mass_ratio": {"from": 0.1, "to": 20, "count": 1500}
        }, "numerics": {"audit": 0.0},
        "output": {"fields": ["jump_height", "jump_time", "status"], "file": str(tmp_path / "map.h5")}
    }
    code = (
        "import leapmap, os, signal, threading\n"
        "sent = []\n"
        "def at(done, total):\n"
        "    if 0 < done < total and not sent: sent.append(done), os.kill(os.getpid(), signal.SIGINT)\n"
        f"try:\n    leapmap.sweep({spec!r}, progress=at)\nexcept KeyboardInterrupt as error:\n    "
        "print('interrupted:', error)\n"
    )
    path = "import os, sys; sys.path.insert(0, os.environ['LEAPMAP_BUILD'] + '/python')\n"
    done = subprocess.run([sys.executable, "-c", path + code], capture_output=True, text=True, timeout=120)
    assert "map.h5.part keeps what is done; resume=True continues it" in done.stdout, done.stderr
    assert (tmp_path / "map.h5.part").exists()
    resumed = leapmap.sweep(spec, resume=True)
    whole = leapmap.sweep(spec, tmp_path / "whole.h5")
    assert resumed.jump_time.values.tobytes() == whole.jump_time.values.tobytes()
