# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program under test, and the commands of others that read its files."""
import os
import subprocess
from pathlib import Path

PROGRAM = os.environ["LEAPMAP"]
TOP = Path(__file__).resolve().parents[2]
REFERENCE = TOP / "tests" / "reference"
SMALL = """
[design]
slope = { from = "2 deg", to = "50 deg", count = 12 }
mass_ratio = { from = 0.1, to = 20, count = 11, scale = "log" }
offset_ratio = { values = [0.6, 1.0] }
[numerics]
audit = 0.05
"""


def finished(*command):
    """The finished process of any command; stdout and stderr as text."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=300)


def leapmap(*arguments):
    return finished(PROGRAM, *arguments)


def sweep(folder, spec=SMALL, *arguments, name="map.h5"):
    """Sweeps a spec's text into a map in folder, whose path is returned."""
    (folder / "spec.toml").write_text(spec)
    done = leapmap("sweep", folder / "spec.toml", "-o", folder / name, "--quiet", *arguments)
    assert done.returncode == 0, done.stderr
    return folder / name
