# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of arguments: a wrong type or value is a ValueError that names the parameter."""
import math
import numbers
import os
from collections.abc import Mapping

import numpy as np


def shown(value):
    """A value for a message, not longer than a line."""
    try:
        text = repr(value)
    except Exception:
        text = f"<{type(value).__name__}>"
    return text if len(text) <= 60 else text[:60] + "..."


def array(name, value, ndim=None):
    """An array of numbers as floats; masked arrays if nothing is masked. ndim: number of dimensions; None:
    any."""
    if np.ma.is_masked(value):
        raise ValueError(
            f"{name} = {shown(value)} has masked values; allowed: numbers without a mask"
        )
    try:
        found = np.asarray(value)
    except (TypeError, ValueError):
        found = np.asarray(None)
    if found.dtype.kind not in "fiu" or ndim is not None and found.ndim != ndim:
        allowed = {0: "a number", 1: "a list of numbers"}.get(ndim, "an array of numbers")
        raise ValueError(f"{name} = {shown(value)} is not a valid value; allowed: {allowed}")
    return np.asarray(found, float)


def real(name, value):
    """A number, NaN and infinity included."""
    return float(array(name, value, 0))


def whole(name, value, least, most=10**15):
    """A whole number in a range; 2.0 is one, True is none."""
    refused = ValueError(
        f"{name} = {shown(value)} is out of range; allowed: a whole number from {least} to {most}"
    )
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, numbers.Real):
        raise refused
    if not math.isfinite(value) or value != int(value) or not least <= value <= most:
        raise refused
    return int(value)


def count(name, value, least):
    """A number of things: an integer, not a float that equals one."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, numbers.Integral):
        raise ValueError(
            f"{name} = {shown(value)} is not a whole number; allowed: a whole number from {least}")
    return whole(name, value, least)


def text(name, value):
    if not isinstance(value, str):
        raise ValueError(f"{name} = {shown(value)} is not a text; allowed: a name")
    return value


def mapping(name, value):
    """A dictionary; None: an empty one."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise ValueError(f"{name} = {shown(value)} is not a dictionary; allowed: {{key: value}}")
    return value


def names(name, value):
    """One name or several, as a list."""
    if isinstance(value, str):
        return [value]
    try:
        found = list(value)
    except TypeError:
        found = [None]
    if not all(isinstance(one, str) for one in found):
        raise ValueError(f"{name} = {shown(value)} are not names; allowed: a name, or a list of names")
    return found


def path(name, value):
    """A file's path that is not empty."""
    found = os.fspath(value)
    if not found:
        raise ValueError(f"{name} = '' is empty; allowed: a file's name")
    return found
