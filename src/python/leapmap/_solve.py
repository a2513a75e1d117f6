# SPDX-License-Identifier: GPL-3.0-or-later
"""solve and trace, with what they take written into their docstrings and signatures from leapmap's own tables."""
import inspect
import os

import numpy as np

from leapmap import _core
from leapmap._arguments import count, names, real, text, whole
from leapmap._results import Motion, Outcomes


def solve(*, friction="sticking", jumps=1, settle=0, most_period=16, fields=None, method="auto", tolerance=1e-10, max_steps=1_000_000, threads=0,
          **parameters):
    """Solves designs: when and how high does each of them jump?

    Every parameter of a design is a number, an angle like "30 deg", or an array; arrays broadcast as numpy's do. Those of the
    scene are one number for the call. What is not given is the paper's hoop.
    {parameters}
    friction: "sticking", the contact never slips, or "coulomb".
    jumps: goes on after a landing until that many jumps, 1 to 250; their fields are jump_height_2, jump_time_2 and so on.
    settle: jumps before the gait that the hoop settles on is looked at, of up to most_period jumps; 0: none is looked for.
    fields: names of those wanted; what only others need is not computed. Default: all.
    method: "auto", "exact", or a stepper like "gsl-rk8pd"; tolerance: relative error of times, a stepper's per step.
    max_steps: of a stepper; a design that needs more has status failed. threads: 0 for all cores; one in a
    forked process.

    Returns Outcomes, arrays in the shape all parameters broadcast to:
    {fields}

    Raises ValueError, naming the parameter, its value and what is allowed. Ctrl-C ends it."""
    counts = (("jumps", jumps, 1, 1), ("settle", settle, 0, 0), ("most_period", most_period, 1, 16))
    parameters |= {name: number for name, value, least, usual in counts if (number := count(name, value, least)) != usual}
    columns = _core.solve(parameters, text("friction", friction), _names(fields), text("method", method), real("tolerance", tolerance),
                          whole("max_steps", max_steps, 1), whole("threads", threads, 0, 4096))
    given = {name: np.array(value) if isinstance(value, np.ndarray) else value for name, value in parameters.items()}
    return Outcomes({name: column[()] for name, column in columns.items()}, given | {"friction": friction})


def gradient(*, of="jump_height", friction="sticking", tolerance=1e-10, threads=0, **parameters):
    """The derivatives of a quantity by every parameter of the designs, to rounding: by dual numbers, not by differences.

    Parameters as in solve:
    {parameters}
    of: the quantity, a field that is a number: "jump_height", "jump_time", ...
    friction, threads: as in solve. tolerance: relative error of times.

    Returns a dict: for each parameter of the model's designs an array in the shape all parameters broadcast to, in the quantity's
    unit over the parameter's (angles in rad). NaN where the quantity does not apply, where the derivative is infinite, as on a
    fold, or not known to six digits, and by mu_kinetic where that follows mu_static.

    Raises ValueError, naming the parameter, its value and what is allowed. Ctrl-C ends it."""
    columns = _core.gradient(_whole_counts(parameters), text("friction", friction), text("of", of), real("tolerance", tolerance),
                             whole("threads", threads, 0, 4096))
    return {name: column[()] for name, column in columns.items()}


def trace(*, interval=1e-3, friction="sticking", method="auto", tolerance=1e-10, max_steps=1_000_000, **parameters):
    """One design's motion over time, sampled every interval [s]; 0: phases and lift-offs only.

    Parameters are numbers, or angles like "30 deg"; what is not given is the paper's hoop.
    {parameters}
    friction, method, tolerance, max_steps: as in solve.

    Returns a Motion. Raises ValueError, naming the parameter, its value and what is allowed."""
    told = _core.trace(_whole_counts(parameters), text("friction", friction), real("interval", interval), text("method", method),
                       real("tolerance", tolerance), whole("max_steps", max_steps, 1))
    return Motion(told, parameters | {"friction": friction})


def gaits(*, most_period=1, tolerance=1e-10, **parameters):
    """The gaits of one hoop that never slips: the periodic orbits of its map from lift-off to lift-off, stable or not. Those that
    jump again at each landing are searched from a grid of starts, so that one may be missed.

    Parameters
    ----------
    {parameters}
    most_period: longest gait looked for, in jumps, 1 to 16.
    tolerance: relative, of times.

    Returns a dict: gaits, each a dict of period, multiplier (stable where below 1 in size), height [hoop diameters], speed [m/s],
    energy_lost [(m + m_p) g R, a jump] and jumps, arrays of angle, spin, height, time and distance once round; and returns, arrays
    of angle, next, slope, height and uphill of the return map where it was looked at; and is_whole, False if the map has more folds
    than were looked at, so that gaits may be missing.
    """
    for name in ("friction", "mu_static", "mu_kinetic", "restitution", "jumps", "settle"):
        if name in parameters:
            raise ValueError(f"{name}: has no use here, where every gait of a hoop that never slips is looked for; allowed: solve(..., settle=500)")
    return _core.gaits(parameters, whole("most_period", most_period, 1, 16), real("tolerance", tolerance))


def _names(fields):
    if fields is None:
        return []
    found = names("fields", fields)
    if not found:
        raise ValueError("fields = [] names none; allowed: names of fields, or None for all")
    return found


def _whole_counts(parameters):
    counts = {"jumps": 1, "settle": 0, "most_period": 1}
    return {name: count(name, value, counts[name]) if name in counts else value for name, value in parameters.items()}


def _parameter_line(row):
    only = f"; {row['friction']} only" if row["friction"] and not row["meaning"].startswith(row["friction"]) else ""
    return f"{row['name']}: {row['meaning']}{only}. {row['allowed'][0].upper() + row['allowed'][1:]}; default {_default(row)}" + (
        "." if row["array"] else ", one for all designs.")


def _default(row):
    return "mu_static's" if np.isnan(row["default"]) else f"{row['default']:.6g}"


def _field_line(row):
    return f"{row['name']} [{row['unit']}]: {row['meaning']}" + (f"; {row['friction']} only" if row["friction"] else "") + (
        "; " + ", ".join(f"{code} {name}" for code, name in enumerate(row["codes"])) if row["codes"] else "")


def _document(function):
    rows = _core.parameters()
    lines = {"parameters": "\n    ".join(map(_parameter_line, rows)), "fields": "\n    ".join(map(_field_line, _core.fields()))}
    for name, text in lines.items():
        function.__doc__ = function.__doc__.replace("{" + name + "}", text)
    signature = inspect.signature(function)
    own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
    of_hoop = [inspect.Parameter(row["name"], inspect.Parameter.KEYWORD_ONLY, default=row["default"]) for row in rows]
    function.__signature__ = signature.replace(parameters=of_hoop + own)


os.register_at_fork(after_in_child=_core.after_fork_in_child)
_document(solve)
_document(gradient)
_document(trace)
_document(gaits)
