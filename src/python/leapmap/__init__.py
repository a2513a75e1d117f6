# SPDX-License-Identifier: GPL-3.0-or-later
"""Jumps of hoops with an off-centre mass: which designs jump, how high, how far, how soon.

Designs are numbers or numpy arrays, and are solved on all cores.

Examples
--------
>>> import leapmap, numpy as np
>>> o = leapmap.solve(slope="23 deg", mass_ratio=np.geomspace(0.1, 20, 256)[:, None], offset_ratio=[0.8, 1.0])
>>> o.jump_height.shape
(256, 2)
"""
try:
    import leapmap._core as _core
except ModuleNotFoundError as error:
    if error.name != "leapmap._core":
        raise
    import glob
    import os
    import sys

    _here = os.path.dirname(os.path.abspath(__file__))
    _cores = ", ".join(
        os.path.basename(path)
        for path in glob.glob(os.path.join(glob.escape(_here), "_core.*"))) or "no compiled core"
    raise ImportError(
        f"{_here}: has {_cores}, and this is {sys.executable}, Python {sys.version.split()[0]}; allowed: the "
        "Python that it was "
        "built for, usually /usr/bin/python3, or a build with cmake -DLEAPMAP_PYTHON=...") from None
from leapmap._design import DesignProblem, Found, design
from leapmap._fit import Fit, FittedParameter, fit, read_film
from leapmap._hoop import Hoop, Weight
from leapmap._results import Motion, Outcomes, Status
from leapmap._scatter import Estimate, scatter
from leapmap._solve import gaits, gradient, solve, trace
from leapmap._sweep import load, sweep

__all__ = [
    "solve", "gradient", "trace", "gaits", "scatter", "design", "fit", "read_film", "sweep", "load", "Hoop",
    "Weight",
    "DesignProblem", "Found", "Fit", "FittedParameter", "Outcomes", "Motion", "Estimate", "Status",
    "phase_letters", "instruction_set", "instruction_sets", "use_instruction_set"
]
__version__ = _core.program_version()


def phase_letters(sequence):
    """Convert a phase_sequence to letters.

    Parameters
    ----------
    sequence : int
        A phase_sequence as maps store it.

    Returns
    -------
    str
        R rolling, S sliding, F flight; "..." at the end: 32 phases or more.

    Examples
    --------
    >>> leapmap.phase_letters(0b111001)
    'RSF'
    """
    return _core.phase_letters(int(sequence))


def instruction_set():
    """Return the instruction set in use and its number of SIMD lanes. The last bits of results depend on it.

    Returns
    -------
    str
        For example "x86-64-v3, 4 lanes".
    """
    return _core.instruction_set()


def instruction_sets():
    """Return the instruction sets that were built in and that this machine supports, lowest first.

    Returns
    -------
    list of str
        For example ["x86-64", "x86-64-v3"].
    """
    return _core.instruction_sets()


def use_instruction_set(name):
    """Select an instruction set, so that different machines return equal bits.

    Call it before anything is solved.

    Parameters
    ----------
    name : str
        One of instruction_sets().

    Raises
    ------
    ValueError
        If it was not built in or the machine does not support it.
    """
    _core.use_instruction_set(name)
