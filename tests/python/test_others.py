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
    best = optimize.differential_evolution(worse, bounds, vectorized=True, updating="deferred", seed=1, maxiter=60, polish=False)
    grid = leapmap.solve(slope=np.linspace(*bounds[0], 300)[:, None], mass_ratio=np.linspace(*bounds[1], 300), fields=["jump_height"])
    assert -best.fun > np.nanmax(grid.jump_height) - 1e-3  # a search is no worse than a grid of 90,000


def test_openturns_propagates_tolerances_through_a_python_function():
    ot = pytest.importorskip("openturns")

    def heights(sample):
        x = np.asarray(sample)
        return leapmap.solve(slope=x[:, 0], mass_ratio=x[:, 1], fields=["jump_height"]).jump_height[:, None]
    function = ot.PythonFunction(2, 1, func_sample=heights)
    ot.RandomGenerator.SetSeed(1)
    made = ot.ComposedDistribution([ot.Normal(0.40, 0.005), ot.Normal(20 / 8.2, 0.01)])
    result = function(made.getSample(2000))
    assert abs(result.computeMean()[0] - leapmap.solve().jump_height) < 0.05 and 0 < result.computeStandardDeviation()[0] < 0.2
