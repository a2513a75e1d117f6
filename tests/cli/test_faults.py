# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls that fail: the short twin of tests/faults/run.sh, and what a walk through the calls does not meet."""
import os
import subprocess
import sys

import h5py
import pytest
from support.program import PROGRAM, SMALL, TOP, finished, leapmap, sweep

sys.path.insert(0, str(TOP / "tests" / "faults"))
import walk  # noqa: E402


@pytest.mark.parametrize("command,every", [("sweep", 47), ("overwrite", 97), ("resume", 61), ("retry", 97),
                                           ("trace", 23), ("info", 29), ("check", 211), ("list", 71),
                                           ("explorer", 131)])
def test_whatever_call_fails_nothing_is_lost(command, every):
    runs, findings = walk.walk([command], ["EIO", "ENOSPC"], (False, True), every)
    assert runs > 4 and findings == []


def test_interrupted_short_and_empty_transfers_are_made_again_or_told():
    runs, findings = walk.walk(["sweep", "trace"], ["EINTR", "EDQUOT", "short", "zero"], (False, True), 79)
    assert runs > 25 and findings == []


@pytest.mark.parametrize("memory, every", [("new", 1193), ("malloc", 1999),
                                           pytest.param("new", 397, marks=pytest.mark.slow),
                                           pytest.param("malloc", 997, marks=pytest.mark.slow)])
def test_a_lack_of_memory_is_a_line_and_loses_nothing(memory, every):
    runs, findings = walk.walk(["sweep", "trace"], ["ENOMEM"], (False, True), every, memory)
    assert runs > 15 and findings == []


def run_with(fault, *arguments):
    environment = dict(os.environ, LD_PRELOAD=walk.INJECTOR,
                       **{"FAULT_" + k.upper(): str(v) for k, v in fault.items()})
    return subprocess.run([PROGRAM, *map(str, arguments)], env=environment, capture_output=True, text=True,
                          timeout=60)


def test_a_file_system_without_locks_is_refused_and_no_lock_goes_on(tmp_path):
    (tmp_path / "spec.toml").write_text(SMALL)
    words = ("sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5", "--quiet")
    found = {}
    for number in range(40):  # one of the first calls is the lock
        done = run_with({"under": tmp_path, "number": number, "error": "ENOLCK"}, *words)
        for name in ("map.h5", "map.h5.part"):
            (tmp_path / name).unlink(missing_ok=True)
        if "cannot be locked" in done.stderr:
            found[number] = done
    assert found
    for number, done in found.items():
        assert done.returncode == 3 and "--no-lock" in done.stderr and done.stderr.count("\n") == 1
    done = run_with({"under": tmp_path, "number": min(found), "error": "ENOLCK"}, *words, "--no-lock")
    assert done.returncode == 0, done.stderr
    assert leapmap("check", tmp_path / "map.h5").returncode == 0


def test_a_part_that_was_taken_away_is_not_renamed(tmp_path):
    """Another sweep's unfinished file has that name now."""
    (tmp_path / "spec.toml").write_text(
        SMALL.replace("audit = 0.05", 'method = "gsl-rk4"\ntolerance = 1e-13\naudit = 0').replace(
            "count = 12", "count = 60"))
    process = subprocess.Popen(
        [PROGRAM, "sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5", "--threads", "2"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    part = tmp_path / "map.h5.part"
    while not (part.exists() and part.stat().st_size > 0):  # by then it is locked
        assert process.poll() is None
    part.unlink()
    part.write_text("somebody else's")
    out, err = process.communicate(timeout=300)
    assert process.returncode == 3 and "another program" in err, err
    assert not (tmp_path / "map.h5").exists() and part.read_text() == "somebody else's"


@pytest.mark.parametrize("closed", ["<&-", ">&-", "2>&-", "<&- >&- 2>&-"])
def test_closed_standard_streams_reach_no_file(closed, tmp_path):
    (tmp_path / "spec.toml").write_text(SMALL)
    done = subprocess.run(f"{PROGRAM} sweep {tmp_path}/spec.toml -o {tmp_path}/map.h5 {closed}", shell=True,
                          capture_output=True, text=True)
    assert done.returncode == 0
    assert leapmap("check", tmp_path / "map.h5").returncode == 0
    trace = subprocess.run(f"{PROGRAM} hop --trace {tmp_path}/trace.h5 {closed}", shell=True)
    assert trace.returncode == 0
    with h5py.File(tmp_path / "trace.h5") as t:
        assert t.attrs["status"] == "jumped"


def test_what_cannot_be_printed_ends_with_status_3(tmp_path):
    path = sweep(tmp_path)
    for words in (["info", "--spec", path], ["info", path], ["hop"], ["hop",
                                                                      "--json"], ["--help"], ["check", path]):
        with open("/dev/full", "w") as full:
            assert subprocess.run([PROGRAM, *words], stdout=full,
                                  stderr=subprocess.DEVNULL).returncode == 3, words


def test_more_threads_than_any_machine_has_are_no_crash(tmp_path):
    (tmp_path / "spec.toml").write_text(SMALL)
    done = subprocess.run([PROGRAM, "sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5", "--quiet"],
                          env=dict(os.environ, OMP_NUM_THREADS="100000"))
    assert done.returncode == 0


def test_a_retry_killed_at_any_call_is_simply_made_again(tmp_path):
    command = walk.COMMANDS["retry"]
    each = walk.begin(command, tmp_path)
    assert each.calls > 41
    for number in range(0, each.calls, 41):  # the call before it is its last: as if killed there
        folder = tmp_path / f"killed{number}" / "retry"
        folder.parent.mkdir()
        subprocess.run(["cp", "-r", each.before, folder], check=True)
        words = walk.argv(command.words, folder)
        environment = dict(os.environ, LD_PRELOAD=walk.INJECTOR, FAULT_UNDER=str(folder),
                           FAULT_NUMBER=str(number), FAULT_ERROR="kill")
        assert subprocess.run(words, env=environment, capture_output=True).returncode == -9
        assert finished(*words).returncode == 0
        assert walk.content(folder / "map.h5", folder) == each.right


def test_an_audit_that_failed_fails_again_when_resumed(tmp_path):
    (tmp_path / "spec.toml").write_text(
        SMALL.replace("audit = 0.05", 'method = "gsl-rk8pd"\ntolerance = 3e-3\naudit = 1'))
    first = leapmap("sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5")
    again = leapmap("sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5", "--resume")
    assert first.returncode == 1 and "cross-check: design" in first.stderr
    assert again.returncode == 1 and again.stderr == first.stderr and "complete already" in again.stdout
