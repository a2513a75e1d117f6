# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C keeps what is done, says so, and leaves no map that is not whole."""
import shlex
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest
from support.program import PROGRAM

LONG = """
[design]
slope = { from = "2 deg", to = "50 deg", count = 200 }
mass_ratio = { from = 0.1, to = 20, count = 1200, scale = "log" }
[numerics]
tolerance = 1e-13
method = "gsl-rk4"
audit = 0
"""  # slow on purpose: minutes if it is not interrupted


@pytest.mark.parametrize("number,status", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_keeps_finished_tiles_readable_in_the_part(number, status, tmp_path):
    (tmp_path / "spec.toml").write_text(LONG)
    process = subprocess.Popen([PROGRAM, "sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(3.0)
    process.send_signal(number)
    out, err = process.communicate(timeout=120)
    assert process.returncode == status
    assert out == ""
    assert err.count("\n") == 1 and "map.h5.part" in err
    assert not (tmp_path / "map.h5").exists()
    with h5py.File(tmp_path / "map.h5.part") as part:
        computed = part["status"][()] != 0
        assert 0 < computed.sum() < computed.size
        assert np.isnan(part["jump_height"][()][~computed]).all()
    again = subprocess.run([PROGRAM, "sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5"],
                           capture_output=True, text=True)
    assert again.returncode == 2 and "map.h5.part" in again.stderr, "what was kept is not overwritten unasked"


def test_an_interrupted_shard_says_how_to_go_on_with_it(tmp_path):
    spec = LONG.replace("audit = 0", "audit = 0\n[output]\nfile = '%s'" % (tmp_path / "map.h5"))
    (tmp_path / "spec.toml").write_text(spec)
    process = subprocess.Popen([PROGRAM, "sweep", tmp_path / "spec.toml", "--shard", "1/2"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(3.0)
    process.send_signal(signal.SIGINT)
    err = process.communicate(timeout=120)[1]
    assert process.returncode == 130 and "map.1-of-2.h5.part" in err
    words = shlex.split(err[err.index("leapmap sweep"):])
    again = subprocess.Popen([PROGRAM, *words[1:]], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(2.0)
    again.send_signal(signal.SIGINT)
    out, err = again.communicate(timeout=120)
    assert again.returncode == 130 and "designs were complete" in out, err


def test_a_signal_during_the_audit_is_an_interruption_too(tmp_path):
    (tmp_path / "spec.toml").write_text(
        LONG.replace("audit = 0", "audit = 1").replace("gsl-rk4", "exact").replace("1200", "3000"))
    process = subprocess.Popen([PROGRAM, "sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(4.0)  # solving takes less than a second, auditing by integration twenty and more
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=120)
    assert process.returncode == 130
    assert not (tmp_path / "map.h5").exists() and (tmp_path / "map.h5.part").exists()
