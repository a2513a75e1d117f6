# SPDX-License-Identifier: GPL-3.0-or-later
"""From measurements to a hoop: what leapmap fit does."""
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from leapmap import _core
from leapmap._arguments import array, path, real, shown, text, whole
from leapmap._design import _question


@dataclass(frozen=True)
class FittedParameter:
    """value, and its standard error. identified: False: the data do not tell it, and the error is NaN. low, high: where chi-square stays
    within one of its least, the others refitted. at_bound: whether it is at the end of its range."""
    value: float
    error: float
    low: float
    high: float
    identified: bool
    at_bound: bool


@dataclass(frozen=True)
class Fit:
    """One model, fitted. friction: its name. found: False: no hoop of the box does anything like it, or why tells the reason.
    judged: False: a film of too few lines to say whether it explains them. explains: whether it explains the data: of events, or a film with a known error, probability is that of such a chi-square, or
    more, if the model is true; misfit: of a film, residuals over the scatter from line to line.
    correlation: of a film, lines that count as one, as neighbouring residuals are alike in smoothed films; errors allow for it.
    independent: lines of a film in such units.
    after_landing: lines of a film after the model's landing, where it is not followed.

    parameters: {name: FittedParameter}, correlations: array, in their order. chi_square over degrees of freedom. error: of a film the rms
    of its residuals. information: Akaike's; less is better. model, residuals: of every number measured, in the order of the data (of
    markers line by line), residuals over their errors."""
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
    is_pair = isinstance(value, (tuple, list, np.ndarray)) and len(value) == 2 and not any(isinstance(one, (str, tuple, list)) for one in value)
    if not is_pair:
        raise ValueError(f"{name} = {shown(value)} is no event; allowed: (value, standard error), or a film with 't'")
    pair = array(name, value, 1)
    return float(pair[0]), float(pair[1])


def fit(data, spec=None, *, model="both", error=None, allow_gaps=False, seed=1, threads=0, **overrides):
    """The release, friction and torque that explain a measured motion, by least squares. As `leapmap fit`.

        leapmap.fit("film.csv")
        leapmap.fit({"t": t, "phi": phi}, mass_ratio=3.0, error=2e-3)
        leapmap.fit({"apex_time": (0.129, 0.001), "flight_time": (0.198, 0.001), "jump_height": (1.0, 0.05)},
                    release_angle={"from": "150 deg", "to": "330 deg"})

    data: a CSV file's path, or {"t": ..., "phi": ...}, {"t", "x_P", "y_P", "x_O", "y_O"}: arrays, in s, rad and m; or
        {field: (value, standard error)} of events. phi: 0 where the mass touches the plane; x along the plane, downhill, y away from
        it; P is the mass, O the hoop's centre.
    spec: a TOML file's path or a dictionary: the hoop, and free parameters {"from", "to"}. Without one release_angle, release_spin
        and mu_static are free, whatever is given for them; with any only those.
    model: "sticking", "coulomb" or both. error: of a film's numbers; default: told by the residuals.
    seed: of the coarse map. threads: 0 for all cores. overrides: keys of the spec.

    Returns a list of Fit, the model that the data prefer first. Raises ValueError, naming line, number and what is allowed."""
    models = ["sticking", "coulomb"] if text("model", model) == "both" else [model]
    if isinstance(data, Mapping):
        for name in data:
            text("a name in data", name)
    if isinstance(data, Mapping) and "t" in data:
        data = {key: array(key, value, 1) for key, value in data.items()}
    elif isinstance(data, Mapping):
        for name, given in (("error", error is not None), ("allow_gaps", allow_gaps)):
            if given:
                raise ValueError(f"{name}: has no use with events, each of which has an error of its own; allowed: with a film")
        data = {key: _event(key, value) for key, value in data.items()}
    else:
        data = path("data", data)
    if error is not None and not 0.0 < real("error", error) < float("inf"):
        raise ValueError(f"error = {shown(error)} is out of range; allowed: a standard error above 0")
    toml, origin, changes = _question(spec, None, (), (), None, overrides)
    told = _core.fit(data, toml, origin, changes, models, float("nan") if error is None else float(error), bool(allow_gaps),
                     whole("seed", seed, 0), whole("threads", threads, 0, 4096))
    return [Fit(**one | {"parameters": {name: FittedParameter(**of) for name, of in one["parameters"].items()}}) for one in told]
