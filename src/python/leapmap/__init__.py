# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap: when and how high does a passive hoop jump? Designs as numbers or numpy arrays, solved on all cores.

    import leapmap, numpy as np
    o = leapmap.solve(slope="23 deg", mass_ratio=np.geomspace(0.1, 20, 256)[:, None], offset_ratio=[0.8, 1.0])
    o.jump_height, o.status          # arrays of shape (256, 2)
    o.to_xarray()                    # an xarray.Dataset

`solve` and `trace` say which parameters there are and what they mean: help(leapmap.solve).
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
    _cores = ", ".join(os.path.basename(path) for path in glob.glob(os.path.join(glob.escape(_here), "_core.*"))) or "no compiled core"
    raise ImportError(f"{_here}: has {_cores}, and this is {sys.executable}, Python {sys.version.split()[0]}; allowed: the Python that it was "
                      "built for, as a rule /usr/bin/python3, or a build with cmake -DLEAPMAP_PYTHON=...") from None
from leapmap._design import DesignProblem, Found, design
from leapmap._fit import Fit, FittedParameter, fit
from leapmap._results import Motion, Outcomes, Status
from leapmap._scatter import Estimate, scatter
from leapmap._solve import gaits, gradient, solve, trace
from leapmap._sweep import load, sweep

__all__ = ["solve", "gradient", "trace", "gaits", "scatter", "design", "fit", "sweep", "load", "DesignProblem",
           "Found", "Fit", "FittedParameter", "Outcomes", "Motion", "Estimate", "Status", "phase_letters",
           "instruction_set", "instruction_sets", "use_instruction_set"]
__version__ = _core.program_version()


def phase_letters(sequence):
    """A phase_sequence as letters, for example "RSRSF": rolling, sliding, flight; "..." where there are 32 or more."""
    return _core.phase_letters(int(sequence))


def instruction_set():
    """The instruction set in use and how many designs it works on at once. The last bits of numbers depend on it."""
    return _core.instruction_set()


def instruction_sets():
    """Those that this build has and this machine can run, lowest first."""
    return _core.instruction_sets()


def use_instruction_set(name):
    """Uses that one from now on. Not while anything is being solved."""
    _core.use_instruction_set(name)
