# SPDX-License-Identifier: GPL-3.0-or-later
"""From a question to designs: what leapmap design does, and the same question for optimizers of others."""
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from leapmap import _core
from leapmap._arguments import array, mapping, names, path, whole
from leapmap._results import Outcomes
from leapmap._sweep import _keyed, _toml


@dataclass(frozen=True)
class Found:
    """What design found, best first, each design the best of a basin of its own; of two objectives the front, along the first.

    reached: False: no design met reaches every goal, and what is here is the nearest miss; missed tells each goal's field there.
    parameters, objectives: {name: array}. outcomes: Outcomes of them as drawn.
    gradients: {field: {free parameter: array}}, of the quantities that objectives and goals name; empty of a front.
    binds: of each design, in words, what keeps it from being better. cliff_distance: of the nearest cliff, in shares of the box.
    yield_: with scatter, the share of the hoops made that reach every goal; else NaN.
    hypervolume: of a front, the share of the rectangle between its ends that it dominates; else NaN.
    evaluations: designs solved. engines: whether pagmo and NLopt took part."""
    reached: bool
    parameters: dict
    objectives: dict
    outcomes: Outcomes
    gradients: dict
    binds: list
    cliff_distance: np.ndarray
    yield_: np.ndarray
    missed: dict
    hypervolume: float
    evaluations: int
    seconds: float
    engines: bool

    def __len__(self):
        return len(self.cliff_distance)


def design(spec=None, *, goal=None, maximize=(), minimize=(), scatter=None, seed=1, most=0, sample=0, threads=0, **overrides):
    """The designs of a box that reach their goals best; a Pareto front of two objectives. As `leapmap design`.

        leapmap.design(slope={"from": "2 deg", "to": "20 deg"}, mass_ratio={"from": 0.1, "to": 50, "scale": "log"},
                       friction="coulomb", goal={"jump_height": {"at_least": 0.8}}, minimize=["mass_ratio"])

    spec: a TOML file's path, or a dictionary {section: {key: value}}; parameters with "from" and "to" are free.
    goal: {field: {"at_least": ...}, {"at_most": ...}, both, or {"is": ...}}. maximize, minimize: one or two fields or free
        parameters in all. scatter: as leapmap.scatter has it; then yield may be a goal or an objective.
    seed: the same seed, the same designs. most: designs told; 0: 8, of a front 2,048. sample: designs of the first, dense sample; 0: a second or two.
    threads: 0 for all cores. overrides: keys of the spec.

    Returns Found. Raises ValueError, naming the key, its value and what is allowed. Ctrl-C ends it."""
    told = _core.design(*_question(spec, goal, maximize, minimize, scatter, overrides), whole("seed", seed, 0), whole("most", most, 0, 10**5),
                        whole("sample", sample, 0, 2**27), whole("threads", threads, 0, 4096))
    return Found(**told | {"outcomes": Outcomes(told["outcomes"], {"friction": "any"})})


class DesignProblem:
    """The same question for optimizers of others: a problem as pygmo takes it, and a function as scipy does.

        problem = leapmap.DesignProblem(slope={"from": 0.1, "to": 0.5}, mass_ratio={"from": 0.1, "to": 20}, maximize=["jump_height"])
        scipy.optimize.differential_evolution(problem.cost, problem.bounds)
        pygmo.problem(problem)

    Decision vectors hold the free parameters, in their own units, in the order of names; fixed holds the others, as solve takes
    them. Costs are the objectives, less is better (those to maximize with their sign turned); of a design that misses a goal 1e30
    and more, the more it misses."""

    def __init__(self, spec=None, *, goal=None, maximize=(), minimize=(), scatter=None, threads=0, **overrides):
        self._asked = (*_question(spec, goal, maximize, minimize, scatter, overrides), whole("threads", threads, 0, 4096))
        self._start()

    def _start(self):
        self._core = _core.Problem(*self._asked)
        self.names = [row[0] for row in self._core.free()]
        self.bounds = [row[1:3] for row in self._core.free()]
        self.objectives = self._core.objectives()
        self.fixed = self._core.fixed()

    def __getstate__(self):  # pygmo copies problems, and sends them to other processes
        return self._asked

    def __setstate__(self, asked):
        self._asked = asked
        self._start()

    @property
    def evaluations(self):
        """Designs judged so far."""
        return self._core.evaluations()

    def judge(self, places):
        """Of an array of designs, a row each: costs, an array of as many rows, and violations, 0 where every goal is reached."""
        rows = np.atleast_2d(array("places", places) if np.size(places) else np.empty((0, len(self.names))))
        return self._core.judge(rows)

    def costs(self, places):
        """Of an array of designs, a row each: an array of costs, a row each."""
        costs, violations = self.judge(places)
        return np.where(violations[:, None] > 0, 1e30 * (1 + violations[:, None]), costs)

    def cost(self, place):
        """Of one design, the first objective."""
        if np.ndim(place) != 1:
            raise ValueError("cost is of one design; allowed: a vector. costs takes a row each")
        return float(self.costs(place)[0, 0])

    def fitness(self, place):
        return self.costs(place)[0]

    def batch_fitness(self, places):
        return self.costs(array("places", places).reshape(-1, len(self.names))).ravel()

    def has_batch_fitness(self):
        return True

    def get_nobj(self):
        return len(self.objectives)

    def get_bounds(self):
        low, high = zip(*self.bounds)
        return list(low), list(high)

    def get_name(self):
        return "leapmap design"


def _question(spec, goal, maximize, minimize, scatter, overrides):
    text, origin = (path("spec", spec), None) if spec is not None and not isinstance(spec, Mapping) else (_toml(spec or {}), "<dict>")
    changes = [f"{key}={_keyed(key, value)}" for key, value in overrides.items()]
    for section, keys in (("scatter", scatter), ("goal", goal)):
        changes += [f"{section}.{key}={_keyed(key, value)}" for key, value in mapping(section, keys).items()]
    for key, asked in (("maximize", maximize), ("minimize", minimize)):
        if found := names(key, asked):
            changes.append(f"goal.{key}={_keyed(key, found)}")
    return text, origin, changes
