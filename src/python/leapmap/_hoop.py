# SPDX-License-Identifier: GPL-3.0-or-later
"""Hoops as a drawing has them."""
import numpy as np

import leapmap._core as _core
from leapmap._arguments import array, shown, text

_RATIOS = ("mass_ratio", "offset_ratio", "inertia_factor")
_OWN = (*_RATIOS, "radius", "mass")


def _number(name, value, unit):
    """A number or an array, in the SI's unit; a text has a unit of its own."""
    if not isinstance(value, str):
        found = array(name, value)
        if not np.isfinite(found).all():
            raise ValueError(f"{name} = {shown(value)} is not finite; allowed: numbers in {unit}")
        return found
    try:
        return np.asarray(_core.quantity(value, unit))
    except (TypeError, ValueError) as error:
        error = error if isinstance(error, ValueError) else "a text that is no UTF-8"
        raise ValueError(f"{name} = {error}; allowed: a number in {unit}, or with a unit") from None


class Weight:
    """A mass that is fixed to a hoop.

    Parameters
    ----------
    mass : float, str or array_like
        In kg, or with a unit, for example "85 g".
    at : float, str or array_like
        Distance of its centre from the hoop's axis, in m; up to the radius.
    angle : float, str or array_like, default 0
        Direction of its centre, in rad. Only differences between weights matter: release_angle counts from
        the weights' common centre of mass.
    inertia : float, str or array_like, default 0
        Moment of inertia about its own centre, in kg m2.
    name : str, optional
        What derivatives and messages call it; default: its place among the weights, "weights[0]".

    Examples
    --------
    >>> slug = leapmap.Weight("85 g", at="47 mm")
    >>> float(slug.mass)
    0.085
    """

    def __init__(self, mass, at, angle=0.0, inertia=0.0, name=None):
        self.name = None if name is None else text("weight.name", name)
        self.mass = _number("weight.mass", mass, "kg")
        self.at = _number("weight.at", at, "m")
        self.angle = _number("weight.angle", angle, "rad")
        self.inertia = _number("weight.inertia", inertia, "kg m2")


class Hoop:
    """A ring with weights, for every function that takes a design or a spec.

    Numbers may be arrays, which broadcast; the diameter is one number.

    Parameters
    ----------
    diameter : float or str
        In m, or with a unit, for example "120 mm".
    mass : float, str or array_like
        Of the ring and everything on it except the weights, in kg.
    inertia : float, str or array_like, optional
        Moment of inertia of that ring about the axis, in kg m2; default: of a thin ring.
    weights : Weight or sequence of Weight
        Any number of them.

    Attributes
    ----------
    total_mass : ndarray
        In kg.
    eccentricity : ndarray
        Distance of the centre of mass from the axis, in radii.
    inertia_ratio : ndarray
        Moment of inertia about the axis, in total masses times the radius squared.
    parameters : dict
        What the hoop comes to, as solve takes it: mass_ratio, offset_ratio, inertia_factor, radius and, if it
        is one number, mass.

    Raises
    ------
    ValueError
        With key, value and what is allowed.

    Examples
    --------
    >>> slug = leapmap.Weight("85 g", at="47 mm")
    >>> battery = leapmap.Weight("12 g", at="30 mm", angle="180 deg")
    >>> hoop = leapmap.Hoop("120 mm", mass="61 g", inertia="1.9e-4 kg m2", weights=[slug, battery])
    >>> float(hoop.eccentricity.round(6))
    0.383439
    >>> o = leapmap.solve(hoop=hoop, slope="18 deg", friction="coulomb", mu_static=0.6)
    >>> float(o.to("mm").jump_height.round(2))
    10.34
    """

    def __repr__(self):
        return (f"<hoop of {self.total_mass[()]} kg, radius {self.parameters['radius']} m, "
                f"eccentricity {self.eccentricity[()]}, "
                f"inertia ratio {self.inertia_ratio[()]}>")

    def __init__(self, diameter, mass, inertia=None, weights=()):
        weights = [weights] if isinstance(weights, Weight) else list(weights)
        if not all(isinstance(weight, Weight) for weight in weights):
            raise ValueError(f"weights = {shown(weights)} are no weights; allowed: a list of leapmap.Weight")
        diameter = _number("diameter", diameter, "m")
        if diameter.ndim:
            raise ValueError(f"diameter = {shown(diameter)} is an array; allowed: one number")

        numbers = [v for w in weights for v in (w.mass, w.at, w.angle, w.inertia)]
        ring = (diameter, _number("mass", mass, "kg"),
                np.asarray(np.nan) if inertia is None else _number("inertia", inertia, "kg m2"))
        try:
            self._numbers = np.stack(np.broadcast_arrays(*ring, *numbers), axis=-1)
        except ValueError:
            raise ValueError("the arrays of a hoop do not broadcast; allowed: numpy's rules") from None
        self._names = [f"weights[{k}]" if w.name is None else w.name for k, w in enumerate(weights)]
        self._given = [w.name for w in weights]
        reduced = {
            name: values.reshape(self._numbers.shape[:-1])
            for name, values in _core.reduce_hoops(_rows(self._numbers), self._names).items()
        }
        self.total_mass, self.eccentricity, self.inertia_ratio = (
            reduced.pop(name) for name in ("total_mass", "eccentricity", "inertia_ratio"))
        one = {} if self.total_mass.ndim else {"mass": float(self.total_mass)}
        self.parameters = {name: values[()] for name, values in reduced.items()}
        self.parameters |= {"radius": float(diameter) / 2} | one

    def section(self):
        """The hoop as [hoop] of a spec, a mapping; weights without a name are weight1, weight2, ..."""
        if self._numbers.ndim > 1:
            raise ValueError("hoop holds arrays; allowed: numbers, and axes as hoop.NAME.mass of the spec")
        diameter, mass, inertia, *rest = map(float, self._numbers)
        keys = ("mass", "at", "angle", "inertia")
        weights = [{"name": name or f"weight{k + 1}"} | dict(zip(keys, rest[4 * k:4 * k + 4]))
                   for k, name in enumerate(self._given)]
        ring = {"diameter": diameter, "mass": mass} | ({} if np.isnan(inertia) else {"inertia": inertia})
        return ring | ({"weight": weights} if weights else {})

    def _differentiate(self, by, values, given):
        """Derivatives by the hoop's own numbers, in place of those by its ratios.

        values: the quantity itself, if it is a time or a speed; else 0.
        given: the parameters of the call; what of them has a unit of the SI is held there.
        """
        columns = [by.pop(name) for name in _RATIOS]
        by_mass, by_size = 0.0, 0.5 * values
        for name, (with_mass, with_size) in _held(given).items():
            by_logarithm = by[name] * self._in_own_units(name, given, with_mass)
            by_mass, by_size = by_mass + with_mass * by_logarithm, by_size + with_size * by_logarithm
        shape = np.shape(columns[0])
        numbers = np.broadcast_to(self._numbers, (*shape, self._numbers.shape[-1]))
        columns = np.stack(np.broadcast_arrays(*columns, by_mass, by_size), axis=-1)
        found = _core.differentiate_by_hoop(_rows(numbers), self._names, _rows(columns))
        return by | {name: column.reshape(shape)[()] for name, column in found.items()}

    def _in_own_units(self, name, given, with_mass):
        """A parameter given with a unit of the SI, in the units of each hoop: a power of the mass."""
        scales = {"radius": self.parameters["radius"]} | (
            {"gravity": given["gravity"]} if "gravity" in given else {})
        masses = np.asarray(self.total_mass)
        if masses.size == 0:
            return np.zeros(masses.shape)
        # The lightest hoop has the largest number, and the heaviest the smallest: one in range is not enough.
        light, _ = (_core.number(name, given[name], scales | {"mass": float(mass)})
                    for mass in (masses.min(), masses.max()))
        return light * (self.total_mass / masses.min())**with_mass


def _held(given):
    """The parameters given with a unit of the SI, and the powers of mass and size in their own units."""
    powers = {name: _powers(name, value) for name, value in given.items() if isinstance(value, str)}
    return {name: power for name, power in powers.items() if power is not None}


def _powers(name, value):
    try:
        return _core.powers_in_si(name, value)
    except (TypeError, ValueError):  # no number with a unit: refused where all parameters are read
        return None


def _rows(numbers):
    return numbers.reshape(-1, numbers.shape[-1])


def with_hoop(hoop, parameters):
    """The parameters of a call and of its hoop, if it has one."""
    if hoop is None:
        return parameters
    if not isinstance(hoop, Hoop):
        raise ValueError(f"hoop = {shown(hoop)} is no hoop; allowed: a leapmap.Hoop")
    for name in _OWN:
        if name in parameters:
            raise ValueError(
                f"{name} = {shown(parameters[name])} has no effect beside hoop; allowed: one of the two")
    held = {name: hoop._in_own_units(name, parameters, with_mass)
            for name, (with_mass, _) in _held(parameters).items()}
    return parameters | held | hoop.parameters
