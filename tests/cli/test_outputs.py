# SPDX-License-Identifier: GPL-3.0-or-later
"""What commands write: never over an input, another output, a device or a stranger's file; modes and links
stay."""
import os
import stat
import subprocess
import threading

import pytest
from support.program import PROGRAM, SMALL, leapmap, sweep

QUESTION = '[design]\nslope = { from = 0.3, to = 0.5 }\n[goal]\nmaximize = ["jump_height"]\n'
EVENTS = "event,value,error\njump_time,0.54,0.005\njump_height,0.98,0.02\n"
CSV = {
    "boundaries": ["boundaries", "spec.toml"],
    "design": ["design", "question.toml", "--quiet"],
    "fit": ["fit", "events.csv", "--model", "sticking"],
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "spec.toml").write_text(SMALL)
    (tmp_path / "question.toml").write_text(QUESTION)
    (tmp_path / "events.csv").write_text(EVENTS)
    return tmp_path


@pytest.mark.parametrize("command", CSV)
def test_a_strangers_file_is_replaced_with_overwrite_alone_and_keeps_its_mode(command, folder):
    notes = folder / "notes"
    notes.write_text("mine\n")
    notes.chmod(0o600)
    os.symlink("notes", folder / "link")
    done = leapmap(*CSV[command], "--csv", "link")
    assert (
        done.returncode == 2 and "--overwrite" in done.stderr and notes.read_text() == "mine\n"
    ), done.stderr
    assert leapmap(*CSV[command], "--csv", "link", "--overwrite").returncode == 0
    assert (folder / "link").is_symlink() and notes.read_text() != "mine\n"
    assert stat.S_IMODE(notes.stat().st_mode) == 0o600
    assert leapmap(*CSV[command], "--csv", "notes").returncode == (
        2 if command == "design" else 0
    ), "it is ours now, but any list begins like a design's"
    assert not [name for name in os.listdir(folder) if name.endswith(".new")]


@pytest.mark.parametrize("command", CSV)
def test_devices_and_pipes_are_written_through(command, folder):
    os.mkfifo(folder / "pipe")
    read = []
    reader = threading.Thread(target=lambda: read.append((folder / "pipe").read_text()))
    reader.start()
    assert leapmap(*CSV[command], "--csv", "pipe").returncode == 0
    reader.join()
    assert stat.S_ISFIFO((folder / "pipe").stat().st_mode) and read[0].count("\n") > 1
    if os.geteuid() == 0:
        os.mknod(folder / "null", 0o666 | stat.S_IFCHR, os.makedev(1, 3))
        assert leapmap(*CSV[command], "--csv", "null").returncode == 0
        assert stat.S_ISCHR((folder / "null").stat().st_mode)
    assert leapmap(*CSV[command], "--csv", "/dev/full").returncode == 3


@pytest.mark.parametrize(
    "command",
    [
        ["boundaries", "spec.toml", "-o", "x.h5", "--csv", "./x.h5"],
        ["boundaries", "spec.toml", "-o", "x.h5", "--csv", "dangling"],
        ["boundaries", "spec.toml", "-o", "x.h5", "--csv", "x.h5.part"],
        ["boundaries", "spec.toml", "--csv", "./spec.toml", "--overwrite"],
        ["design", "question.toml", "-o", "x.h5", "--csv", "./x.h5"],
        ["design", "question.toml", "-o", "./question.toml", "--overwrite"],
        ["fit", "events.csv", "--csv", "second", "--overwrite"],
        ["fit", "events.csv", "spec.toml", "--csv", "spec.toml", "--overwrite"],
        ["hop", "empty.toml", "--trace", "./empty.toml"],
        ["sweep", "spec.toml", "-o", "./spec.toml", "--overwrite"],
    ],
)
def test_one_file_under_two_names_is_refused_before_the_work(command, folder):
    os.symlink("x.h5", folder / "dangling")
    os.link(folder / "events.csv", folder / "second")
    (folder / "empty.toml").write_text("")
    before = {name: (folder / name).read_bytes() for name in os.listdir(folder) if (folder / name).exists()}
    done = leapmap(*command)
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    assert {
        name: (folder / name).read_bytes() for name in os.listdir(folder) if (folder / name).exists()
    } == before


@pytest.mark.parametrize(
    "command",
    [
        ["sweep", "spec.toml", "-o", "x.h5", "--overwrite", "--quiet"],
        ["hop", "--trace", "x.h5"],
        ["boundaries", "spec.toml", "-o", "x.h5"],
        ["design", "question.toml", "-o", "x.h5", "--quiet"],
    ],
)
def test_hdf5_outputs_keep_the_mode_of_what_they_replace(command, folder):
    for _ in range(2):
        assert leapmap(*command).returncode == 0
        (folder / "x.h5").chmod(0o600)
    assert leapmap(*command).returncode == 0
    assert stat.S_IMODE((folder / "x.h5").stat().st_mode) == 0o600


def test_standard_output_takes_a_table_wherever_it_is_turned_to(folder):
    shell = f"{PROGRAM} fit events.csv --model sticking --csv /dev/stdout"
    assert (
        "t,quantity,unit,measured"
        in subprocess.run(f"{shell} | cat", shell=True, capture_output=True, text=True).stdout
    )
    subprocess.run(f"{shell} > out.txt", shell=True, check=True)
    told = (folder / "out.txt").read_text()
    assert told.index("friction") < told.index(
        "t,quantity,unit,measured"
    ), "the report and then the table, in one file"


def test_a_map_that_cannot_be_written_leaves_no_csv_beside_it(folder):
    (folder / "found.csv").write_text("slope\n0.1\n")
    done = leapmap("design", "question.toml", "--csv", "found.csv", "-o", "/proc/nowhere/x.h5", "--overwrite")
    assert done.returncode == 3 and (folder / "found.csv").read_text() == "slope\n0.1\n", done.stderr
    assert not [name for name in os.listdir(folder) if name.endswith(".new")]


def test_a_version_that_is_no_pair_of_whole_numbers_is_damage(tmp_path):
    h5py = pytest.importorskip("h5py")
    import numpy as np

    path = sweep(tmp_path)
    for name, value in [
        ("version", [1.5, np.nan]),
        ("version", [-3, -7]),
        ("version", [1]),
        ("threads", np.nan),
        ("wall_time", np.nan),
        ("wall_time", -1.0),
        ("audit_designs", 30.6),
        ("audit_first_mismatch", -0.5),
        ("status_counts", np.full(7, 0.4)),
        ("method", 3.0),
    ]:
        with h5py.File(path, "r+") as m:
            before = m.attrs[name]
            del m.attrs[name]
            m.attrs[name] = value
        done = leapmap("check", path, "--sample", "0")
        assert done.returncode == 1 and (name.split("_")[0] in done.stdout + done.stderr), (
            name,
            value,
            done.stdout,
            done.stderr,
        )
        with h5py.File(path, "r+") as m:
            del m.attrs[name]
            m.attrs[name] = before
