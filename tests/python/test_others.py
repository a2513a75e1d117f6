# SPDX-License-Identifier: GPL-3.0-or-later
"""Optimisers and uncertainty tools of others call the module as it is."""
import numpy as np
import pytest

import leapmap


def test_scipys_differential_evolution_finds_the_highest_jump_by_vectorised_calls():
    optimize = pytest.importorskip("scipy.optimize")

    def worse(x):  # x: (2, population)
        return -np.nan_to_num(leapmap.solve(slope=x[0], mass_ratio=x[1], fields=["jump_height"]).jump_height)
    bounds = [(np.radians(5), np.radians(40)), (0.5, 10.0)]
    best = optimize.differential_evolution(worse, bounds, vectorized=True, updating="deferred", seed=1,
                                           maxiter=60, polish=False)
    grid = leapmap.solve(slope=np.linspace(*bounds[0], 300)[:, None], mass_ratio=np.linspace(*bounds[1], 300),
                         fields=["jump_height"])
    assert -best.fun > np.nanmax(grid.jump_height) - 1e-3  # a search is no worse than a grid of 90,000


def test_sobol_indices_are_openturns_own_estimators_within_their_errors():
    ot = pytest.importorskip("openturns")
    tolerances = {"slope": {"normal": 0.02}, "mass_ratio": {"normal": 0.1}, "release_angle": {"uniform": 0.1}}
    ours = leapmap.scatter(slope=0.4, mass_ratio=3.0, scatter=tolerances | {"samples": 16384},
                           goal={"jump_height": {"at_least": 1.1}})
    law = ot.ComposedDistribution(
        [ot.Normal(0.4, 0.02),
         ot.Normal(3.0, 0.1), ot.Uniform(np.pi - 0.1, np.pi + 0.1)])
    assert ours["pairs"][
        "jump_height"] == 1.0, "every hoop jumps, so that others' estimators have no gaps to mind"

    def outputs(sample):
        x = np.asarray(sample)
        o = leapmap.solve(slope=x[:, 0], mass_ratio=x[:, 1], release_angle=x[:, 2], fields=["jump_height"])
        return np.stack([o.jump_height, o.jump_height >= 1.1], 1).astype(float)
    size = 20000
    ot.RandomGenerator.SetSeed(7)
    design = ot.SobolIndicesExperiment(law, size).generate()
    values = outputs(design)
    for column, of in ((0, "jump_height"), (1, "yield")):
        for estimator in (ot.SaltelliSensitivityAlgorithm, ot.MartinezSensitivityAlgorithm,
                          ot.JansenSensitivityAlgorithm):
            theirs = estimator(design, ot.Sample(values[:, column:column + 1]), size)
            for order, indices in (("first", theirs.getFirstOrderIndices()), ("total",
                                                                              theirs.getTotalOrderIndices())):
                for name, index in zip(tolerances, indices):
                    # Pseudo-random numbers of theirs, 20,000 of them: errors of some hundredths.
                    assert index == pytest.approx(
                        ours[order][of][name].value,
                        abs=0.05 + 4 * ours[order][of][name].error), (of, order, name, estimator)


def test_openturns_propagates_tolerances_through_a_python_function():
    ot = pytest.importorskip("openturns")

    def heights(sample):
        x = np.asarray(sample)
        return leapmap.solve(slope=x[:, 0], mass_ratio=x[:, 1], fields=["jump_height"]).jump_height[:, None]
    function = ot.PythonFunction(2, 1, func_sample=heights)
    ot.RandomGenerator.SetSeed(1)
    made = ot.ComposedDistribution([ot.Normal(0.40, 0.005), ot.Normal(20 / 8.2, 0.01)])
    result = function(made.getSample(2000))
    assert abs(result.computeMean()[0] - leapmap.solve().jump_height) < 0.05
    assert 0 < result.computeStandardDeviation()[0] < 0.2
