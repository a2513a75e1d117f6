# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input: one clear line, the right exit status, no half-made file, an existing file untouched."""
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import pytest
from support.program import PROGRAM, SMALL, leapmap, sweep

INPUTS = Path(__file__).parent / "inputs"

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


@pytest.mark.parametrize("arguments, meant", [(["swep"], "sweep"), (["hop", "--slpe", "1"], "--slope"),
                                              (["info", "m.h5", "--spce"], "--spec"),
                                              (["hop", "--slope", "30"], "30deg"),
                                              (["hop", "--set", "metod=exact"], "method"),
                                              (["hop", "--set", "method=exakt"], "exact"),
                                              (["hop", "--friction", "colomb"], "coulomb"),
                                              (["hop", "--set", "scene.runaway=3"], "runway"),
                                              (["sweep", "--set", 'fields=["jump_heigth"]'], "jump_height"),
                                              (["fit", "x.csv", "--model", "stiking"], "sticking")])
def test_what_is_misspelled_gets_a_suggestion(arguments, meant):
    done = leapmap(*arguments)
    assert done.returncode == 2
    assert f"(did you mean {meant}?)" in done.stderr, done.stderr


def test_a_section_that_is_misspelled_gets_a_suggestion(tmp_path):
    (tmp_path / "bad.toml").write_text("[desing]\nslope = 0.4\n")
    assert "[desing]: unknown section (did you mean design?); allowed: [scene], [hoop], [design]" in leapmap(
        "hop", tmp_path / "bad.toml").stderr


def test_a_release_angle_in_degrees_is_noticed():
    assert "for degrees write 180deg" in leapmap("hop", "--release-angle", "180").stderr
    assert leapmap("hop", "--release-angle", "180deg").stderr == "" == leapmap(
        "hop", "--release-angle", "3600deg").stderr


@pytest.mark.parametrize("arguments", [
    [],
    ["swep"],
    ["sweep"],
    ["sweep", "/nowhere.toml"],
    ["hop", "--slope", "91deg"],
    ["hop", "--slope"],
    ["hop", "--sloop", "1"],
    ["hop", "--slope", "steep"],
    ["hop", "--trace", ""],
    ["sweep", "x.toml", "-o", ""],
    ["stability", "-o", ""],
    ["hop", "--trace-interval", "-1"],
    ["sweep", "x.toml", "--threads", "0"],
    ["info"],
    ["hop", "--set", "design.slope={values=[0.1,0.2]}"],
    ["hop", "--set", "tolerance=1e-3\nslope=9"],
    ["hop", "--set", 'method="a\\nb"'],
    ["hop", "--slope", "0.4raddeg"],
    ["hop", "--trace-interval", "nan", "--trace", "/tmp/x.h5"],
])
def test_bad_usage_ends_with_status_2_and_one_line(arguments):
    done = leapmap(*arguments)
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("arguments", [
    ["hop", "--trace-interval", "0.01"],
    ["info", "m.h5", "--limit", "3"],
    ["info", "m.h5", "--spec", "--failed"],
    ["sweep", "x.toml", "--retry-failed", "--overwrite"],
    ["gait", "--set", "scene.jumps=5"],
    ["gait", "--set", "jumps=5"],
])
def test_an_option_without_use_is_refused_by_its_name(arguments):
    done = leapmap(*arguments)
    assert done.returncode == 2 and done.stdout == "" and done.stderr.count("\n") == 1
    assert next(word for word in ("jumps", "trace-interval", "limit", "failed", "overwrite")
                if any(word in a for a in arguments)) in done.stderr


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
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert (tmp_path / "notes.h5").read_text() == "precious"
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
        (folder / "wide.toml").write_text(
            SMALL.replace("count = 12", "count = 1200").replace("count = 11", "count = 1100"))
        (folder / "question.toml"
         ).write_text('[design]\nslope = { from = 0.1, to = 0.5 }\n[goal]\nmaximize = ["jump_height"]\n')
        for command in (["sweep", "spec.toml", "-o",
                         "locked/map.h5"], ["boundaries", "wide.toml", "-o", "locked/c.h5"], [
                             "boundaries", "wide.toml", "--csv", "locked/c.csv"
                         ], ["design", "question.toml", "-o",
                             "locked/d.h5"], ["precision", "-o",
                                              "locked/p.h5"], ["hop", "--trace", "locked/t.h5"]):
            begin = time.monotonic()
            done = subprocess.run([*become, folder / "leapmap", *command], capture_output=True, text=True,
                                  cwd=folder)
            assert done.returncode == 3, done.stderr
            assert done.stderr.count("\n") == 1
            assert os.listdir(locked) == []
            assert time.monotonic() - begin < 3, "before the work, which takes longer"


def test_a_bad_design_is_a_status_and_the_sweep_goes_on(tmp_path):
    path = sweep(
        tmp_path,
        '[design]\nslope = { values = [0.4] }\nmass_ratio = { values = [2, 3] }\n[numerics]\nmethod = '
        '"gsl-rk8pd"\nmax_steps = 20\naudit = 0\n'
    )
    text = leapmap("info", path).stdout
    assert "failed" in text


NUMBERS = [  # a command up to its flag
    ["hop", "--drive-torque", "0.05", "--mass"],
    ["hop", "--trace", "t.h5", "--trace-interval"],
    ["hop", "--mass-ratio"],
    ["hop", "--runway"],
    ["sweep", "--dry-run", "--time-limit"],
    ["sweep", "--dry-run", "--threads"],
    ["sweep", "--dry-run", "--commit-interval"],
    ["sweep", "--dry-run", "--shards"],
    ["fit", "film.csv", "--error"],
    ["fit", "film.csv", "--scale"],
    ["fit", "film.csv", "--seed"],
    ["design", "spec.toml", "--most"],
    ["design", "spec.toml", "--sample"],
    ["design", "spec.toml", "--seed"],
    ["gait", "--most-period"],
    ["boundaries", "spec.toml", "--threads"],
    ["check", "m.h5", "--sample"],
    ["precision", "--designs"],
]


@pytest.mark.parametrize("command", NUMBERS, ids=lambda command: "".join(command[::len(command) - 1]))
@pytest.mark.parametrize("value", ["nan", "inf", "1e999", "+-1", "", "0x1p-3", "1 2"])
def test_every_flag_refuses_what_is_no_number_by_its_name(command, value, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = leapmap(*command[:-1], f"{command[-1]}={value}")
    assert done.returncode == 2 and done.stdout == "" and done.stderr.count("\n") == 1, done.stderr
    assert command[-1].strip("-").replace("-", "_") in done.stderr.replace("-", "_")
    assert os.listdir(tmp_path) == []


def test_numbers_are_read_alike_by_every_flag(tmp_path):
    plain = leapmap("hop", "--json", "--slope", "0.5", "--mass-ratio", "0.5", "--set", "runway=4").stdout
    assert leapmap("hop", "--json", "--slope=+.5", "--mass-ratio=.5", "--runway", "+4.0").stdout == plain
    assert leapmap("sweep", "--dry-run", "--threads", "1e0").returncode == 0


@pytest.mark.parametrize("arguments, used", [
    (["hop", "--set", "slope=0.1", "--set", "slope=0.2"], "slope=0.2 is used"),
    (["hop", "--slope", "0.1", "--set", "design.slope=0.2"], "design.slope=0.1 is used"),
    (["sweep", "--dry-run", "--set", "tolerance=1e-9", "--set", "numerics.tolerance=1e-8"
      ], "numerics.tolerance=1e-8 is used"),
    (["gait", "--set", "slope=0.21", "--set", "mass_ratio=3", "--set", "slope=0.2"], "slope=0.2 is used"),
])
def test_of_a_key_given_twice_the_value_that_is_used_is_said(arguments, used):
    done = leapmap(*arguments)
    assert done.returncode == 0 and used in done.stderr and done.stderr.count("\n") == 1, done.stderr


def test_a_fit_of_one_model_refuses_another_friction():
    done = leapmap("fit", INPUTS / "events_impossible.csv", "--model", "sticking", "--set",
                   "friction=coulomb")
    assert done.returncode == 2 and "both set the friction" in done.stderr and done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    "arguments", [["hop", ""], ["sweep", "", "--dry-run"], ["info", ""], ["info", "m.h5", "--at", ""],
                  ["fit", "x.csv", ""], ["design", ""], ["boundaries", ""], ["check", ""], ["gait", ""]])
def test_an_empty_name_is_refused(arguments):
    done = leapmap(*arguments)
    assert done.returncode == 2 and "is empty" in done.stderr, done.stderr


@pytest.mark.parametrize("name, words", [
    ("film.mp4", ["a video"]),
    ("points_utf16.csv", ["UTF-16"]),
    ("points_nul.csv", ["byte 0"]),
    ("points_semicolon.csv", ["none is a point's x and y"]),
    ("film_degrees_2000fps.csv", ["degrees"]),
    ("events_degrees.csv", ["jump_angle = 700", "degrees"]),
])
def test_a_file_of_another_form_is_recognised(name, words):
    done = leapmap("fit", INPUTS / name)
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    assert all(word in done.stderr for word in [name, "allowed", *words]), done.stderr


@pytest.mark.parametrize("name, words", [
    ("film_tabs.csv", ["time in s; angle 'phi' in rad"]),
    ("film_held_before_release.csv", ["the hoop is held at first", "time_offset"]),
    ("film_two_nan_rows.csv", ["time in s; angle 'phi' in rad"]),
])
def test_a_film_with_tabs_gaps_or_a_held_hoop_is_read(name, words):
    done = leapmap("fit", INPUTS / name, "--dry-run")
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert all(word in done.stdout for word in [name, *words]), done.stdout


@pytest.mark.parametrize("head, words", [(b"PK\3\4" + b"\0" * 26 + b"xl/workbook.xml", "xlsx"),
                                         (b"\xd0\xcf\x11\xe0", "xls"), (b"\x89HDF\r\n", "HDF5"),
                                         (b"<?xml version", "XML"), (b"RIFF\0\0\0\0AVI LIST", "video"),
                                         (b"\xff\xfet\0", "UTF-16")])
@pytest.mark.parametrize("how",
                         [["fit", "x"], ["sweep", "--dry-run", "--points", "x"], ["sweep", "--dry-run", "x"]],
                         ids=["film", "points", "spec"])
def test_what_is_no_text_is_named_wherever_texts_are_read(head, words, how, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "x").write_bytes(head)
    done = leapmap(*how)
    assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1, done.stderr


def test_rebounds_without_end_name_the_key_that_ends_them():
    done = leapmap("hop", "--friction", "coulomb", "--restitution", "0.5", "--set", "rest_speed=0")
    assert "rest_speed" in done.stdout.splitlines()[-2], done.stdout[-300:]


@pytest.mark.parametrize(
    "how", [["--slope", "0"], ["--slope", "0", "--mass-ratio", "13.5", "--set", "hop_height=0"],
            ["--slope", "0", "--friction", "coulomb"], ["--slope", "0", "--release-angle", "540deg"]])
def test_a_hoop_at_rest_on_its_equilibrium_is_stalled_and_its_check_agrees(how):
    done = leapmap("hop", *how)
    assert done.returncode == 0 and "trapped" in done.stdout and "agrees" in done.stdout, done.stdout


def test_a_sweep_over_level_ground_agrees_with_its_audit(tmp_path):
    sweep(
        tmp_path,
        '[scene]\nhop_height = 0\n[design]\nslope = 0\nmass_ratio = { values = [1, 13.5, 20] }\n[numerics]\n'
        'audit = 1\n'
    )


def test_a_flight_ten_million_times_as_long_as_its_contact_is_told():
    for how in (["--slope", "-1.57", "--drive-torque",
                 "1000"], ["--mass-ratio", "1e9", "--slope=-89.9deg", "--drive-torque", "10"]):
        done = leapmap("hop", *how)
        assert done.returncode == 0 and "Motor" in done.stdout, done.stderr


def test_one_endless_design_heeds_a_signal(tmp_path):
    """Before, 870 s and no end."""
    done = subprocess.run([
        "timeout", "-s", "TERM", "1", PROGRAM, "sweep", "-o", tmp_path / "m.h5", "--set", "runway=1e6",
        "--set", "mass_ratio=1e12", "--set", "audit=0"
    ], capture_output=True, text=True, timeout=60)
    assert done.returncode == 124, done.stderr  # timeout's own, if it has sent the signal
    assert "interrupted" in done.stderr
