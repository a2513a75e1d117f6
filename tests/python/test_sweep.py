# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap.sweep and leapmap.load: specs as files and as dictionaries, in memory and on disk."""
import os
import subprocess
import sys

import numpy as np
import pytest

import leapmap
from support.program import SMALL

GRID = {"design": {"slope": np.linspace(0.1, 0.8, 9), "mass_ratio": [1, 2, 3]}, "numerics": {"audit": 0.1}}


def test_a_dictionary_is_swept_in_memory_and_agrees_with_solve():
    seen = []
    ds = leapmap.sweep(GRID, progress=lambda done, total: seen.append((done, total)))
    o = leapmap.solve(slope=GRID["design"]["slope"][:, None], mass_ratio=[1.0, 2.0, 3.0])
    assert ds.jump_height.dims == ("slope", "mass_ratio") and ds.jump_height.values.shape == (9, 3)
    np.testing.assert_array_equal(ds.status, o.status)
    np.testing.assert_allclose(ds.jump_height, o.jump_height, rtol=1e-13)  # lanes and neighbours move roundings
    assert seen[0] == (0, 27) and seen[-1] == (27, 27) and ds.attrs["audit_designs"] > 0


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
    ({"design": 1.0}, "design = 1.0 is no section"),
    ({"design": {"slope": np.zeros((2, 2))}}, "has 2 dimensions"),
])
def test_refuses_what_is_no_spec(spec, says):
    with pytest.raises(ValueError, match=says):
        leapmap.sweep(spec)


def test_files_that_are_no_maps_or_cannot_be_written_are_told(tmp_path):
    (tmp_path / "text.h5").write_text("no map")
    with pytest.raises(ValueError, match="text.h5"):
        leapmap.load(tmp_path / "text.h5")
    with pytest.raises((OSError, ValueError), match="nowhere"):
        leapmap.sweep(GRID, tmp_path / "nowhere" / "deep" / "map.h5" if os.geteuid() else "/proc/nowhere/map.h5")
    with pytest.raises(ValueError, match="missing.toml: cannot be read"):
        leapmap.sweep(tmp_path / "missing.toml")


def test_an_error_of_the_progress_function_ends_the_sweep():
    def fails(done, total):
        raise RuntimeError("enough")
    with pytest.raises(RuntimeError, match="enough"):
        leapmap.sweep(GRID, progress=fails)


def test_ctrl_c_keeps_what_is_done_and_resume_ends_with_the_same_bits(tmp_path):
    spec = {"design": {"slope": {"from": "2 deg", "to": "50 deg", "count": 1500}, "mass_ratio": {"from": 0.1, "to": 20, "count": 1500}},
            "numerics": {"audit": 0.0}, "output": {"fields": ["jump_height", "jump_time", "status"], "file": str(tmp_path / "map.h5")}}
    code = ("import leapmap, os, signal, threading\n"
            "sent = []\n"
            "def at(done, total):\n"
            "    if 0 < done < total and not sent: sent.append(done), os.kill(os.getpid(), signal.SIGINT)\n"
            f"try:\n    leapmap.sweep({spec!r}, progress=at)\nexcept KeyboardInterrupt as error:\n    print('interrupted:', error)\n")
    path = "import os, sys; sys.path.insert(0, os.environ['LEAPMAP_BUILD'] + '/python')\n"
    done = subprocess.run([sys.executable, "-c", path + code], capture_output=True, text=True, timeout=120)
    assert "map.h5.part keeps what is done; resume=True goes on" in done.stdout, done.stderr
    assert (tmp_path / "map.h5.part").exists()
    resumed = leapmap.sweep(spec, resume=True)
    whole = leapmap.sweep(spec, tmp_path / "whole.h5")
    assert resumed.jump_time.values.tobytes() == whole.jump_time.values.tobytes()
