# SPDX-License-Identifier: GPL-3.0-or-later
"""Sweeps of a spec, and the maps they write."""
import contextlib
import errno
import json
import math
import os
import re
import resource
import shutil
import signal
import tempfile
import threading
import warnings
from collections.abc import Mapping

import numpy as np

from leapmap import _analysis, _core
from leapmap._arguments import path, shown, whole
from leapmap._hoop import Hoop

try:
    from h5py._objects import phil as _hdf5  # HDF5 is one for the whole process: h5py's other threads wait
except ImportError:
    _hdf5 = threading.RLock()


def sweep(spec, file=None, *, in_memory=False, resume=False, overwrite=False, threads=0, progress=None,
          **overrides):
    """Solve the designs of a spec into a map, as `leapmap sweep` does.

    Parameters
    ----------
    spec : path or mapping
        A TOML file, or {section: {key: value}} in which an array is an axis.
    file : path, optional
        The map to write; default: output.file of the spec. Without one, as with in_memory.
    in_memory : bool, default False
        Leave no file; a temporary one is written to $TMPDIR.
    resume : bool, default False
        Continue what an interrupted sweep left, or read the map if it is complete.
    overwrite : bool, default False
        Replace an existing map.
    threads : int, default 0
        Number of threads; 0: all cores. A forked process uses one.
    progress : callable, optional
        Called with (designs done, number of designs), from a thread of its own. h5py is locked during a
        sweep.
    **overrides
        Keys of the spec, for example tolerance=1e-12.

    Returns
    -------
    xarray.Dataset
        The map.

    Raises
    ------
    ValueError
        With key, value and what is allowed.
    OSError
        If the file cannot be written, or if $TMPDIR has too little room for it.
    MemoryError
        If the map exceeds the memory.
    KeyboardInterrupt
        After Ctrl-C; FILE.part keeps what is done.

    Examples
    --------
    >>> ds = leapmap.sweep({"design": {"slope": np.linspace(0.1, 0.8, 50), "mass_ratio": [1, 2, 3]}})
    >>> dict(ds.sizes)
    {'slope': 50, 'mass_ratio': 3}
    """
    if spec is None:
        path("spec", spec)  # which refuses it
    text, origin, changes = question(spec, overrides)
    if in_memory and file is not None:
        raise ValueError(f"file = {file!r} has no effect with in_memory=True; allowed: one of the two")
    target = None if in_memory else os.fspath(file) if file is not None else _core.spec_file(
        text, origin, changes) or None
    if target is None and (resume or overwrite):
        raise ValueError("resume and overwrite have no effect in memory; allowed: with a file")
    threads = whole("threads", threads, 0, 4096)
    work = _Sweep(text, origin, changes, resume, overwrite, threads, progress)
    size = _core.sweep_bytes(text, origin, changes)
    _refuse_beyond_memory(size)
    if target is not None:
        return work.into(target, kept=True)
    free = shutil.disk_usage(tempfile.gettempdir()).free
    if size > free:
        raise OSError(
            errno.ENOSPC,
            f"a map of {size / 1e9:.3g} GB in a folder with {free / 1e9:.3g} GB free; allowed: fewer designs "
            "or fields, or "
            "file= on a disk with more room", tempfile.gettempdir())
    with _ends_by_signal(), tempfile.TemporaryDirectory(prefix="leapmap-") as folder:
        return work.into(os.path.join(folder, "map.h5"), kept=False)


def _refuse_beyond_memory(size):
    """A sweep returns its map in memory: one that does not fit is refused before it is solved."""
    free = math.inf
    try:
        with open("/proc/meminfo") as file:
            free = next(1024 * int(line.split()[1]) for line in file if line.startswith("MemAvailable"))
    except (OSError, StopIteration, ValueError, IndexError):
        pass  # not Linux: unknown
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    free = min(free, math.inf if limit == resource.RLIM_INFINITY else limit)
    if size > free:
        raise MemoryError(
            f"a map of {size / 1e9:.3g} GB exceeds {free / 1e9:.3g} GB of memory; allowed: fewer designs or "
            "fields, or the command "
            "leapmap sweep, which does not keep the map in memory")


class _Ended(BaseException):
    """A signal that would have ended the process at once."""


@contextlib.contextmanager
def _ends_by_signal():
    """SIGTERM and SIGHUP end the process as they would, but after what is inside has cleaned up."""
    caught = []

    def end(number, _):
        for each in mine:
            signal.signal(each, signal.SIG_IGN)  # what cleans up is not interrupted
        caught.append(number)
        raise _Ended

    mine = [
        number for number in (signal.SIGTERM, signal.SIGHUP) if
        threading.current_thread() is threading.main_thread() and signal.getsignal(number) is signal.SIG_DFL
    ]
    for number in mine:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number in mine:
            signal.signal(number, signal.SIG_DFL)
        if caught:
            os.kill(os.getpid(), caught[0])


class _Sweep:
    """One sweep, and the thread that reports its progress."""

    def __init__(self, text, origin, changes, resume, overwrite, threads, progress):
        self.spec, self.options, self.progress = (text, origin, changes), (resume, overwrite,
                                                                           threads), progress
        self.watch, self.finished, self.failure = _core.Watch(), threading.Event(), None

    def into(self, target, kept):
        teller = threading.Thread(target=self._tell, daemon=True)
        if self.progress:
            teller.start()
        try:
            with _hdf5:
                durable = _core.sweep(*self.spec, target, *self.options, self.watch)
        except KeyboardInterrupt:
            part = kept and os.path.exists(target + ".part")
            raise KeyboardInterrupt(f"stopped; {target}.part keeps what is done; resume=True continues it"
                                    if part else "stopped") from None
        finally:
            self.finished.set()
            if self.progress:
                teller.join()
        if self.failure is not None:
            raise self.failure
        if kept and not durable:
            warnings.warn(
                f"{target}: its folder could not be synced; a power failure may undo the map's renaming",
                stacklevel=3)
        return load(target)

    def _tell(self):
        told = None
        try:
            while True:
                last = self.finished.wait(0.05)
                now = (self.watch.done, self.watch.total)
                if now != told and now[1] > 0:
                    self.progress(*now)
                    told = now
                if last:
                    return
        except BaseException as error:  # raised where sweep was called
            self.failure = error
            self.watch.stop()


def load(path):
    """Read a map, or the .part of an unfinished one.

    Parameters
    ----------
    path : path
        A file that `leapmap sweep` wrote.

    Returns
    -------
    xarray.Dataset
        The map, in memory.

    Raises
    ------
    ValueError
        If the file is not a map.
    OSError
        If it cannot be read.
    """
    import xarray

    reader = _analysis.reader()
    try:
        m = reader.read_map(os.fspath(path))
    except reader.Unreadable as error:
        raise OSError(error.errno, str(error)) from None
    except reader.NotAMap as error:
        raise ValueError(str(error)) from None
    plain = ("units", "long_name", "flag_values", "flag_meanings")
    about = {
        name: {key: value for key, value in attributes.items() if key in plain}
        for name, attributes in m.about.items()
    }
    dims = tuple(m.dims)
    fields = {name: (dims, values, about[name]) for name, values in m.fields.items()}
    if m.labels is not None:
        fields = {"label": (dims, m.labels, about["label"])} | fields
    axes = {name: (name, values, about.get(name, {})) for name, values in m.dims.items()}
    return xarray.Dataset(fields, axes,
                          {key: value for key, value in m.attributes.items() if not key.startswith("_")})


def _text(text):
    """A text as TOML, whose escapes are JSON's; a delete it wants escaped too."""
    return json.dumps(os.fspath(text), ensure_ascii=False).replace("\x7f", "\\u007f")


def _key(key):
    return key if re.fullmatch("[A-Za-z0-9_-]+", str(key)) else _text(str(key))


def _value(value, in_table=False, depth=0):
    """A value as TOML; an array is an axis, but for one inside an axis."""
    if depth > 8:
        raise ValueError(
            "{...} holds dictionaries nine deep, or itself; allowed: a number, a text, or { from, to } and "
            "the like"
        )
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (str, os.PathLike)):
        return _text(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {_value(item, True, depth + 1)}"
                                for key, item in value.items()) + " }"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (list, tuple)) and value and all(isinstance(item, Mapping) for item in value):
        return "[" + ", ".join(_value(item, True, depth + 1) for item in value) + "]"
    if isinstance(value, (list, tuple)) and value and all(isinstance(item, str) for item in value):
        return "[" + ", ".join(map(_text, value)) + "]"
    if np.ma.is_masked(value):
        raise ValueError(f"{shown(value)} has masked values; allowed: numbers without a mask")
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        array = np.asarray(None)
    if array.dtype.kind not in "fiu" or array.ndim > 1:
        raise ValueError(
            f"{shown(value)} is not a value of a spec; allowed: a number, a text, or one list of numbers for "
            "an axis"
        )
    if array.ndim == 0:
        return repr(float(array))
    numbers = "[" + ", ".join(repr(float(number)) for number in array) + "]"
    return numbers if in_table else f"{{ values = {numbers} }}"


def question(spec, overrides):
    """A spec's text or path, its origin, None for a path, and KEY=VALUE of overrides; hoop may be a Hoop."""
    overrides = dict(overrides)
    hoop = overrides.get("hoop")
    if isinstance(hoop, Hoop):
        if spec is not None and (not isinstance(spec, Mapping) or "hoop" in spec):
            raise ValueError(
                f"hoop = {shown(hoop)} has no effect beside a file or [hoop]; allowed: one of the two")
        spec = {"hoop": overrides.pop("hoop")} | dict(spec or {})
    changes = [f"{key}={_keyed(key, value)}" for key, value in overrides.items()]
    if spec is None or isinstance(spec, Mapping):
        return _toml(spec or {}), "<dict>", changes
    return path("spec", spec), None, changes


def _keyed(key, value):
    try:
        return _value(value)
    except ValueError as error:
        raise ValueError(f"{key} = {error}") from None


def _toml(spec):
    lines = []
    for section, keys in spec.items():
        if isinstance(keys, Hoop):
            keys = keys.section()
        if not isinstance(keys, Mapping):
            raise ValueError(
                f"{section} = {keys!r} is not a section; allowed: {{section: {{key: value}}}}, as in a "
                "spec's TOML"
            )
        lines += [
            f"[{_key(section)}]", *(f"{_key(key)} = {_keyed(key, value)}" for key, value in keys.items())
        ]
    return "\n".join(lines) + "\n"
