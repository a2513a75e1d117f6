# SPDX-License-Identifier: GPL-3.0-or-later
"""One design as it is made, many times over."""
from typing import NamedTuple

from leapmap import _core
from leapmap._arguments import whole
from leapmap._design import _question
from leapmap._results import Outcomes


class Estimate(NamedTuple):
    """A number and its standard error; NaN: it cannot be told."""
    value: float
    error: float


def scatter(spec=None, *, scatter=None, goal=None, threads=0, **overrides):
    """Hoops made after one design: how likely they do what they must, how high they jump, and which tolerance matters.

        leapmap.scatter(slope=0.4, scatter={"slope": {"normal": "1 deg"}, "mass_ratio": {"uniform": "5 %"}},
                        goal={"jump_height": {"at_least": 0.8}})

    spec: a TOML file's path, or a dictionary {section: {key: value}}, with [scatter] and [goal]; default: the paper's hoop.
    scatter: {parameter: {"normal": standard deviation} or {"uniform": half width}}, a number in the parameter's unit, an angle
        like "1 deg", or "2 %" of its value; cut off where the parameter may not be. Also "samples" (1024), 16 times a whole
        number, and "seed" (1).
    goal: {field: {"at_least": ...}, {"at_most": ...}, both, or {"is": ...}}.
    threads: 0 for all cores. overrides: keys of the spec, slope=0.4 or friction="coulomb".

    Returns a dict; an Estimate has a value and its standard error, told by 16 replicates of Sobol' points:
    yield, jumps: shares that reach every goal, and that jump. missed: {field of a goal: share that misses it}.
    jump_height, jump_time, or those that fields= names: {"mean", "sd", "q05", "q50", "q95"} of those that jump.
    first, total: Sobol' indices, {"yield", "jumps", "jump_height" or "jump_time": {parameter: Estimate}}; NaN where nothing
        varies. Those of height and time are of the variance among pairs of hoops that both jump, pairs[...] of all.
    cut_off: {parameter: share of its law that no hoop can have}.
    unsolved: share that the method gave up on, of which nothing is known; errors tell it.
    shrink: {parameter: to what share of its width it has to shrink, the others staying, for 99 % yield}; 0: not even without
        it. without: {parameter: the yield if it did not scatter}. shrink_all: as shrink, of all together.
    made: {parameter: array}, outcomes: Outcomes, of the hoops made.

    Raises ValueError, naming the key, its value and what is allowed. Ctrl-C ends it."""
    text, origin, changes = _question(spec, goal, (), (), scatter, overrides)
    told = _core.scatter(text, origin, changes, whole("threads", threads, 0, 4096))
    outcomes = Outcomes(told.pop("outcomes"), {"friction": "any"})
    return _estimates(told) | {"outcomes": outcomes}


def _estimates(told):
    return {key: Estimate(*value) if isinstance(value, tuple) else _estimates(value) if isinstance(value, dict) else value
            for key, value in told.items()}
