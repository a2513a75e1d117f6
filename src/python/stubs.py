# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the type stubs of the package from leapmap's own tables: stubs.py FILE."""
import sys

import leapmap
from leapmap import _core, _results

NUMBERS = {"float64": "NDArray[np.float64]", "uint8": "NDArray[np.uint8]", "uint64": "NDArray[np.uint64]"}


def arguments(arrays):
    return "".join(f" {row['name']}: {'Numbers' if arrays and row['array'] else 'Number'} = ..., " for row in _core.parameters())


with open(sys.argv[1], "w", encoding="utf-8") as file:
    fields = "\n".join(f"    {row['name']}: {NUMBERS[row['type']]}" for row in _core.fields())
    statuses = "\n".join(f"    {status.name} = {status.value}" for status in leapmap.Status)
    points = "\n".join(f"    {name}: NDArray[np.{'uint8' if name == 'phase' else 'float64'}]" for name in _results._POINTS)
    file.write(f'''# Written by src/python/stubs.py from leapmap's tables of parameters and fields.
import os
from enum import IntEnum
from typing import Any, Callable, Mapping, NamedTuple, Optional, Sequence, Union
import numpy as np
import xarray
from numpy.typing import ArrayLike, NDArray

Number = Union[float, str]
Numbers = Union[ArrayLike, str]
Path = Union[str, "os.PathLike[str]"]
__version__: str

class Status(IntEnum):
{statuses}

class Outcomes:
{fields}
    def to_xarray(self) -> xarray.Dataset: ...

class Motion:
{points}
    outcome: Outcomes
    phases: list[dict[str, Any]]
    candidates: list[dict[str, float]]
    failure: Optional[str]
    def to_xarray(self) -> xarray.Dataset: ...

def solve(*,{arguments(True)}
          friction: str = ..., fields: Optional[Sequence[str]] = ..., method: str = ..., tolerance: float = ...,
          max_steps: int = ..., threads: int = ...) -> Outcomes: ...
def gradient(*,{arguments(True)}
             of: str = ..., friction: str = ..., tolerance: float = ..., threads: int = ...) -> dict[str, NDArray[np.float64]]: ...
def trace(*,{arguments(False)}
          interval: float = ..., friction: str = ..., method: str = ..., tolerance: float = ..., max_steps: int = ...) -> Motion: ...
class Estimate(NamedTuple):
    value: float
    error: float

def scatter(spec: Union[Path, Mapping[str, Mapping[str, Any]], None] = ..., *, scatter: Optional[Mapping[str, Any]] = ...,
            goal: Optional[Mapping[str, Any]] = ..., threads: int = ..., **overrides: Any) -> dict[str, Any]: ...
def sweep(spec: Union[Path, Mapping[str, Mapping[str, Any]]], file: Optional[Path] = ..., *, in_memory: bool = ...,
          resume: bool = ..., overwrite: bool = ..., threads: int = ...,
          progress: Optional[Callable[[int, int], Any]] = ..., **overrides: Any) -> xarray.Dataset: ...
def load(path: Path) -> xarray.Dataset: ...
def phase_letters(sequence: int) -> str: ...
def instruction_set() -> str: ...
def instruction_sets() -> list[str]: ...
def use_instruction_set(name: str) -> None: ...
''')
