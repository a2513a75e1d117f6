# SPDX-License-Identifier: GPL-3.0-or-later
"""One design as manufactured: yield, distribution of its outcomes, influence of each tolerance."""
from typing import NamedTuple

from leapmap import _core
from leapmap._arguments import whole
from leapmap._design import _question
from leapmap._results import Outcomes


class Estimate(NamedTuple):
    """A number with its standard error; NaN: not determined."""
    value: float
    error: float


def scatter(spec=None, *, scatter=None, goal=None, threads=0, **overrides):
    """Sample manufactured hoops around one design.

    Returns yield, distribution of the jumps, and the influence of each tolerance.

    Parameters
    ----------
    spec : path or mapping, optional
        A TOML file, or {section: {key: value}}, with [scatter] and [goal]; default: the paper's hoop.
    scatter : mapping, optional
        Tolerances, {parameter: {"normal": standard deviation} or {"uniform": half width}}: numbers in the
        parameter's unit, angles like "1 deg", or "2 %" of the value. Also "samples" (default 1024, a multiple
        of 16) and "seed".
    goal : mapping, optional
        {field: {"at_least": ...}, {"at_most": ...}, both, or {"is": ...}}.
    threads : int, default 0
        Number of threads; 0: all cores.
    **overrides
        Keys of the spec, for example slope=0.4 or friction="coulomb".

    Returns
    -------
    dict
        yield, jumps: fractions that reach every goal, and that jump (Estimate).
        missed: {field of a goal: fraction that misses it}.
        jump_height, jump_time, or the quantities in fields: {"mean", "sd", "q05", "q50", "q95"} of the hoops
        that jump.
        first, total: Sobol' indices, {quantity: {parameter: Estimate}}; NaN if nothing varies. Those of
        height and time describe the pairs of hoops in which both jump; pairs: {quantity: their fraction}.
        samples: number of hoops.
        cut_off: {parameter: fraction of its distribution outside its domain}.
        unsolved: fraction that the method could not solve; the errors include it.
        shrink: {parameter: factor by which its tolerance must shrink for a yield of 99 %, the others
        unchanged}; 0: even without it the yield is lower. shrink_all: the factor for all together.
        without: {parameter: yield if its tolerance were zero}.
        made: {parameter: array} and outcomes: Outcomes, of the manufactured hoops.

    Raises
    ------
    ValueError
        With key, value and what is allowed.

    Examples
    --------
    >>> tolerances = {"slope": {"normal": "1 deg"}, "mass_ratio": {"uniform": "5 %"}}
    >>> r = leapmap.scatter(slope=0.4, scatter=tolerances, goal={"jump_height": {"at_least": 0.95}})
    >>> round(r["yield"].value, 2)
    0.75
    """
    text, origin, changes = _question(spec, goal, (), (), scatter, overrides)
    told = _core.scatter(text, origin, changes, whole("threads", threads, 0, 4096))
    outcomes = Outcomes(told.pop("outcomes"), {"friction": "any"} | told.pop("scales"))
    return _estimates(told) | {"outcomes": outcomes}


def _estimates(told):
    return {
        key: Estimate(
            *value) if isinstance(value, tuple) else _estimates(value) if isinstance(value, dict) else value
        for key, value in told.items()
    }
