# SPDX-License-Identifier: GPL-3.0-or-later
"""Search for designs: leapmap design, and the same problem for other optimizers."""
from dataclasses import dataclass

import numpy as np

from leapmap import _core
from leapmap._arguments import array, mapping, names, whole
from leapmap._results import Outcomes
from leapmap._sweep import _keyed, question


@dataclass(frozen=True)
class Found:
    """Designs that a search found, best first; with two objectives the Pareto front, along the first.

    Attributes
    ----------
    reached : bool
        False: no design reaches every goal, and the only one is the nearest miss.
    parameters, objectives : dict of ndarray
        By name, one element for each design, in the parameter's or field's unit (angles in rad). Torques and
        spins given in N m or rpm beside a hoop that varies are in units of the nominal hoop, whose free
        numbers are at their lower bounds.
    outcomes : Outcomes
        Outcomes of the nominal designs.
    gradients : dict
        {field: {free parameter: ndarray}}, units of the field per unit of the parameter, of the fields that
        objectives and goals name; empty for a front.
    binds : list of list of str
        Active constraints of each design, in words.
    cliff_distance : ndarray
        Distance to the nearest discontinuity, as a fraction of the bounds.
    yield_ : ndarray
        With tolerances, the fraction of manufactured hoops that reach every goal; otherwise NaN.
    missed : dict
        {field of a goal: its value at the nearest miss}, in SI units for a goal that is given in them.
    hypervolume : float
        Fraction of the rectangle between a front's ends that it dominates; otherwise NaN.
    evaluations : int
        Number of designs solved.
    seconds : float
        Duration [s].
    """
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

    def __len__(self):
        return len(self.cliff_distance)


def design(spec=None, *, goal=None, maximize=(), minimize=(), scatter=None, seed=1, most=0, sample=0,
           threads=0, **overrides):
    """Find the designs within given bounds that reach given goals best, or a Pareto front of two objectives.

    Parameters
    ----------
    spec : path or mapping, optional
        A TOML file, or {section: {key: value}}; parameters with "from" and "to" are free.
    goal : mapping, optional
        {field: {"at_least": ...}, {"at_most": ...}, both, or {"is": ...}}.
    maximize, minimize : str or sequence of str
        One or two fields or free parameters in all.
    scatter : mapping, optional
        Tolerances, as in leapmap.scatter; then yield may be a goal or an objective.
    seed : int, default 1
        Equal seeds give equal designs.
    most : int, default 0
        Largest number of designs returned; 0: 8, or 2,048 for a front.
    sample : int, default 0
        Number of designs in the initial sample; 0: 2,097,152, with friction 262,144, and fewer with
        tolerances.
    threads : int, default 0
        Number of threads; 0: all cores.
    **overrides
        Keys of the spec.

    Returns
    -------
    Found
        Designs, best first.

    Raises
    ------
    ValueError
        With key, value and what is allowed.

    Examples
    --------
    >>> best = leapmap.design(slope={"from": "2 deg", "to": "20 deg"}, maximize="jump_height", sample=4096)
    >>> round(float(best.objectives["jump_height"][0]), 3)
    0.853
    """
    told = _core.design(*_question(spec, goal, maximize, minimize, scatter, overrides), whole(
        "seed", seed, 0), whole("most", most, 0, 10**5), whole("sample", sample, 0, 2**27),
                        whole("threads", threads, 0, 4096))
    outcomes = Outcomes(told.pop("outcomes"), {"friction": "any"} | told.pop("scales"))
    return Found(**told | {"outcomes": outcomes})


class DesignProblem:
    """The design problem of leapmap.design, for optimizers of scipy and pygmo.

    Decision vectors hold the free parameters, in their own units, in the order of `names`. Costs are the
    objectives, with the sign of those to maximize turned. A design that misses a goal costs at least 1e30,
    and more the farther it misses.

    Parameters
    ----------
    spec, goal, maximize, minimize, scatter, threads, **overrides
        As in leapmap.design.

    Attributes
    ----------
    names : list of str
        Free parameters.
    bounds : list of tuple
        Lower and upper bound of each, in the units of Found.parameters.
    objectives : list of str
        Objectives.
    fixed : dict
        The other parameters, as solve takes them.

    Examples
    --------
    >>> problem = leapmap.DesignProblem(slope={"from": 0.1, "to": 0.5}, maximize=["jump_height"])
    >>> round(problem.cost([0.4]), 3)
    -0.983
    """

    def __init__(self, spec=None, *, goal=None, maximize=(), minimize=(), scatter=None, threads=0,
                 **overrides):
        self._asked = (*_question(spec, goal, maximize, minimize, scatter, overrides),
                       whole("threads", threads, 0, 4096))
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
        """Number of designs evaluated so far."""
        return self._core.evaluations()

    def judge(self, places):
        """Evaluate designs.

        Parameters
        ----------
        places : array_like
            Shape (n, len(names)): a design in each row, angles in rad.

        Returns
        -------
        costs : ndarray
            Shape (n, len(objectives)), in the objectives' units.
        violations : ndarray
            Shape (n,); 0 if every goal is reached.

        Raises
        ------
        ValueError
            For another shape or a value outside the bounds.
        """
        rows = np.atleast_2d(array("places", places) if np.size(places) else np.empty((0, len(self.names))))
        return self._core.judge(rows)

    def costs(self, places):
        """Evaluate designs, shape (n, len(names)), and return their costs, shape (n, len(objectives))."""
        costs, violations = self.judge(places)
        return np.where(violations[:, None] > 0, 1e30 * (1 + violations[:, None]), costs)

    def cost(self, place):
        """Evaluate one design, shape (len(names),), and return the cost of the first objective."""
        if np.ndim(place) != 1:
            raise ValueError("cost takes one design; allowed: a vector, or costs for several designs")
        return float(self.costs(place)[0, 0])

    def fitness(self, place):
        """Costs of one design, shape (len(objectives),), for pygmo."""
        return self.costs(place)[0]

    def batch_fitness(self, places):
        """Costs of designs whose parameters follow each other in one vector; one vector, for pygmo."""
        return self.costs(array("places", places).reshape(-1, len(self.names))).ravel()

    def has_batch_fitness(self):
        """True, for pygmo."""
        return True

    def get_nobj(self):
        """Number of objectives, for pygmo."""
        return len(self.objectives)

    def get_bounds(self):
        """Lower and upper bounds, for pygmo."""
        low, high = zip(*self.bounds)
        return list(low), list(high)

    def get_name(self):
        """Name of the problem, for pygmo."""
        return "leapmap design"


def _question(spec, goal, maximize, minimize, scatter, overrides):
    text, origin, changes = question(spec, overrides)
    for section, keys in (("scatter", scatter), ("goal", goal)):
        changes += [f"{section}.{key}={_keyed(key, value)}" for key, value in mapping(section, keys).items()]
    for key, asked in (("maximize", maximize), ("minimize", minimize)):
        if found := names(key, asked):
            changes.append(f"goal.{key}={_keyed(key, found)}")
    return text, origin, changes
