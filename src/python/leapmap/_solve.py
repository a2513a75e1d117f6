# SPDX-License-Identifier: GPL-3.0-or-later
"""solve, gradient, trace and gaits. Their docstrings and signatures list the parameters and fields of
leapmap's own tables."""
import inspect
import os

import numpy as np

from leapmap import _core
from leapmap._arguments import count, names, real, text, whole
from leapmap._hoop import with_hoop
from leapmap._results import Motion, Outcomes


def solve(*, hoop=None, friction="sticking", jumps=1, settle=0, most_period=16, fields=None, method="auto",
          tolerance=1e-10, max_steps=1_000_000, threads=0, **parameters):
    """Solve designs: when, how high and how far each of them jumps.

    Arrays broadcast as numpy's do. Parameters that are not given are those of the paper's hoop. With
    ``motor_in_flight=False`` a motor idles while the hoop flies. With ``model="pendulum"`` a motor swings a
    pendulum on the hoop's axis, as ``motor_law`` says: "constant", "until_angle", "until_speed", "speed" or
    "angle".

    Parameters
    ----------
    {parameters}
    hoop : Hoop, optional
        A hoop as a drawing has it, instead of mass_ratio, offset_ratio, inertia_factor, radius and mass.
    friction : str, default "sticking"
        Contact model. "sticking": never slips, as in the paper; "coulomb": Coulomb friction.
    jumps : int, default 1
        Number of jumps to follow, 1 to 250; the fields of later ones are jump_height_2, jump_time_2 and so
        on.
    settle : int, default 0
        Transient: most jumps until a hoop settles on a gait; 0: no search.
    most_period : int, default 16
        Longest period of a gait to search for, in jumps.
    fields : sequence of str, optional
        Names of the fields to compute; default: all but max_normal_force and those of a motor, for which the
        way to a jump is solved once more.
    method : str, default "auto"
        "auto", "exact", or a stepper, for example "gsl-rk8pd".
    tolerance : float, default 1e-10
        Relative error allowed in times; of a stepper, per step.
    max_steps : int, default 1000000
        Of a stepper; a design that needs more gets status failed.
    threads : int, default 0
        Number of threads; 0: all cores. A forked process uses one.

    Returns
    -------
    Outcomes
        An array for each field, in the shape to which all parameters broadcast:

        {fields}

    Raises
    ------
    ValueError
        With parameter, value and what is allowed.

    Examples
    --------
    >>> o = leapmap.solve(slope="23 deg", mass_ratio=[1.0, 2.0, 3.0])
    >>> o.jump_height.round(3)
    array([0.362, 0.847, 1.121])
    """
    parameters = with_hoop(hoop, parameters)
    counts = (("jumps", jumps, 1, 1), ("settle", settle, 0, 0), ("most_period", most_period, 1, 16))
    parameters |= {
        name: number for name, value, least, usual in counts if (number := count(name, value, least)) != usual
    }
    columns = _core.solve(parameters, text("friction", friction), _names(fields), text("method", method),
                          real("tolerance", tolerance), whole("max_steps", max_steps, 1),
                          whole("threads", threads, 0, 4096))
    given = {
        name: np.array(value) if isinstance(value, np.ndarray) else value
        for name, value in parameters.items()
    }
    return Outcomes({name: column[()] for name, column in columns.items()}, given | {"friction": friction},
                    mass=None if hoop is None else hoop.total_mass)


def gradient(*, hoop=None, of="jump_height", friction="sticking", tolerance=1e-10, threads=0, **parameters):
    """Differentiate one quantity by every parameter of the designs, by dual numbers, to machine precision.

    Parameters
    ----------
    hoop : Hoop, optional
        As in solve; derivatives are by its own numbers then, in place of the three ratios: "hoop.mass",
        "hoop.slug.at", in kg, m, rad and kg m2, and by hoop.diameter too.
    of : str, default "jump_height"
        Name of the quantity.
    friction : str, default "sticking"
        Contact model, as in solve.
    tolerance : float, default 1e-10
        Relative error allowed in times.
    threads : int, default 0
        Number of threads; 0: all cores.
    {parameters}

    Returns
    -------
    dict
        For each parameter an array in the shape to which all parameters broadcast, in the quantity's unit
        over the parameter's (angles in rad). NaN: the quantity does not apply; the derivative is infinite, as
        on a fold, or known to fewer than six digits; or mu_kinetic follows mu_static.

    Raises
    ------
    ValueError
        With parameter, value and what is allowed.

    Examples
    --------
    >>> g = leapmap.gradient(slope=0.4, of="jump_height")
    >>> round(float(g["slope"]), 3)
    2.296
    """
    columns = _core.gradient(_whole_counts(with_hoop(hoop, parameters)), text("friction", friction),
                             text("of", of), real("tolerance", tolerance), whole("threads", threads, 0, 4096))
    by = {name: column[()] for name, column in columns.items()}
    if hoop is None:
        return by
    values = 0.0
    if _core.grows_with_size(of):
        values = getattr(
            solve(hoop=hoop, friction=friction, fields=[of], tolerance=tolerance, threads=threads,
                  **parameters), of)
    return hoop._differentiate(by, values, parameters)


def trace(*, hoop=None, interval=1e-3, friction="sticking", method="auto", tolerance=1e-10,
          max_steps=1_000_000, **parameters):
    """Solve one design and sample its motion over time.

    Parameters
    ----------
    hoop : Hoop, optional
        As in solve.
    interval : float, default 0.001
        Time between samples [s]; 0: phases and lift-offs only.
    friction : str, default "sticking"
        Contact model, as in solve.
    method : str, default "auto"
        As in solve.
    tolerance : float, default 1e-10
        As in solve.
    max_steps : int, default 1000000
        As in solve.
    {parameters}

    Returns
    -------
    Motion
        Samples, phases, lift-offs and outcome, in SI units.

    Raises
    ------
    ValueError
        With parameter, value and what is allowed.

    Examples
    --------
    >>> m = leapmap.trace(slope=0.4, interval=0.01)
    >>> [phase["phase"] for phase in m.phases]
    ['rolling', 'flight']
    """
    parameters = with_hoop(hoop, parameters)
    told = _core.trace(_whole_counts(parameters), text("friction", friction), real("interval", interval),
                       text("method", method), real("tolerance", tolerance), whole("max_steps", max_steps, 1))
    return Motion(told, parameters | {"friction": friction})


def gaits(*, hoop=None, most_period=1, tolerance=1e-10, **parameters):
    """Find the gaits of one hoop that never slips: periodic sequences of jumps, stable and unstable ones.

    Gaits whose lift-offs coincide with landings are searched from a grid of starting points; one may be
    missed.

    Parameters
    ----------
    hoop : Hoop, optional
        As in solve.
    most_period : int, default 1
        Longest period to search for, in jumps, 1 to 16.
    tolerance : float, default 1e-10
        Relative error allowed in times.
    {parameters}

    Returns
    -------
    dict
        gaits: a list of dicts with period, multiplier (stable if below 1 in size), height [hoop diameters],
        speed [m/s], energy_lost [(m + m_p) g R per jump], and jumps.

        jumps: arrays of angle, spin, height, time, distance over one period.

        returns: samples of the return map, arrays of angle, next, slope, height, uphill.

        is_whole: False if the map has more folds than were sampled, so that gaits may be missing.

    Raises
    ------
    ValueError
        With parameter, value and what is allowed.

    Examples
    --------
    >>> found = leapmap.gaits(slope="12 deg", mass_ratio=3, offset_ratio=0.5, runway=20)
    >>> [(gait["period"], round(gait["height"], 3)) for gait in found["gaits"] if abs(gait["multiplier"]) < 1]
    [(1, 0.17)]
    """
    for name in ("friction", "mu_static", "mu_kinetic", "restitution", "jumps", "settle"):
        if name in parameters:
            raise ValueError(f"{name}: has no effect here; allowed: solve(..., settle=500)")
    return _core.gaits(with_hoop(hoop, parameters), whole("most_period", most_period, 1, 16),
                       real("tolerance", tolerance))


def _names(fields):
    if fields is None:
        return []
    found = names("fields", fields)
    if not found:
        raise ValueError("fields = [] is empty; allowed: names of fields, or None for all")
    return found


def _whole_counts(parameters):
    counts = {"jumps": 1, "settle": 0, "most_period": 1}
    return {
        name: count(name, value, counts[name]) if name in counts else value
        for name, value in parameters.items()
    }


def _parameter_line(row):
    said = any(row[key] and row["meaning"].startswith(row[key]) for key in ("friction", "model"))
    only = "" if said else _only(row)
    kinds = "float, str or array_like" if row["array"] else "float or str"
    unit = f" [{row['unit']}]" if row["unit"] not in ("", "1") else ""
    meaning = row["meaning"][0].upper() + row["meaning"][1:]
    return (f"{row['name']} : {kinds}, default {_default(row)}\n"
            f"        {meaning}{unit}{only}; {row['allowed']}.")


def _only(row):
    names = [row[key] for key in ("model", "friction") if row[key]]
    return f"; {' with '.join(names)} only" if names else ""


def _default(row):
    return "mu_static" if np.isnan(row["default"]) else f"{row['default']:.6g}"


def _field_line(row):
    return f"* {row['name']} [{row['unit']}]: {row['meaning']}" + (
        _only(row)) + ("; " + ", ".join(f"{code} {name}"
                                for code, name in enumerate(row["codes"])) if row["codes"] else "")


def _document(function):
    rows = _core.parameters()
    lines = {
        "parameters": "\n    ".join(map(_parameter_line, rows)), "fields": "\n        ".join(
            map(_field_line, _core.fields()))
    }
    for name, text in lines.items():
        function.__doc__ = function.__doc__.replace("{" + name + "}", text)
    signature = inspect.signature(function)
    own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
    of_hoop = [
        inspect.Parameter(row["name"], inspect.Parameter.KEYWORD_ONLY, default=row["default"]) for row in rows
    ]
    function.__signature__ = signature.replace(parameters=of_hoop + own)


os.register_at_fork(after_in_child=_core.after_fork_in_child)
_document(solve)
_document(gradient)
_document(trace)
_document(gaits)
