# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap.design, DesignProblem and leapmap.fit."""
import multiprocessing
import pickle
from concurrent.futures import ThreadPoolExecutor

import leapmap
import numpy as np
import pytest
from scipy.optimize import differential_evolution

BOX = {"slope": {"from": "5 deg", "to": "30 deg"}, "mass_ratio": {"from": 0.5, "to": 10, "scale": "log"}}


def test_design_finds_what_reaches_the_goals():
    found = leapmap.design(**BOX, goal={"jump_height": {"at_least": 0.9}}, minimize="mass_ratio",
                           sample=20_000)
    assert found.reached and len(found) >= 1
    o = leapmap.solve(slope=found.parameters["slope"], mass_ratio=found.parameters["mass_ratio"])
    assert (o.jump_height >= 0.9).all()
    assert (found.objectives["mass_ratio"] == found.parameters["mass_ratio"]).all()
    assert found.outcomes.jump_height == pytest.approx(o.jump_height, abs=1e-14)
    by = leapmap.gradient(slope=found.parameters["slope"][0], mass_ratio=found.parameters["mass_ratio"][0],
                          of="jump_height")
    assert found.gradients["jump_height"]["slope"][0] == pytest.approx(by["slope"], rel=1e-9)
    assert any("jump_height" in bind for bind in found.binds[0])
    assert found.cliff_distance.shape == (len(found),)


def test_a_miss_says_so():
    found = leapmap.design(**BOX, goal={"jump_height": {"at_least": 3.0}}, minimize=["slope"], sample=20_000)
    assert not found.reached and 0.5 < found.missed["jump_height"] < 3.0


def test_a_front_is_in_order():
    found = leapmap.design(**BOX, maximize=["jump_height"], minimize=["mass_ratio"], sample=20_000)
    assert len(found) > 50 and 0 < found.hypervolume < 1
    assert (np.diff(found.objectives["jump_height"]) < 0).all()
    assert (np.diff(found.objectives["mass_ratio"]) < 0).all()


def test_bad_questions_raise_value_errors():
    for arguments, word in (({**BOX, "goal": {"jump_height": {"is": 1.0}}, "minimize": ["slope"]},
                             "by no hoop exactly"), ({}, "free"), ({**BOX, "maximize": ["height"]}, "height"),
                            ({**BOX, "goal": {"nothing": {"is": 1}},
                              "maximize": ["jump_height"]}, "nothing")):
        with pytest.raises(ValueError, match=word):
            leapmap.design(**arguments)


def test_the_problem_is_one_for_scipy_and_for_pygmo():
    problem = leapmap.DesignProblem(**BOX, goal={"jump_height": {"at_least": 0.9}}, minimize=["mass_ratio"])
    assert problem.names == ["slope", "mass_ratio"] and problem.get_nobj() == 1
    assert problem.has_batch_fitness()
    low, high = problem.get_bounds()
    assert np.degrees(low[0]) == pytest.approx(5) and high[1] == 10
    assert problem.fixed["friction"] == "sticking" and problem.fixed["offset_ratio"] == 1.0
    assert "slope" not in problem.fixed
    found = differential_evolution(problem.cost, problem.bounds, seed=1, maxiter=20)
    best = leapmap.design(**BOX, goal={"jump_height": {"at_least": 0.9}}, minimize=["mass_ratio"],
                          sample=20_000)
    assert found.fun >= best.objectives["mass_ratio"][0] * (1 - 1e-11)
    assert problem.evaluations > 100
    one, two = problem.fitness(low), problem.fitness(high)
    assert np.array_equal(problem.batch_fitness(np.concatenate((low, high))), np.concatenate(
        (one, two))), "what pygmo asks of a problem"
    assert one[0] >= 1e30, "nothing jumps at five degrees and half a mass"
    again = pickle.loads(pickle.dumps(problem))
    assert again.cost(found.x) == found.fun
    with pytest.raises(ValueError, match="slope = 0 is outside its bounds; allowed: from 0.08"):
        problem.cost([0.0, 1.0])
    with pytest.raises(ValueError, match="2 numbers a row: slope, mass_ratio"):
        problem.cost([0.1])
    with pytest.raises(ValueError, match="one design"):
        problem.cost([low, high])


def test_many_threads_and_forked_processes_may_ask_one_problem():
    problem = leapmap.DesignProblem(**BOX, maximize=["jump_height"])
    low, high = map(np.array, problem.get_bounds())
    places = low + (high - low) * np.random.default_rng(1).random((8, 3000, 2))
    alone = [problem.costs(some) for some in places]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(problem.costs, places))
    assert all(np.array_equal(a, b) for a, b in zip(alone, together))
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert np.array_equal(pool.apply_async(problem.costs, (places[0],)).get(timeout=60), alone[0])


# both take twenty seconds
@pytest.mark.parametrize("model", ["sticking", pytest.param(None, marks=pytest.mark.slow)])
def test_a_fit_to_arrays_finds_the_release(model):
    asked = {"model": model} if model else {}
    m = leapmap.trace(release_angle="185 deg", release_spin=0.2, interval=2e-3)
    t, first = np.unique(m.t, return_index=True)
    wrong = leapmap.fit({"t": t, "phi": np.asarray(m.phi)[first]}, slope=0.35, **asked)
    assert not any(one.explains for one in wrong
                   ) and wrong[0].misfit > 10, "another slope than the film's does not pass for an answer"
    best = leapmap.fit(
        {"t": t, "phi": np.asarray(m.phi)[first] + 1e-3 * np.random.default_rng(2).standard_normal(len(t))},
        **asked)[0]
    assert best.friction == "sticking" and best.found and best.explains and 0.5 < best.misfit < 1.5
    for name, truth in (("release_angle", np.radians(185)), ("release_spin", 0.2)):
        assert abs(best.parameters[name].value - truth) < 4 * best.parameters[name].error < 0.01
    assert best.correlations.shape == (2, 2) and best.correlations[0, 1] == best.correlations[1, 0]
    assert np.sqrt(np.mean(best.residuals**2)) == pytest.approx(best.error, rel=1e-6), "in radians"


def test_a_fit_to_events_has_their_chi_square():
    o = leapmap.solve(slope=0.38)
    one, = leapmap.fit(
        {"jump_time": (float(o.jump_time), 1e-3), "jump_height": (float(o.jump_height) + 0.02, 0.02)},
        model="sticking", slope={"from": 0.3, "to": 0.45})
    assert one.parameters["slope"].value == pytest.approx(0.38, abs=5e-3) and one.degrees == 1
    assert 0.01 < one.chi_square < 1.0


def test_bad_measurements_raise_value_errors():
    for data, word in (({"t": [0, 1], "phi": [3, 3]}, "three"), ({
            "t": [0, 2, 1], "phi": [3, 3, 3]
    }, "ascend"), ({"t": [0, 1, 2]}, "three"), ({"jump": (1, 0.1)}, "jump"), ({
            "jump_time": (0.3, 0.01), "jump_height": 1.0
    }, "jump_height = 1.0 is not an event"), ({"jump_time": (0.3, 0.01, 1.0)}, "not an event"), ({
            "jump_time": "12"
    }, "not an event"), ({"jump_time": {0.3, 0.1}}, "not an event")):
        with pytest.raises(ValueError, match=word):
            leapmap.fit(data)
    with pytest.raises(ValueError, match="model"):
        leapmap.fit({"jump_time": (0.5, 0.1)}, model="sliding")
    for given in ({"error": 0.1}, {"allow_gaps": True}):
        with pytest.raises(ValueError, match="no effect with events"):
            leapmap.fit({"jump_time": (0.5, 0.1)}, **given)
