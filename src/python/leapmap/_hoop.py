# SPDX-License-Identifier: GPL-3.0-or-later
"""Hoops as a drawing has them."""
import numpy as np

import leapmap._core as _core
from leapmap._arguments import array, shown

_OWN = ("mass_ratio", "offset_ratio", "inertia_factor", "radius", "mass")


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

    Examples
    --------
    >>> slug = leapmap.Weight("85 g", at="47 mm")
    >>> float(slug.mass)
    0.085
    """

    def __init__(self, mass, at, angle=0.0, inertia=0.0):
        self.mass = _number("weight.mass", mass, "kg")
        self.at = _number("weight.at", at, "m")
        self.angle = _number("weight.angle", angle, "rad")
        self.inertia = _number("weight.inertia", inertia, "kg m2")


class Hoop:
    """A ring with weights, for solve, gradient, trace and gaits; others take ``**hoop.parameters``.

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
        return (f"<hoop of {self.total_mass[()]} kg, eccentricity {self.eccentricity[()]}, "
                f"inertia ratio {self.inertia_ratio[()]}>")

    def __init__(self, diameter, mass, inertia=None, weights=()):
        weights = [weights] if isinstance(weights, Weight) else list(weights)
        if not all(isinstance(weight, Weight) for weight in weights):
            raise ValueError(f"weights = {shown(weights)} are no weights; allowed: a list of leapmap.Weight")
        diameter = _number("diameter", diameter, "m")
        if diameter.ndim:
            raise ValueError(f"diameter = {shown(diameter)} is an array; allowed: one number")

        def reduced(mass, inertia, *numbers):
            return _core.reduce_body(
                float(diameter), mass, inertia,
                [(f"weights[{k}]", *numbers[4 * k:4 * k + 4]) for k in range(len(weights))])

        numbers = [v for w in weights for v in (w.mass, w.at, w.angle, w.inertia)]
        ring = (_number("mass", mass, "kg"),
                np.asarray(np.nan) if inertia is None else _number("inertia", inertia, "kg m2"))
        try:
            np.broadcast_shapes(*(number.shape for number in (*ring, *numbers)))
        except ValueError:
            raise ValueError("the arrays of a hoop do not broadcast; allowed: numpy's rules") from None
        self.total_mass, self.eccentricity, self.inertia_ratio, *ratios = np.vectorize(
            reduced, otypes=[float] * 6)(*ring, *numbers)
        one = {} if self.total_mass.ndim else {"mass": float(self.total_mass)}
        self.parameters = dict(zip(_OWN, (v[()] for v in ratios))) | {"radius": float(diameter) / 2} | one


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
    return parameters | hoop.parameters
