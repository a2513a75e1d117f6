# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the type stubs of the package from leapmap's own tables: stubs.py FILE."""
import dataclasses
import sys

import numpy as np

import leapmap
from leapmap import _core, _results

NUMBERS = {"float64": "NDArray[np.float64]", "uint8": "NDArray[np.uint8]", "uint64": "NDArray[np.uint64]"}


def arguments(arrays):
    return "".join(f" {row['name']}: {'Numbers' if arrays and row['array'] else 'Number'} = ..., "
                   for row in _core.parameters())


def attributes(of):
    told = {np.ndarray: "NDArray[np.float64]", dict: "dict[str, Any]", list: "list[Any]"}
    return "\n".join(
        f"    {field.name}: {told.get(field.type, field.type.__name__)}" for field in dataclasses.fields(of))


with open(sys.argv[1], "w", encoding="utf-8") as file:
    fields = "\n".join(f"    {row['name']}: {NUMBERS[row['type']]}" for row in _core.fields())
    statuses = "\n".join(f"    {status.name} = {status.value}" for status in leapmap.Status)
    points = "\n".join(
        f"    {name}: NDArray[np.{'uint8' if name == 'phase' else 'float64'}]" for name in _results._POINTS)
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
Asked = Union[Path, Mapping[str, Mapping[str, Any]], None]
Names = Union[str, Sequence[str]]
__version__: str

class Status(IntEnum):
{statuses}

class Weight:
    def __init__(self, mass: Numbers, at: Numbers, angle: Numbers = ...,
                 inertia: Numbers = ...) -> None: ...

class Hoop:
    total_mass: NDArray[np.float64]
    eccentricity: NDArray[np.float64]
    inertia_ratio: NDArray[np.float64]
    parameters: dict[str, Any]
    def __init__(self, diameter: Number, mass: Numbers, inertia: Optional[Numbers] = ...,
                 weights: Sequence[Weight] = ...) -> None: ...

class Outcomes:
{fields}
    def to(self, units: str) -> "Outcomes": ...
    def to_xarray(self) -> xarray.Dataset: ...

class Motion:
{points}
    outcome: Outcomes
    phases: list[dict[str, Any]]
    candidates: list[dict[str, float]]
    failure: Optional[str]
    def to_xarray(self) -> xarray.Dataset: ...

def solve(*,{arguments(True)}
          hoop: Optional[Hoop] = ...,
          friction: str = ..., jumps: int = ..., settle: int = ..., most_period: int = ...,
          fields: Optional[Sequence[str]] = ..., method: str = ..., tolerance: float = ...,
          max_steps: int = ..., threads: int = ...) -> Outcomes: ...
def gradient(*,{arguments(True)}
             hoop: Optional[Hoop] = ...,
             of: str = ..., friction: str = ..., tolerance: float = ...,
             threads: int = ...) -> dict[str, NDArray[np.float64]]: ...
def trace(*,{arguments(False)}
          hoop: Optional[Hoop] = ...,
          interval: float = ..., friction: str = ..., method: str = ..., tolerance: float = ...,
          max_steps: int = ...) -> Motion: ...
def gaits(*,{arguments(False)}
          hoop: Optional[Hoop] = ...,
          most_period: int = ..., tolerance: float = ...) -> dict[str, Any]: ...
class Found:
{attributes(leapmap.Found)}
    def __len__(self) -> int: ...
def design(spec: Asked = ..., *, goal: Optional[Mapping[str, Any]] = ..., maximize: Names = ...,
           minimize: Names = ..., scatter: Optional[Mapping[str, Any]] = ..., seed: int = ...,
           most: int = ..., sample: int = ..., threads: int = ..., **overrides: Any) -> Found: ...
class DesignProblem:
    names: list[str]
    bounds: list[tuple[float, float]]
    objectives: list[str]
    fixed: dict[str, Any]
    def __init__(self, spec: Asked = ..., *, goal: Optional[Mapping[str, Any]] = ..., maximize: Names = ...,
                 minimize: Names = ..., scatter: Optional[Mapping[str, Any]] = ..., threads: int = ...,
                 **overrides: Any) -> None: ...
    @property
    def evaluations(self) -> int: ...
    def judge(self, places: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def costs(self, places: ArrayLike) -> NDArray[np.float64]: ...
    def cost(self, place: ArrayLike) -> float: ...
    def fitness(self, place: ArrayLike) -> NDArray[np.float64]: ...
    def batch_fitness(self, places: ArrayLike) -> NDArray[np.float64]: ...
    def has_batch_fitness(self) -> bool: ...
    def get_nobj(self) -> int: ...
    def get_bounds(self) -> tuple[list[float], list[float]]: ...
    def get_name(self) -> str: ...
class FittedParameter:
{attributes(leapmap.FittedParameter)}
class Fit:
{attributes(leapmap.Fit)}
def fit(data: Union[Path, Sequence[Path], Mapping[str, Any]], spec: Asked = ..., *, model: str = ...,
        free: Sequence[str] = ..., markers: Optional[Mapping[str, Any]] = ..., error: Optional[float] = ...,
        scale: Optional[float] = ..., fps: Optional[float] = ..., loss: str = ..., allow_gaps: bool = ...,
        seed: int = ..., threads: int = ..., **overrides: Any) -> list[Fit]: ...
def read_film(data: Union[Path, Sequence[Path]], *, fps: Optional[float] = ...) -> dict[str, Any]: ...
class Estimate(NamedTuple):
    value: float
    error: float

def scatter(spec: Asked = ..., *, scatter: Optional[Mapping[str, Any]] = ...,
            goal: Optional[Mapping[str, Any]] = ..., threads: int = ...,
            **overrides: Any) -> dict[str, Any]: ...
def sweep(spec: Union[Path, Mapping[str, Mapping[str, Any]]], file: Optional[Path] = ..., *,
          in_memory: bool = ..., resume: bool = ..., overwrite: bool = ..., threads: int = ...,
          progress: Optional[Callable[[int, int], Any]] = ..., **overrides: Any) -> xarray.Dataset: ...
def load(path: Path) -> xarray.Dataset: ...
def phase_letters(sequence: int) -> str: ...
def instruction_set() -> str: ...
def instruction_sets() -> list[str]: ...
def use_instruction_set(name: str) -> None: ...
''')
