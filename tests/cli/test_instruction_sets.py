# SPDX-License-Identifier: GPL-3.0-or-later
"""One program for every machine: each instruction set it was built with solves the reference tables, here or
under qemu."""
import csv
import json
import os
import re
import shutil
import subprocess

import h5py
import pytest
from support.program import PROGRAM, TOP, leapmap

TABLES = TOP / "tests/reference"
QEMU = shutil.which("qemu-x86_64")
OLD = {"x86-64": "Nehalem", "x86-64-v3": "Haswell"}  # processors that have that set and no better one


def available():
    return re.search(r"--instruction-set NAME.*?one of ([\w, -]+)", " ".join(
        leapmap("--help").stdout.split()))[1].rstrip(" ,").split(", ")


SETS = [s.split()[0] for s in available()]


def rows(table, most):
    with open(TABLES / table) as file:
        found = list(csv.DictReader(file))
    return found[:: max(1, len(found) // most)]


def check(row, outcome, friction):
    assert outcome["status"] == row["status"]
    for name, allowed in (("jump_height", 1e-7 if friction else 1e-11), ("jump_angle",
                                                                         1e-6 if friction else 1e-11)):
        if row.get(name):
            assert outcome[name] == pytest.approx(float(row[name]), abs=allowed), name


def flags(row, names):
    return [part for name in names if row.get(name) for part in (f"--{name.replace('_', '-')}", row[name])]


DESIGN = ("slope", "mass_ratio", "offset_ratio", "inertia_factor", "release_angle", "release_spin")


@pytest.mark.parametrize("set_name", SETS)
def test_an_error_thrown_inside_a_set_is_told_in_one_line(set_name, tmp_path):
    done = leapmap("--instruction-set", set_name, "hop", "--trace", tmp_path / "t.h5", "--trace-interval",
                   "1e-9")
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert "allowed: a longer interval" in done.stderr


@pytest.mark.parametrize("set_name", SETS)
def test_each_set_solves_the_reference_tables(set_name):
    for row in rows("noslip_general.csv", 12):
        done = leapmap("--instruction-set", set_name, "hop", "--json", *flags(row, DESIGN))
        assert done.returncode == 0, done.stderr
        check(row, json.loads(done.stdout), False)
    for row in rows("coulomb_first_liftoff.csv", 8):
        done = leapmap("hop", "--instruction-set", set_name, "--json", "--friction", "coulomb",
                       "--hop-height", "0", *flags(row, DESIGN),
                       *flags(row, ("mu_static", "mu_kinetic", "restitution")))
        assert done.returncode == 0, done.stderr
        check(row, json.loads(done.stdout), True)


def test_the_best_is_used_and_a_map_says_which(tmp_path):
    (tmp_path / "spec.toml").write_text("[design]\nslope = { from = 0.2, to = 0.8, count = 50 }\n")
    told = []
    for extra in ([], *(["--instruction-set", s] for s in SETS)):
        done = leapmap("sweep", tmp_path / "spec.toml", "-o", tmp_path / f"{len(told)}.h5", *extra)
        assert done.returncode == 0, done.stderr
        with h5py.File(tmp_path / f"{len(told)}.h5") as m:
            told.append(m.attrs["instruction_set"])
    assert [t.split(",")[0] for t in told] == [SETS[-1], *SETS]
    assert told[0] == told[-1]


def test_a_set_that_is_not_there_is_refused():
    done = leapmap("hop", "--instruction-set", "x86-64-v9")
    assert done.returncode == 2 and "x86-64-v9" in done.stderr and SETS[0] in done.stderr


@pytest.mark.skipif(not QEMU or "x86-64" not in SETS, reason="needs qemu-user and a program of several sets")
@pytest.mark.parametrize("set_name", OLD)
def test_an_old_machine_runs_what_it_has(set_name):
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    on_old = [QEMU, "-cpu", OLD[set_name], PROGRAM]
    done = subprocess.run([*on_old, "--version"], capture_output=True, text=True, env=environment)
    assert done.returncode == 0 and f"using {set_name}," in done.stdout, done.stdout + done.stderr
    for friction in ("sticking", "coulomb"):
        done = subprocess.run([*on_old, "hop", "--json", "--friction", friction], capture_output=True,
                              text=True, env=environment)
        assert done.returncode == 0, done.stderr
        here = leapmap("--instruction-set", set_name, "hop", "--json", "--friction", friction)
        if set_name in SETS:
            assert json.loads(done.stdout)["jump_height"] == json.loads(here.stdout)["jump_height"]
