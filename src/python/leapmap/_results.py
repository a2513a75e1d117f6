# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of solve and trace."""
import re
from enum import IntEnum

import numpy as np

from leapmap import _core
from leapmap._arguments import text

_FIELDS = {row["name"]: row for row in _core.fields()}
_PARAMETERS = {row["name"]: row for row in _core.parameters()}
Status = IntEnum("Status", {name: code for code, name in enumerate(_FIELDS["status"]["codes"])})
Status.__doc__ = "How a design ended. Maps store these numbers, so they never change."
_PHASES = {1: "rolling", 2: "sliding", 3: "flight"}
_POINTS = {
    "t": ("s", "since release"), "phi": ("rad", "angle; 0: mass on the plane"), "spin": ("rad s-1",
                                                                                         "positive downhill"),
    "x": ("m", "travel of the hoop's centre along the plane since release"),
    "y": ("m", "height of the hoop's lowest point above the plane"),
    "normal_force": ("1",
                     "over the weight, 0 in flight; negative: the plane would have to hold the hoop down"),
    "friction": ("1", "over the weight, positive downhill"), "phase": ("1", "1 rolling, 2 sliding, 3 flight")
}
_OF_PENDULUM = {
    "pendulum_angle": ("rad", "0: it points at the plane"),
    "pendulum_spin": ("rad s-1", "not relative to the hoop"),
    "motor_torque": ("1", "on the pendulum, in (m + m_p) g R")
}


def _described(name):
    row = _FIELDS[name]
    about = {"long_name": row["meaning"], "units": row["unit"]}
    if row["codes"]:
        about |= {
            "flag_values": np.arange(len(row["codes"]), dtype=np.uint8),
            "flag_meanings": " ".join(row["codes"])
        }
    return about

_SCALES = ("radius", "gravity", "mass")  # what own units hang on


class Outcomes:
    """Outcomes of designs: one attribute for each field, an array or, for one design, a number.

    Quantities are float64, NaN if they do not apply; `status` and the other codes are uint8.

    Examples
    --------
    >>> o = leapmap.solve(slope=[0.2, 0.4])
    >>> [leapmap.Status(code).name for code in o.status]
    ['jumped', 'jumped']
    """

    def __init__(self, fields, given, original=None, units=None, mass=None):
        self.__dict__.update(fields)
        self.__dict__["_mass"] = mass  # of each design's hoop, if hoops were given
        self.__dict__["_fields"], self.__dict__["_given"] = fields, given
        # What it was converted from by `to`, and the units of those fields that were.
        self.__dict__["_original"], self.__dict__["_units"] = original or self, units or {}

    def __getattr__(self, name):
        if name.startswith("_"):  # while it is unpickled there is nothing yet
            raise AttributeError(name)
        if name in _FIELDS:
            for key, usual in (("model", "hoop"), ("friction", "sticking")):
                needs = _FIELDS[name][key]
                if needs and self._given.get(key, usual) not in (needs, "any"):
                    raise AttributeError(f"{name} was not computed: it needs {key}={needs!r}")
            raise AttributeError(f"{name} was not computed: name it in fields")
        raise AttributeError(f"outcomes have no {name!r}; they have {', '.join(self._fields)}")

    def __repr__(self):
        shape = np.shape(next(iter(self._fields.values())))
        if not shape:
            return "\n".join(
                ["one design:", *(f"  {name:20} {value!s}" for name, value in self._fields.items())])
        counts = ""
        if "status" in self._fields:
            codes, numbers = np.unique(self.status, return_counts=True)
            counts = ": " + ", ".join(f"{n} {Status(c).name}" for c, n in zip(codes, numbers))
        return (f"<outcomes of {' x '.join(map(str, shape))} designs{counts}; fields "
                f"{', '.join(self._fields)}>")

    def to(self, units):
        """Convert to other units.

        Parameters
        ----------
        units : str
            Names of units with spaces between them, for example "mm deg ms rpm N.s". Each field takes the
            first one that fits; the others keep their own.

        Returns
        -------
        Outcomes
            The same outcomes.

        Raises
        ------
        ValueError
            For an unknown unit, and for one that no field can be given in: newtons and joules need the
            parameter mass.

        Examples
        --------
        >>> o = leapmap.solve(slope=0.4, radius="60 mm")
        >>> round(float(o.to("mm").jump_height), 2)
        117.94
        """
        given = {name: self._given[name] for name in _SCALES if name in self._given}
        mass = self._mass if "mass" not in given else None
        wanted, fitting, chosen = text("units", units).split(), set(), {}
        fields = dict(self._original._fields)
        for name in fields:
            factors = {unit: self._factor(unit, name, given, mass) for unit in wanted}
            fits = [unit for unit in wanted if factors[unit] is not None]
            fitting |= set(fits)
            if fits:
                chosen[name] = fits[0]
                fields[name] = fields[name] * factors[fits[0]]
        for unit in wanted:
            if unit not in fitting:
                knows_mass = "mass" in given or mass is not None
                hint = "" if knows_mass else " (newtons and joules need the parameter mass)"
                raise ValueError(f"units: no field can be given in {unit}{hint}; allowed: units such as mm, "
                                 "deg, ms, rpm, N.s")
        return Outcomes(fields, self._given, self._original, chosen, self._mass)

    @staticmethod
    def _factor(unit, name, given, mass):
        """From the field's own unit; of designs with sizes or masses of their own an array."""
        given = given if mass is None else given | {"mass": mass}
        each = {key: value for key, value in given.items() if np.ndim(value) > 0}
        ones = given | dict.fromkeys(each, 1.0)
        factor = one = _core.units_in_own(unit, name, ones)
        if one is None:
            return None
        for key, values in each.items():  # own units are products of half powers of them
            fourfold = _core.units_in_own(unit, name, ones | {key: 4.0}) / one
            factor = factor * np.asarray(values, float)**(round(2 * np.log(fourfold) / np.log(4)) / 2)
        return factor

    def to_xarray(self):
        """Convert to an xarray.Dataset.

        A dimension along which only one parameter varies takes its name and values. Another one is called
        dim_0, dim_1, and so on, and the parameters along it are coordinates.

        Returns
        -------
        xarray.Dataset
            With units, long names and the meanings of codes.
        """
        import xarray

        shape = np.shape(next(iter(self._fields.values())))
        scales = {name: self._given[name] for name in _SCALES if name in self._given}
        given = {
            name: np.asarray(_core.number(name, value, scales) if isinstance(value, str) else value, float)
            for name, value in self._given.items() if name in _PARAMETERS
        }
        along = {
            name: tuple(d for d, n in enumerate(value.shape,
                                                len(shape) - value.ndim)
                        if n != 1) for name, value in given.items()
        }
        dims = [f"dim_{d}" for d in range(len(shape))]
        for d in range(len(shape)):
            varying = [name for name, axes in along.items() if d in axes]
            if len(varying) == 1 and along[varying[0]] == (d,):
                dims[d] = varying[0]
        coordinates = {}
        for name, value in given.items():
            if value.ndim:
                ones = tuple(d for d, n in enumerate(value.shape,
                                                     len(shape) - value.ndim) if d not in along[name])
                values = np.squeeze(value, tuple(d - (len(shape) - value.ndim) for d in ones))
                about = {"long_name": _PARAMETERS[name]["meaning"], "units": _PARAMETERS[name]["unit"]}
                coordinates[name] = ([dims[d] for d in along[name]], values, about)
        scalars = {name: value.item() for name, value in given.items() if value.ndim == 0
                   } | {"friction": self._given["friction"]}
        return xarray.Dataset(
            {name: (dims, values, self._about(name)) for name, values in self._fields.items()}, coordinates,
            scalars)

    def _about(self, name):
        about = _described(name)
        if name in self._units:
            about |= {"units": self._units[name], "long_name": re.sub(", in [^;]*", "", about["long_name"])}
        return about


class Motion:
    """The motion of one design.

    Attributes
    ----------
    t, phi, spin, x, y : ndarray
        Time since release [s], angle [rad], angular velocity [rad/s], travel of the centre along the plane
        and height of the lowest point [m]: one sample at every interval, and at the jump's lift-off and
        landing.
    normal_force, friction : ndarray
        Contact forces over the weight.
    phase : ndarray
        1 rolling, 2 sliding, 3 flight.
    pendulum_angle, pendulum_spin, motor_torque : ndarray
        Of a pendulum only: its angle [rad] and spin [rad/s], and the torque on it [(m + m_p) g R].
    phases : list of dict
        The beginning of each phase: phase, direction of sliding (1 forwards, -1 backwards, else 0), t [s],
        phi [rad], spin [rad/s], x [m].
    candidates : list of dict
        Every lift-off: t [s], phi [rad], spin [rad/s], height and dip [hoop diameters], apex_time and
        flight_time [s], is_jump.
    outcome : Outcomes
        As solve returns it.
    failure : str or None
        Reason of status failed.
    """

    def __init__(self, told, given):
        self.__dict__.update(told["points"])
        self.outcome = Outcomes({name: value[()] for name, value in told["outcome"].items()}, given)
        self.phases = [row | {"phase": _PHASES[row["phase"]]} for row in _rows(told["phases"])]
        self.candidates = _rows(told["candidates"])
        self.failure = told["failure"]

    def __repr__(self):
        return (
            f"<motion: {Status(self.outcome.status).name}; {len(self.t)} samples, {len(self.phases)} phases, "
            f"{len(self.candidates)} lift-offs>")

    def to_xarray(self):
        """Convert the samples to an xarray.Dataset along t.

        Returns
        -------
        xarray.Dataset
            With units and long names.
        """
        import xarray

        columns = {name: ("t", getattr(self, name), {"units": unit, "long_name": meaning})
                   for name, (unit, meaning) in (_POINTS | _OF_PENDULUM).items() if hasattr(self, name)}
        return xarray.Dataset({name: column for name, column in columns.items() if name != "t"},
                              {"t": columns["t"]})


def _rows(columns):
    return [dict(zip(columns, (value.item() for value in row))) for row in zip(*columns.values())]
