# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives and cliffs as the program tells and stores them."""
import csv
import json
import math
import os

import h5py
import numpy as np
import pytest

from support.program import TOP, leapmap

GRID = [
    "--set", "slope={from=0.3,to=0.6,count=13}", "--set", "mass_ratio={from=1.0,to=4.0,count=11}", "--quiet"
]


def test_hop_tells_derivatives_that_differences_of_its_own_answers_have():
    base = json.loads(leapmap("hop", "--json", "--gradient").stdout)
    h = 1e-5
    beside = [
        json.loads(
            leapmap("hop", "--json", "--slope", str(0.4 + way * h), "--set", "tolerance=1e-13").stdout)
        for way in (-1, 1)
    ]
    for name in ("jump_height", "jump_time", "dip", "flight_time"):
        difference = (beside[1][name] - beside[0][name]) / (2 * h)
        assert base["gradient"][name]["slope"] == pytest.approx(difference, rel=1e-6)
    table = leapmap("hop", "--gradient").stdout
    assert "jump_height_by" not in table and "inertia_factor" in table and "jump_time [s]" in table


def test_a_map_holds_the_derivatives_asked_for_and_its_audit_looks_at_them(tmp_path):
    path = str(tmp_path / "m.h5")
    told = leapmap("sweep", "-o", path, *GRID[:4], "--set", 'gradients=["jump_height","jump_time"]', "--set",
                   'gradients_by=["mass_ratio","slope"]', "--set", "audit=0.5", "--set",
                   "tolerance=1e-12").stdout
    assert "differences in long double: 0 wrong" in told
    with h5py.File(path) as f:
        names = {n for n in f if "_by_" in n}
        assert names == {
            "jump_height_by_slope", "jump_height_by_mass_ratio", "jump_time_by_slope",
            "jump_time_by_mass_ratio"
        }
        assert f["jump_height_by_slope"].attrs["units"] == "rad-1"
        assert f["jump_time_by_mass_ratio"].attrs["units"] == "s"
        assert f.attrs["audit_gradient_designs"] > 20 and f.attrs["audit_gradients_wrong"] == 0
        assert 0 <= f.attrs["audit_gradient_max_error"] < 1e-6
        heights, slopes = f["jump_height"][()], f["slope"][()]
        found = f["jump_height_by_slope"][()]
    assert np.array_equal(np.isnan(found), np.isnan(heights))
    smooth = np.abs(np.diff(heights, axis=0)) < 0.08  # no cliff between these neighbours
    mean = (found[1:] + found[:-1]) / 2
    ratio = np.diff(heights, axis=0) / np.diff(slopes)[:, None]
    # The trapezoidal rule over a step of 0.025 radians.
    assert smooth.sum() > 80 and np.nanmedian(np.abs(mean - ratio)[smooth]) < 0.02
    assert leapmap("check", path).returncode == 0
    assert "jump_time_by_slope" in leapmap("info", path).stdout


def test_gradients_do_not_change_what_else_a_map_holds_nor_depend_on_threads(tmp_path):
    paths = [str(tmp_path / f"{k}.h5") for k in range(3)]
    asked = ["--set", 'gradients=["jump_height","first_jump_time","dip"]']
    leapmap("sweep", "-o", paths[0], *GRID)
    leapmap("sweep", "-o", paths[1], *GRID, *asked, "--threads", "1")
    leapmap("sweep", "-o", paths[2], *GRID, *asked, "--threads", "2")
    with h5py.File(paths[0]) as plain, h5py.File(paths[1]) as one, h5py.File(paths[2]) as two:
        for name in plain:
            if name != "entry":
                assert plain[name][()].tobytes() == one[name][()].tobytes(), name
        for name in one:
            if name != "entry":
                assert one[name][()].tobytes() == two[name][()].tobytes(), name


@pytest.mark.parametrize("settings, words", [
    (['gradients=["jump_heigth"]'], "jump_heigth"),
    (['gradients=["status"]'], "status"),
    (['gradients=["slip_distance"]'], "coulomb"),
    (['gradients_by=["slope"]'], "gradients_by"),
    (['gradients=["jump_height"]', 'gradients_by=["mu_static"]'], "mu_static"),
    (['gradients=["jump_height"]', 'method="gsl-rk8pd"'], "gsl-rk8pd"),
])
def test_gradients_that_cannot_be_had_are_refused_in_one_line(tmp_path, settings, words):
    path = str(tmp_path / "m.h5")
    sets = [word for setting in settings for word in ("--set", setting)]
    answer = leapmap("sweep", "-o", path, *GRID, *sets)
    assert answer.returncode == 2 and words in answer.stderr and answer.stderr.count("\n") == 1
    assert not os.path.exists(path)


def test_boundaries_are_told_and_written_of_a_spec_and_of_its_map(tmp_path):
    path, cliffs, table = (str(tmp_path / name) for name in ("m.h5", "m.cliffs.h5", "m.csv"))
    leapmap("sweep", "-o", path, *GRID)
    told = leapmap("boundaries", path, "-o", cliffs, "--csv", table).stdout
    assert "threshold" in told and "fold" in told
    with h5py.File(cliffs) as f:
        assert f.attrs["filetype"] == "leapmap cliffs"
        count = len(f["cliff"])
        assert f["slope"].shape == f["mass_ratio"].shape == f["kind"].shape == (count,)
        assert f["slope"].attrs["units"] == "rad" and "0 threshold, 1 fold" in f["kind"].attrs["long_name"]
        assert len(f["curve_slope"]) == len(f["curve"]) and f["curve"][0] == 0
        slopes, ratios, along = f["slope"][()], f["mass_ratio"][()], f["along"][()]
        below, above = f["below_jumps_on"][()], f["above_jumps_on"][()]
    with open(table, encoding="utf-8") as f:
        rows = list(csv.DictReader(f))
    assert {row["kind"] for row in rows} == {"threshold", "fold"}
    # A cliff where a curve changes its kind is on two.
    assert len({(row["along"], row["slope"], row["mass_ratio"]) for row in rows}) == count
    assert count <= len(rows) < 1.2 * count
    # At the place and below it is one outcome, the next number above another.
    i = int(np.flatnonzero((along == 0) & (below > 0) & (above > 0))[0])
    for slope, jumps_on in ((slopes[i], below[i]), (math.nextafter(slopes[i], 1.0), above[i])):
        hop = json.loads(
            leapmap("hop", "--json", "--slope", repr(float(slope)), "--mass-ratio",
                    repr(float(ratios[i]))).stdout)
        assert hop["candidates"] == jumps_on


@pytest.mark.parametrize("arguments, words", [
    ([TOP / "sweeps" / "paper.toml"], "no axes"),
    (["no_such_spec.toml"], "no_such_spec.toml"),
    ([], "SPEC|MAP"),
    ([TOP / "sweeps" / "slope_mass_ratio.toml", "--phases"], "--phases"),
])
def test_boundaries_of_no_grid_are_refused_in_one_line(arguments, words):
    answer = leapmap("boundaries", *arguments)
    assert answer.returncode in (2, 3) and words in answer.stderr and answer.stderr.count("\n") == 1


def test_a_table_of_cliffs_takes_nobodys_place(tmp_path):
    path, table = str(tmp_path / "m.h5"), str(tmp_path / "m.csv")
    leapmap("sweep", "-o", path, *GRID)
    before = open(path, "rb").read()
    for csv_name in (path, str(tmp_path / "c.h5")):
        answer = leapmap("boundaries", path, "-o", str(tmp_path / "c.h5"), "--csv", csv_name)
        assert answer.returncode == 2 and "--csv" in answer.stderr and answer.stderr.count("\n") == 1
    assert open(path, "rb").read() == before
    assert leapmap("boundaries", path, "--csv", table).returncode == 0 and os.listdir(tmp_path)
    assert not os.path.exists(table + ".part")


def test_info_tells_a_place_of_the_map_and_how_far_its_cliffs_are(tmp_path):
    path = str(tmp_path / "m.h5")
    leapmap("sweep", "-o", path, *GRID)
    told = leapmap("info", path, "--at", "slope=0.4,mass_ratio=2.4").stdout
    assert "jumped at lift-off 2" in told and "jump_height" in told and "Derivatives" in told
    line = next(line for line in told.splitlines() if line.strip().startswith("slope 0.45"))
    assert "threshold" in line and "jumped at lift-off 1" in line
    assert "over all directions" in told
    for at, words in (("slope=0.4", "mass_ratio"), ("slope=0.4,mass_ratio=50", "outside"),
                      ("slope=x,mass_ratio=2", "x"), ("spin=1,mass_ratio=2", "spin"), ("slope=0.4,slope=0.4",
                                                                                       "slope")):
        answer = leapmap("info", path, "--at", at)
        assert answer.returncode == 2 and words in answer.stderr and answer.stderr.count(
            "\n") == 1, answer.stderr
