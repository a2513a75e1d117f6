# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap.scatter: one design as made."""
import inspect

import numpy as np
import pytest

import leapmap

TOLERANCES = {"slope": {"normal": "1 deg"}, "mass_ratio": {"uniform": "5 %"}}
GOAL = {"jump_height": {"at_least": 0.95}}


def test_what_it_tells_is_of_the_hoops_it_returns():
    r = leapmap.scatter(slope=0.4, scatter=TOLERANCES, goal=GOAL)
    o, made = r["outcomes"], r["made"]
    assert r["samples"] == 1024 and made["slope"].shape == o.jump_height.shape == (1024,)
    reached = o.jump_height >= 0.95
    assert r["yield"].value == reached.mean() and r["missed"]["jump_height"].value == (~reached).mean()
    assert r["jump_height"]["mean"].value == pytest.approx(np.nanmean(o.jump_height), rel=1e-12)
    assert r["jump_height"]["q50"].value == pytest.approx(np.nanmedian(o.jump_height), rel=1e-12)
    assert 0 < r["yield"].error < 0.02
    assert np.std(made["slope"]) == pytest.approx(np.radians(1), rel=0.01)
    assert np.ptp(made["mass_ratio"]) == pytest.approx(0.1 * 20 / 8.2, rel=0.01)
    again = leapmap.solve(slope=made["slope"], mass_ratio=made["mass_ratio"])
    assert np.array_equal(again.jump_height, o.jump_height, equal_nan=True)


def test_a_spec_a_dictionary_and_arguments_say_the_same(tmp_path):
    (tmp_path / "s.toml").write_text(
        '[design]\nslope = 0.41\n[scatter]\nslope = { normal = "1 deg" }\nmass_ratio = { uniform = "5 %" }\n'
        '[goal]\njump_height = { at_least = 0.95 }\n'
    )
    one = leapmap.scatter(tmp_path / "s.toml")
    two = leapmap.scatter({"design": {"slope": 0.41}, "scatter": TOLERANCES, "goal": GOAL})
    three = leapmap.scatter(slope=0.41, scatter=TOLERANCES, goal=GOAL, threads=2)
    for other in (two, three):
        assert one["yield"] == other["yield"] and one["first"]["yield"] == other["first"]["yield"]
        assert one["shrink"] == other["shrink"]


def test_indices_say_what_varies_and_nothing_is_dropped_without_a_word():
    r = leapmap.scatter(
        slope="3.5 deg", mass_ratio=3.0,
        scatter={"slope": {"normal": "0.8 deg"}, "mass_ratio": {"normal": "1 %"}, "samples": 4096})
    assert 0.1 < r["jumps"].value < 0.99, "some do not jump"
    assert r["total"]["jumps"]["slope"].value > 0.9 and r["total"]["jumps"]["mass_ratio"].value < 0.2
    assert 0 < r["pairs"]["jump_height"] < 1 and np.isfinite(r["total"]["jump_height"]["slope"].value)
    assert "yield" not in r["first"] and np.isnan(r["yield"].value), "there are no goals"


@pytest.mark.parametrize("arguments, words",
                         [({}, "[scatter]"), ({"scatter": {"slope": {"normal": -1}}}, "scatter.slope"),
                          ({"scatter": {"slop": {"normal": 1}}}, "slop"),
                          ({"scatter": TOLERANCES, "goal": {"height": {"is": 1}}}, "height"),
                          ({"scatter": TOLERANCES, "slope": [0.1, 0.2]}, "one design"),
                          ({"scatter": {"offset_ratio": {"uniform": 5}}}, "exceeds the domain"),
                          ({"scatter": TOLERANCES, "slop": 1}, "slop")])
def test_bad_arguments_are_refused_by_name(arguments, words):
    with pytest.raises(ValueError, match=words.replace("[", r"\[")):
        leapmap.scatter(**arguments)


def test_it_is_documented():
    assert "Sobol' indices" in leapmap.scatter.__doc__
    assert "threads" in inspect.signature(leapmap.scatter).parameters
