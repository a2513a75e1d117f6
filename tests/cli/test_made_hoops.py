# SPDX-License-Identifier: GPL-3.0-or-later
"""Hoops as made, as the program tells and stores them."""
import json
import math
import re
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest
from support.program import PROGRAM, TOP, leapmap, sweep

MADE = """
[design]
slope = { from = "15 deg", to = "25 deg", count = 12 }
mass_ratio = { from = 2, to = 5, count = 11 }
[scatter]
slope = { normal = "1 deg" }
mass_ratio = { uniform = "5 %" }
samples = 256
[goal]
jump_height = { at_least = 0.9 }
jump_time = { at_most = 0.6 }
[numerics]
audit = 0
"""
ONE = MADE.replace(
    'slope = { from = "15 deg", to = "25 deg", count = 12 }\nmass_ratio = { from = 2, to = 5, count = 11 }\n',
    "")


def fields_of(path):
    with h5py.File(path) as f:
        return {name: f[name][()] for name in f if isinstance(f[name], h5py.Dataset)}


def test_a_map_holds_what_becomes_of_hoops_as_made(tmp_path):
    fields = fields_of(sweep(tmp_path, MADE))
    summaries = [
        f"{q}_{s}" for q in ("jump_height", "jump_time") for s in ("mean", "sd", "q05", "q50", "q95")
    ]
    assert {"yield", "yield_error", "cut_off", "unsolved", "jump_height", "status", *summaries
            } <= fields.keys()
    assert not any(name.endswith("_error") and name != "yield_error"
                   for name in fields), "other errors are for those who ask"
    assert fields["yield"].min() < 0.05 and fields["yield"].max() > 0.95 and (fields["yield_error"] > 0).all()
    assert (fields["cut_off"] == 0).all() and (fields["unsolved"] == 0).all()
    with np.errstate(invalid="ignore"):
        assert (fields["jump_height_q05"] <= fields["jump_height_q50"]).all()
        assert (fields["jump_height_q50"] <= fields["jump_height_q95"]).all()
    assert (fields["yield"] * 256 == np.round(fields["yield"] * 256)).all()


def test_fields_say_which_quantities_and_errors_are_told(tmp_path):
    fields = fields_of(
        sweep(tmp_path, MADE + '[output]\nfields = ["jump_angle", "yield", "jump_height_q05_error"]\n'))
    assert {"jump_angle", "jump_angle_q50", "jump_height_q05_error", "yield", "yield_error", "cut_off"
            } <= fields.keys()
    assert "jump_height" not in fields and "jump_time_mean" not in fields


def test_threads_and_an_interruption_leave_the_same_bits(tmp_path):
    (tmp_path / "one").mkdir(), (tmp_path / "two").mkdir()
    spec = MADE.replace("samples = 256", "samples = 16384")
    whole = fields_of(sweep(tmp_path / "one", spec, "--threads", "1"))
    path = tmp_path / "two" / "map.h5"
    (tmp_path / "two" / "spec.toml").write_text(spec)
    command = [PROGRAM, "sweep", tmp_path / "two" / "spec.toml", "-o", path, "--commit-interval", "0.01"]
    running = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    part = tmp_path / "two" / "map.h5.part"
    for _ in range(500):  # until the first tiles are in the file
        if running.poll() is not None or part.exists() and part.stat().st_size > 40_000:
            break
        time.sleep(0.005)
    time.sleep(0.1)
    running.send_signal(signal.SIGINT)
    assert running.wait(60) in (130, 0)
    resumed = leapmap(*command[1:], "--resume", "--threads", "2")
    assert resumed.returncode == 0, resumed.stderr
    again = fields_of(path)
    assert whole.keys() == again.keys()
    assert all(
        np.array_equal(whole[k], again[k], equal_nan=whole[k].dtype.kind == "f")
        for k in whole
        if whole[k].dtype.kind in "fiu")


def test_another_scatter_or_goal_is_another_spec(tmp_path):
    path = sweep(tmp_path, MADE)
    for change, word in (("scatter.slope={normal=0.02}", "scatter.slope"),
                         ("goal.jump_height={at_least=0.8}", "goal.jump_height"), ("seed=2", "scatter.seed")):
        done = leapmap("sweep", tmp_path / "spec.toml", "-o", path, "--resume", "--set", change)
        assert done.returncode == 2 and word in done.stderr and done.stderr.count("\n") == 1, done.stderr


def test_hop_tells_one_design_in_depth_as_the_map_has_it(tmp_path):
    fields = fields_of(sweep(tmp_path, MADE))
    (tmp_path / "one.toml").write_text(ONE)
    where = tuple(int(i) for i in np.argwhere(np.abs(fields["yield"] - 0.5) < 0.2)[0])
    told = leapmap("hop", tmp_path / "one.toml", "--scatter", "--json", "--slope",
                   repr(float(fields["slope"][where[0]])), "--mass-ratio",
                   repr(float(fields["mass_ratio"][where[1]])))
    assert told.returncode == 0, told.stderr
    made = json.loads(told.stdout)["scatter"]
    assert made["yield"] == {"value": fields["yield"][where], "error": fields["yield_error"][where]}
    assert made["quantities"]["jump_height"]["q05"]["value"] == fields["jump_height_q05"][where]
    assert made["samples"] == 256
    assert made["spreads"]["mass_ratio"] == made["spreads"]["mass_ratio"] | {
        "law": "uniform", "width": 5, "percent": True
    }
    assert sum(made["quantities"]["jump_height"]["histogram"]["counts"]) == round(
        256 * made["jumps"]["value"])
    for of in ("yield", "jump_height", "jump_time"):
        for index in made["importance"][of]["total"].values():
            assert -0.3 < index["value"] < 1.3 and 0 <= index["error"] < 0.5
    table = leapmap("hop", tmp_path / "one.toml", "--scatter").stdout
    for words in ("yield: reaches every goal", "misses jump_height { at_least = 0.9 }", "Sobol' indices",
                  "uniform 5 %", "5 %", "> the goal"):
        assert words in table, words


def test_the_order_of_flag_and_spec_does_not_matter(tmp_path):
    (tmp_path / "one.toml").write_text(ONE)
    first, second = leapmap("hop", "--scatter", tmp_path / "one.toml"), leapmap(
        "hop", tmp_path / "one.toml", "--scatter")
    assert first.returncode == 0 and first.stdout == second.stdout


def test_friction_scatters_too_and_mu_kinetic_follows(tmp_path):
    (tmp_path / "one.toml").write_text(ONE.replace("[scatter]", '[scatter]\nmu_static = { normal = "10 %" }'))
    sticking = leapmap("hop", tmp_path / "one.toml", "--scatter")
    assert sticking.returncode == 2 and "scatter.mu_static" in sticking.stderr
    assert "friction" in sticking.stderr
    made = json.loads(
        leapmap("hop", tmp_path / "one.toml", "--scatter", "--json", "--friction", "coulomb").stdout)
    assert made["mu_kinetic"] is None if "mu_kinetic" in made else made["design"]["mu_kinetic"] is None
    assert made["scatter"]["importance"]["jump_height"]["total"]["mu_static"]["value"] > 0


BAD = {
    "a scatter that exceeds the domain": ('[scatter]\nslope = { normal = "500 deg" }', [
        "scatter.slope", "exceeds the domain"
    ]),
    "a share of 0 to 1 twice as wide": ("[scatter]\noffset_ratio = { uniform = 4 }", [
        "scatter.offset_ratio", "exceeds the domain", "[0, 1]"
    ]),
    "a negative deviation": ("[scatter]\nslope = { normal = -0.1 }", [
        "scatter.slope", "out of range", "[0, inf)"
    ]),
    "a negative percentage": ('[scatter]\nslope = { normal = "-1 %" }', ["scatter.slope", "out of range"]),
    "no number": ('[scatter]\nslope = { normal = "much" }', ["scatter.slope", "much"]),
    "an unknown law": ("[scatter]\nslope = { cauchy = 1 }", ["scatter.slope", "cauchy", "normal"]),
    "two laws": ("[scatter]\nslope = { normal = 1, uniform = 1 }", ["scatter.slope", "normal"]),
    "a percentage of nothing": ('[scatter]\nrelease_spin = { normal = "5 %" }', [
        "scatter.release_spin", "of a nominal value of 0"
    ]),
    "a percentage of nothing among others": (
        '[design]\nslope = { values = [-0.2, 0, 0.2] }\n[scatter]\nslope = { normal = "20 %" }', [
            "scatter.slope", "of a nominal value of 0"
        ]),
    "a percentage of a step's rounding": (
        '[design]\nslope = { from = -0.1, to = 0.2, step = 0.1 }\n[scatter]\nslope = { normal = "20 %" }', [
            "scatter.slope", "of a nominal value of"
        ]),
    "a percentage of what follows a zero": (
        '[scene]\nfriction = "coulomb"\nmu_static = { values = [0, 0.4] }\n[scatter]\nmu_kinetic = { uniform '
        '= "20 %" }',
        ["scatter.mu_kinetic", "of a nominal value of"]),
    "degrees of a ratio": ('[scatter]\nmass_ratio = { normal = "2 deg" }', ["scatter.mass_ratio", "2 %"]),
    "a code beyond its names": ("[scatter]\nslope = { normal = 0.1 }\n[goal]\nstatus = { is = 7 }", [
        "goal.status", "jumped"
    ]),
    "a code by its order": ('[scatter]\nslope = { normal = 0.1 }\n[goal]\nstatus = { at_least = "jumped" }', [
        "goal.status", "is"
    ]),
    "a goal above its section": ("jump_height = { at_least = 1 }", ["jump_height", "[goal] above it"]),
    "a bare number": ("[scatter]\nslope = 0.1", ["scatter.slope", "normal"]),
    "what does not scatter": ("[scatter]\nrunway = { normal = 1 }", ["runway", "unknown key", "mass_ratio"]),
    "samples of no sixteenth": ("[scatter]\nslope = { normal = 0.1 }\nsamples = 1000", [
        "samples", "1000", "16"
    ]),
    "samples of nothing": ("[scatter]\nsamples = 1024", ["scatter.samples", "no effect"]),
    "a goal on an unknown field": ("[goal]\nheight = { at_least = 1 }", [
        "goal.height", "unknown key", "jump_height"
    ]),
    "a goal without scatter": ("[goal]\njump_height = { at_least = 1 }", [
        "goal.jump_height", "no effect", "[scatter]"
    ]),
    "a goal that contradicts itself": (
        "[scatter]\nslope = { normal = 0.1 }\n[goal]\njump_height = { at_least = 1, at_most = 0.5 }", [
            "goal.jump_height", "contradicts"
        ]),
    "a goal of nothing": ("[scatter]\nslope = { normal = 0.1 }\n[goal]\njump_height = {}", [
        "goal.jump_height", "at_least"
    ]),
    "is beside at_least": (
        "[scatter]\nslope = { normal = 0.1 }\n[goal]\njump_height = { is = 1, at_least = 0.5 }", [
            "goal.jump_height", "is"
        ]),
    "an unknown status": ('[scatter]\nslope = { normal = 0.1 }\n[goal]\nstatus = { is = "flown" }', [
        "goal.status", "flown", "jumped"
    ]),
    "no phases": (
        '[scene]\nfriction = "coulomb"\n[scatter]\nslope = { normal = 0.1 }\n[goal]\nphase_sequence = { is = '
        '"RXF" }',
        ["goal.phase_sequence", "RSF"]),
    "friction's field without it": (
        "[scatter]\nslope = { normal = 0.1 }\n[goal]\nslip_distance = { at_most = 1 }", [
            "goal.slip_distance", "friction"
        ]),
    "a yield without a goal": ('[scatter]\nslope = { normal = 0.1 }\n[output]\nfields = ["yield"]', [
        "yield", "[goal]"
    ]),
    "a quantile without scatter": ('[output]\nfields = ["jump_height_q05"]', ["jump_height_q05",
                                                                              "[scatter]"]),
    "a quantile that is not told": (
        '[scatter]\nslope = { normal = 0.1 }\n[output]\nfields = ["jump_height_q10"]', [
            "jump_height_q10", "_q05"
        ]),
}


@pytest.mark.parametrize("kind", BAD)
def test_a_bad_scatter_or_goal_ends_with_status_2_and_one_line(kind, tmp_path):
    text, words = BAD[kind]
    (tmp_path / "bad.toml").write_text(text + "\n")
    done = leapmap("sweep", tmp_path / "bad.toml", "-o", tmp_path / "map.h5")
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.count("\n") == 1, done.stderr
    for word in [*words, "allowed"]:
        assert word in done.stderr, done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["bad.toml"]


@pytest.mark.parametrize(
    "arguments",
    [["hop", "--set", "goal.jump_height={at_least=1}"], ["hop", "--set", "scatter.slope={normal=0.1}"],
     ["boundaries", str(TOP / "sweeps/smoke.toml"), "--set", "scatter.slope={normal=0.1}"]])
def test_what_has_no_use_is_refused(arguments):
    done = leapmap(*arguments)
    assert done.returncode == 2 and "has no effect here" in done.stderr and done.stderr.count(
        "\n") == 1, done.stderr


@pytest.mark.parametrize("spec, word", [("", "[scatter]"), (MADE, "axis")])
def test_hop_wants_one_design_and_a_scatter(spec, word, tmp_path):
    (tmp_path / "spec.toml").write_text(spec)
    done = leapmap("hop", tmp_path / "spec.toml", "--scatter")
    assert done.returncode == 2 and word in done.stderr and done.stderr.count("\n") == 1


def test_cliffs_and_info_of_such_a_map_are_of_hoops_as_drawn(tmp_path):
    path = sweep(tmp_path, MADE)
    done = leapmap("boundaries", path, "-o", tmp_path / "map.cliffs.h5")
    assert done.returncode == 0, done.stderr
    told = leapmap("info", path)
    assert told.returncode == 0 and "yield_error" in told.stdout
    with h5py.File(path) as f:
        slope, ratio, share = (float(f[name][()].ravel()[k])
                               for name, k in (("slope", 7), ("mass_ratio", 4), ("yield", 7 * 11 + 4)))
    place = leapmap("info", path, "--at", f"slope={slope!r},mass_ratio={ratio!r}")
    assert place.returncode == 0 and re.search(rf"yield +{share:.8g}\n", place.stdout), place.stdout
    assert leapmap("check", path).returncode == 0


def test_shipped_specs_say_what_they_say(tmp_path):
    plan = leapmap("sweep", TOP / "sweeps" / "made_hoops.toml", "--dry-run")
    assert plan.returncode == 0 and "yield" in plan.stdout and "1,024 manufactured hoops" in plan.stdout
    told = json.loads(leapmap("hop", TOP / "sweeps" / "paper_as_made.toml", "--scatter",
                              "--json").stdout)["scatter"]
    assert 0.9 < told["yield"]["value"] < 1 and not math.isnan(told["yield"]["error"])
