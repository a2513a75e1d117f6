# SPDX-License-Identifier: GPL-3.0-or-later
"""Identification from measurements: leapmap fit."""
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from leapmap import _core
from leapmap._arguments import array, path, real, shown, text, whole
from leapmap._design import _question


@dataclass(frozen=True)
class FittedParameter:
    """One fitted parameter.

    Attributes
    ----------
    value, error : float
        Best fit and its standard error, in the parameter's unit (angles in rad); error NaN: not identified.
    low, high : float
        Interval in which chi-square rises by less than 1, the other parameters refitted.
    identified : bool
        False: the data do not determine it.
    at_bound : bool
        Whether the value is at one of its bounds.
    """
    value: float
    error: float
    low: float
    high: float
    identified: bool
    at_bound: bool


@dataclass(frozen=True)
class Fit:
    """One fitted model.

    Attributes
    ----------
    friction : str
        Name of the model.
    found : bool
        False: no design within the bounds shows all that was measured; `why` gives the reason.
    explains, judged : bool
        Whether the model explains the data; judged False: too few lines to decide.
    parameters : dict
        {name: FittedParameter}.
    correlations : ndarray
        Correlation matrix, in their order.
    chi_square, degrees, probability : float, int, float
        Sum of squares of residuals over errors, degrees of freedom, and the probability of a larger sum if
        the model is true; NaN if errors are unknown.
    error, misfit : float
        Film: rms of the residuals, and its ratio to their scatter from line to line.
    correlation, independent : float
        Film: number of neighbouring lines that count as one, and the number of independent lines.
    after_landing : int
        Film: number of lines after the model's landing, which are not used.
    information : float
        Akaike's criterion; less is better.
    model, residuals : ndarray
        For every number measured, in the order of the data: the model's value, and the residual over its
        error.
    """
    friction: str
    found: bool
    why: str
    judged: bool
    explains: bool
    probability: float
    misfit: float
    after_landing: int
    parameters: dict
    correlations: np.ndarray
    chi_square: float
    degrees: int
    error: float
    information: float
    correlation: float
    independent: float
    model: np.ndarray
    residuals: np.ndarray


def _event(name, value):
    is_pair = isinstance(value, (tuple, list, np.ndarray)) and len(value) == 2 and not any(
        isinstance(one, (str, tuple, list)) for one in value)
    if not is_pair:
        raise ValueError(
            f"{name} = {shown(value)} is not an event; allowed: (value, standard error), or a film with 't'")
    pair = array(name, value, 1)
    return float(pair[0]), float(pair[1])


def fit(data, spec=None, *, model="both", error=None, allow_gaps=False, seed=1, threads=0, **overrides):
    """Identify release, friction and torque from a measured motion, by least squares.

    Parameters
    ----------
    data : path or mapping
        A CSV file; or arrays {"t", "phi"} or {"t", "x_P", "y_P", "x_O", "y_O"} in s, rad and m; or events
        {field: (value, standard error)}. The angle phi is 0 if the mass touches the plane. x is along the
        plane, downhill; y is away from it. P is the mass, O the hoop's centre. Convert pixels to metres
        first.
    spec : path or mapping, optional
        The hoop, and free parameters {"from", "to"}. Without any these are release_angle, release_spin and,
        with friction, mu_static.
    model : str, default "both"
        "sticking", "coulomb" or "both".
    error : float, optional
        Standard error of a film's angles [rad] or positions [m]; default: from the residuals.
    allow_gaps : bool, default False
        Accept films with missing lines.
    seed : int, default 1
        Seed of the initial sample.
    threads : int, default 0
        Number of threads; 0: all cores.
    **overrides
        Keys of the spec.

    Returns
    -------
    list of Fit
        The preferred model first.

    Raises
    ------
    ValueError
        With line, number and what is allowed.

    Examples
    --------
    >>> fits = leapmap.fit({"apex_time": (0.129, 0.001), "flight_time": (0.198, 0.001)}, model="sticking",
    ...                    release_angle={"from": "150 deg", "to": "270 deg"})
    >>> fits[0].friction, sorted(fits[0].parameters)
    ('sticking', ['release_angle'])
    """
    models = ["sticking", "coulomb"] if text("model", model) == "both" else [model]
    if isinstance(data, Mapping):
        for name in data:
            text("a name in data", name)
    if isinstance(data, Mapping) and "t" in data:
        data = {key: array(key, value, 1) for key, value in data.items()}
    elif isinstance(data, Mapping):
        for name, given in (("error", error is not None), ("allow_gaps", allow_gaps)):
            if given:
                raise ValueError(
                    f"{name}: has no effect with events, which have errors of their own; allowed: with a film"
                )
        data = {key: _event(key, value) for key, value in data.items()}
    else:
        data = path("data", data)
    if error is not None and not 0.0 < real("error", error) < float("inf"):
        raise ValueError(f"error = {shown(error)} is out of range; allowed: a standard error above 0")
    toml, origin, changes = _question(spec, None, (), (), None, overrides)
    told = _core.fit(data, toml, origin, changes, models,
                     float("nan") if error is None else float(error), bool(allow_gaps), whole(
                         "seed", seed, 0), whole("threads", threads, 0, 4096))
    return [
        Fit(**one | {"parameters": {name: FittedParameter(**of)
                                    for name, of in one["parameters"].items()}})
        for one in told
    ]
