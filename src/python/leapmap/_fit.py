# SPDX-License-Identifier: GPL-3.0-or-later
"""Identification from measurements: leapmap fit."""
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from leapmap import _core
from leapmap._arguments import array, mapping, names, path, real, shown, text, whole
from leapmap._design import _question

_CAMERA = ("time_offset", "angle_offset", "scale", "tilt")


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
        For every number measured, in the order of the times: the model's value, and model less measured, of a
        film in its own unit, of events over their errors.
    outliers : list of int
        With loss "huber": numbers whose residuals are larger than four standard deviations.
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
    outliers: list


def _event(name, value):
    is_pair = isinstance(value, (tuple, list, np.ndarray)) and len(value) == 2 and not any(
        isinstance(one, (str, tuple, list)) for one in value)
    if not is_pair:
        raise ValueError(
            f"{name} = {shown(value)} is not an event; allowed: (value, standard error), or a film with 't'")
    pair = array(name, value, 1)
    return float(pair[0]), float(pair[1])


def fit(data, spec=None, *, model="both", free=(), markers=None, error=None, scale=None, fps=None,
        loss="squares", allow_gaps=False, seed=1, threads=0, **overrides):
    """Identify release, friction and torque from a measured motion, by least squares.

    Parameters
    ----------
    data : path, sequence of paths, or mapping
        Files of one motion, as read_film reads; a CSV file with columns event, value, error; arrays
        {"t", "phi"} or {"t", "x_NAME", "y_NAME", ...} in s, rad and m; or events
        {field: (value, standard error)}. The angle phi is 0 if the mass touches the plane. x is downhill, y
        upwards.
    spec : path or mapping, optional
        The hoop, and free parameters {"from", "to"}. Without any these are release_angle, release_spin and,
        with friction, mu_static.
    model : str, default "both"
        "sticking", "coulomb" or "both".
    free : sequence of str
        What is free beside the spec's axes: parameters, and of the film time_offset, angle_offset, scale and
        tilt. Pixels free scale, a film with horizontal axes tilt, and one that shows the hoop held
        time_offset.
    markers : mapping, optional
        {track: distance from the axis [m]}, or {track: (distance, direction [rad])}; default: from the names
        of tracks and weights.
    error : float, optional
        Standard error of a film's angles [rad] or positions [m]; default: from the residuals.
    scale : float, optional
        Metres per unit of positions; default: from the size of the hoop.
    fps : float, optional
        Frames per second, for films with frame numbers instead of times.
    loss : str, default "squares"
        "squares", or "huber" for films with bad points.
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
        if fps is not None:
            raise ValueError("fps: has no effect with arrays, which have times; allowed: with files")
        data = {key: array(key, value, 1) for key, value in data.items()}
    elif isinstance(data, Mapping):
        camera = [name for name in names("free", free) if name in _CAMERA]
        refused = {
            "error": error is not None, "allow_gaps": allow_gaps, "scale": scale is not None,
            "fps": fps is not None, "markers": bool(markers), "free": bool(camera)
        }
        for name, given in refused.items():
            if given:
                raise ValueError(
                    f"{name}: has no effect with events, which have errors of their own; allowed: with a film"
                )
        data = {key: _event(key, value) for key, value in data.items()}
    else:
        data = _paths(data)
    if error is not None and not 0.0 < real("error", error) < float("inf"):
        raise ValueError(f"error = {shown(error)} is out of range; allowed: a standard error above 0")
    if text("loss", loss) not in ("squares", "huber"):
        raise ValueError(f"loss = {shown(loss)} is unknown; allowed: squares, huber")
    toml, origin, changes = _question(spec, None, (), (), None, overrides)
    told = _core.fit(data, toml, origin, changes, models,
                     _optional("error", error), bool(allow_gaps), whole("seed", seed, 0),
                     whole("threads", threads, 0, 4096), names("free", free), _markers(markers),
                     _optional("fps", fps), _optional("scale", scale), loss == "huber")
    return [
        Fit(**one | {"parameters": {name: FittedParameter(**of)
                                    for name, of in one["parameters"].items()}})
        for one in told
    ]


def read_film(data, *, fps=None):
    """Read the files of one motion.

    They are Tracker's projects and text, and those of DLTdv, DeepLabCut, Kinovea, encoders, or CSV.

    Parameters
    ----------
    data : path or sequence of paths
        One or several files.
    fps : float, optional
        Frames per second, for files with frame numbers instead of times.

    Returns
    -------
    dict
        tracks: {name: {"t" [s], "x", "y"}}; unit of positions, "" if it is not stated; or t [s], phi [rad]
        and spin [rad/s] of an encoder. notes: how each file's columns were read.

    Raises
    ------
    ValueError
        With file, line and what is allowed.

    Examples
    --------
    >>> leapmap.read_film("film.csv")["notes"]  # doctest: +SKIP
    ["film.csv: time in s; 'weight' x, y in mm from columns 2, 3, 240 points"]
    """
    return _core.read_film(_paths(data), _optional("fps", fps))


def _paths(data):
    return [path("data", one) for one in data] if isinstance(data, (list, tuple)) else [path("data", data)]


def _optional(name, value):
    if value is None:
        return float("nan")
    if not 0.0 < real(name, value) < float("inf"):
        raise ValueError(f"{name} = {shown(value)} is out of range; allowed: a number above 0")
    return float(value)


def _markers(markers):
    found = []
    for track, place in mapping("markers", markers).items():
        at, angle = place if isinstance(place, (tuple, list)) and len(place) == 2 else (place, 0.0)
        found.append((text("a name in markers", track), real("markers", at), real("markers", angle)))
    return found
