# SPDX-License-Identifier: GPL-3.0-or-later
"""Sweeps of a spec, and the maps they write."""
import os
import tempfile

import numpy as np

from leapmap import _analysis, _core


def sweep(spec, file=None, *, in_memory=False, resume=False, overwrite=False, threads=0, progress=None, **overrides):
    """Solves the designs of a spec, as `leapmap sweep` does, and returns them as an xarray.Dataset.

    spec: a TOML file's path, or a dictionary {section: {key: value}} where an array is an axis:
        leapmap.sweep({"design": {"slope": np.linspace(0.1, 0.8, 50), "mass_ratio": [1, 2, 3]}})
    file: the map to write; default: the spec's output.file; without one, or in_memory=True, nothing is kept on disk.
    resume: go on with what a stopped sweep left, or take the map if it is whole. overwrite: replace an existing map.
    threads: 0 for all cores. progress: called with (designs done, designs in all), from any thread, now and then.
    overrides: keys of the spec, for example tolerance=1e-12.

    Raises ValueError for a spec that is not allowed, OSError for a file that cannot be written. Ctrl-C ends it, and MAP.part
    keeps what is done for resume."""
    text, origin = (_toml(spec), "spec") if isinstance(spec, dict) else (os.fspath(spec), None)
    changes = [f"{key}={_value(value)}" for key, value in overrides.items()]
    if in_memory and file is not None:
        raise ValueError(f"file = {file!r} has no use with in_memory=True; allowed: one of the two")
    target = None if in_memory else os.fspath(file) if file is not None else _core.spec_file(text, origin, changes) or None
    options = (resume, overwrite, threads, progress)
    if target is not None:
        return _swept(text, origin, changes, target, *options)
    with tempfile.TemporaryDirectory(prefix="leapmap-") as folder:
        return _swept(text, origin, changes, os.path.join(folder, "map.h5"), *options)


def _swept(text, origin, changes, target, resume, overwrite, threads, progress):
    from h5py._objects import phil  # HDF5 is one for the whole process: h5py's other threads wait

    try:
        with phil:
            _core.sweep(text, origin, changes, target, resume, overwrite, threads, progress)
    except KeyboardInterrupt:
        kept = f"; {target}.part keeps what is done; resume=True goes on" if os.path.exists(target + ".part") else ""
        raise KeyboardInterrupt("stopped" + kept) from None
    return load(target)


def load(path):
    """A map that `leapmap sweep` wrote, or the .part of one, as an xarray.Dataset in memory; raises ValueError for a file that
    is none."""
    import xarray

    reader = _analysis.module("read_map")
    try:
        m = reader.read_map(os.fspath(path))
    except reader.NotAMap as error:
        raise ValueError(str(error)) from None
    plain = ("units", "long_name", "flag_values", "flag_meanings")
    about = {name: {key: value for key, value in attributes.items() if key in plain} for name, attributes in m.about.items()}
    dims = tuple(m.dims)
    fields = {name: (dims, values, about[name]) for name, values in m.fields.items()}
    axes = {name: (name, values, about.get(name, {})) for name, values in m.dims.items()}
    return xarray.Dataset(fields, axes, {key: value for key, value in m.attributes.items() if not key.startswith("_")})


def _value(value):
    """A value as TOML; an array is an axis."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (str, os.PathLike)):
        text = os.fspath(value).replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{text}"'
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (list, tuple)) and all(isinstance(item, str) for item in value):
        return "[" + ", ".join(map(_value, value)) + "]"
    if np.ndim(value) == 1:
        return "{ values = [" + ", ".join(repr(float(number)) for number in value) + "] }"
    if np.ndim(value) == 0:
        return repr(float(value))
    raise ValueError(f"{value!r} has {np.ndim(value)} dimensions; allowed: a number, a text, or one list of numbers for an axis")


def _toml(spec):
    lines = []
    for section, keys in spec.items():
        if not isinstance(keys, dict):
            raise ValueError(f"{section} = {keys!r} is no section; allowed: {{section: {{key: value}}}}, as in a spec's TOML")
        lines += [f"[{section}]", *(f"{key} = {_value(value)}" for key, value in keys.items())]
    return "\n".join(lines) + "\n"
