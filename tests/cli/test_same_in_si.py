# SPDX-License-Identifier: GPL-3.0-or-later
"""A torque in N m stays that torque wherever it goes: tables, commands, places, tolerances."""
import csv
import json
import re
import shlex

import h5py
import numpy as np
import pytest
from support.program import PROGRAM, TOP, finished, leapmap

MOTOR = [TOP / "sweeps/drawing.toml", "--friction", "coulomb", "--mu-static", "0.6", "--set", "slope=0"]
MASSES = ["--set", 'hoop.slug.mass={values=["50 g","85 g"]}']
TORQUES = ["--set", 'drive_torque={from="10 mN m",to="80 mN m",count=8}']


def heights(path):
    with h5py.File(path) as m:
        return np.asarray(m["jump_height"]).ravel()


@pytest.fixture(scope="module")
def driven(tmp_path_factory):
    path = tmp_path_factory.mktemp("driven") / "map.h5"
    assert leapmap("sweep", *MOTOR, *MASSES, *TORQUES, "-o", path, "--quiet").returncode == 0
    return path


@pytest.mark.parametrize("units", [[], ["--units", "g mN.m mm"]])
def test_an_exported_table_is_swept_again_to_the_same_heights(driven, tmp_path, units):
    table, parameters, again = (tmp_path / name for name in ("all.csv", "parameters.csv", "again.h5"))
    assert leapmap("export", driven, "-o", table, *units).returncode == 0
    rows = list(csv.reader(table.open()))
    assert rows[0][0].startswith("hoop.slug.mass [") and rows[0][1].startswith("drive_torque [")
    assert rows[0][1].endswith("[mN.m]" if units else "[N m]")
    parameters.write_text("\n".join(",".join(row[:2]) for row in rows) + "\n")
    assert leapmap("sweep", *MOTOR, "--points", parameters, "-o", again, "--quiet").returncode == 0
    # to the 15 digits of the table
    np.testing.assert_allclose(heights(again), heights(driven), rtol=1e-11)


def test_what_a_search_found_is_swept_and_told_as_it_was_found(tmp_path):
    table, again = tmp_path / "found.csv", tmp_path / "again.h5"
    free = ["--set", 'drive_torque={from="0.03 N m",to="0.05 N m"}', "--hoop.slug.mass",
            '{from="60 g",to="120 g"}']
    found = leapmap("design", *MOTOR, *free, "--set", "maximize=jump_height", "--most", "1", "--sample",
                    "2048", "--csv", table, "--json")
    told = json.loads(found.stdout)
    [design] = told["designs"]
    assert told["units"] == {"drive_torque": "N m"}
    assert 0.03 <= design["parameters"]["drive_torque"] <= 0.05
    header, row = csv.reader(table.open())
    assert header == ["hoop.slug.mass", "drive_torque [N m]"]
    assert float(row[1]) == pytest.approx(design["parameters"]["drive_torque"], rel=1e-14)
    assert leapmap("sweep", *MOTOR, "--points", table, "-o", again, "--quiet").returncode == 0
    assert heights(again)[0] == pytest.approx(design["fields"]["jump_height"], rel=1e-12)
    hop = json.loads(leapmap(*shlex.split(design["hop"])[1:], "--json").stdout)
    assert hop["jump_height"] == pytest.approx(design["fields"]["jump_height"], rel=1e-12)


def test_the_command_of_a_found_hoop_scatters_as_the_search_did():
    """Between 60 g, whose units the search has, and 160 g."""
    free = ["--set", 'drive_torque="0.04 N m"', "--hoop.slug.mass", '{from="60 g",to="160 g"}', "--set",
            'tolerances.drive_torque={normal="5 mN.m"}', "--set", "samples=64", "--set",
            "goal.jump_height={at_least=0.4}", "--set", "goal.yield={at_least=0.1}"]
    told = json.loads(leapmap("design", *MOTOR, *free, "--set", "maximize=hoop.slug.mass", "--most", "1",
                              "--sample", "16", "--json").stdout)
    [design] = told["designs"]
    words = shlex.split(design["hop"])
    width = next(word for word in words if word.startswith("scatter.drive_torque="))
    torque = float(words[words.index("--drive-torque") + 1])
    # both in the found hoop's own unit: their ratio is that of 5 mN m to 0.04 N m
    number = float(re.search(r"normal = ([-+.e\d]+)", width).group(1))
    assert number / torque == pytest.approx(0.125, rel=1e-9)
    scatter = json.loads(leapmap(*words[1:], "--json").stdout)["scatter"]
    assert scatter["yield"]["value"] == pytest.approx(design["yield"]["value"], abs=1e-12)  # the same samples
    assert 0 < scatter["yield"]["value"] < 1


def test_a_place_on_a_map_is_named_in_the_units_of_its_axes(driven):
    told = leapmap("info", driven, "--at", "hoop.slug.mass=85 g,drive_torque=80 mN m", "--units", "mm")
    height = float(re.search(r"jump_height +([.\d]+) +mm", told.stdout).group(1))
    assert height == pytest.approx(120 * heights(driven)[-1], rel=1e-6)


@pytest.mark.parametrize("values", ['{values=["0.04 N m",0.5]}', '{from=0.01,to="0.05 N m",count=3}'])
def test_an_axis_with_a_unit_at_some_of_its_numbers_is_refused(values, tmp_path):
    done = finished(PROGRAM, "sweep", *MOTOR, "--set", f"drive_torque={values}", "-o", tmp_path / "x.h5")
    assert done.returncode == 2
    assert "design.drive_torque" in done.stderr and "a unit at all of them or at none" in done.stderr


def test_a_list_with_a_unit_in_some_lines_is_refused(tmp_path):
    points = tmp_path / "points.csv"
    points.write_text("hoop.slug.mass [g],drive_torque\n160,0.3\n160,0.04 N m\n")
    done = finished(PROGRAM, "sweep", *MOTOR, "--points", points, "-o", tmp_path / "x.h5")
    assert done.returncode == 2
    assert "points.csv:3: column drive_torque" in done.stderr and "unit" in done.stderr


def test_a_tolerance_in_newton_metres_of_a_torque_that_is_not_given_is_one_for_every_hoop(tmp_path):
    """Each design's statistics are those of hop's of that hoop alone."""
    path, width = tmp_path / "made.h5", 'tolerances.resisting_torque={uniform="0.2 mN m"}'
    masses = ["--set", 'hoop.slug.mass={values=["60 g","160 g"]}']
    common = [TOP / "sweeps/drawing.toml", "--set", "slope=0.5", "--set", width, "--set", "samples=64"]
    assert leapmap("sweep", *common, *masses, "-o", path, "--quiet").returncode == 0
    with h5py.File(path) as m:
        means = np.asarray(m["jump_height_mean"])
    for mass, mean in zip(("60 g", "160 g"), means):
        told = leapmap("hop", *common, "--hoop.slug.mass", mass, "--scatter", "--json").stdout
        assert json.loads(told)["scatter"]["quantities"]["jump_height"]["mean"]["value"] == pytest.approx(
            mean, rel=1e-11)
