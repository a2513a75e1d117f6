# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program under test, and the commands of others that read its files."""
import os
import runpy
import signal
import subprocess
import sys
import tempfile
import traceback
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


def scripted(script, *arguments, formats=None):
    """A script of analysis as finished() runs it, in a fork of this process: to import matplotlib anew takes
    a second. formats: those of a chart that are drawn, where a test reads no others."""
    import h5py, matplotlib.pyplot  # noqa: E401, F401  once for all forks
    words = [str(word) for word in (TOP / "analysis" / script, *arguments)]
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        process = os.fork()
        if process == 0:
            status = 1
            try:
                signal.alarm(300)
                os.dup2(out.fileno(), 1), os.dup2(err.fileno(), 2)
                sys.stdout, sys.stderr = (open(n, "w", closefd=False, errors="backslashreplace")
                                          for n in (1, 2))
                sys.argv = words
                sys.path[:0] = [
                    str(TOP / "analysis"), *filter(None,
                                                   os.environ.get("PYTHONPATH", "").split(":"))
                ]
                if formats:
                    import style
                    style.FORMATS = {name: style.FORMATS[name] for name in formats}
                runpy.run_path(words[0], run_name="__main__")
                status = 0
            except SystemExit as end:
                if isinstance(end.code, str):
                    print(end.code, file=sys.stderr)
                status = end.code if isinstance(end.code, int) else int(end.code is not None)
            except BaseException:  # as the interpreter does
                traceback.print_exc()
            finally:
                try:
                    sys.stdout.flush(), sys.stderr.flush()
                finally:
                    os._exit(status)
        status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
        told = []
        for file in (out, err):
            file.seek(0)
            told.append(file.read().decode())
    return subprocess.CompletedProcess(words, status, *told)


def leapmap(*arguments):
    return finished(PROGRAM, *arguments)


def sweep(folder, spec=SMALL, *arguments, name="map.h5"):
    """Sweeps a spec's text into a map in folder, whose path is returned."""
    (folder / "spec.toml").write_text(spec)
    done = leapmap("sweep", folder / "spec.toml", "-o", folder / name, "--quiet", *arguments)
    assert done.returncode == 0, done.stderr
    return folder / name
