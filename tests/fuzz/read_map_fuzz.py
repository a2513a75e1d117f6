#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random changes to a map, made through HDF5 or to its bytes: read_map reads it or refuses it with NotAMap,
whatever it is.

    LEAPMAP=... read_map_fuzz.py SECONDS [SEED]"""
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "analysis"))
from read_map import NotAMap, read_map  # noqa: E402

PROGRAM = os.environ.get("LEAPMAP", str(TOP / "build/release/leapmap"))
NAMES = ("slope", "mass_ratio", "jump_height", "status", "spurious_first_jump", "entry", "candidates", "new",
         "entry/data/new")
ATTRIBUTES = ("filetype", "version", "spec", "tiles_done", "title", "units", "flag_values", "flag_meanings",
              "_FillValue", "DIMENSION_LIST", "CLASS")
VALUES = (0, -1, 2**40, np.nan, 1e300, "text", b"bytes", np.zeros(3), np.zeros(
    (2, 2)), ["a", "b"], np.arange(7, dtype="u1"), "\x1b[2J", "$\\frac{$")


def change(file, pick, elsewhere):
    """One change; what HDF5 refuses is left."""
    name, other = pick.choice(NAMES), pick.choice(NAMES)
    kind = pick.randrange(9)
    if kind == 0:
        del file[name]
    elif kind == 1:
        file.move(name, pick.choice((other, "$\\frac{$", "a b", "\x07")))
    elif kind == 2:
        file[pick.choice(("/", name))].attrs[pick.choice(ATTRIBUTES)] = pick.choice(VALUES)
    elif kind == 3:
        del file[name]
        file[name] = pick.choice(VALUES)
    elif kind == 4:
        file[name] = h5py.ExternalLink(str(elsewhere), "/status")
    elif kind == 5:
        file[name] = h5py.SoftLink("/" + other)
    elif kind == 6:
        file[name] = file[other]
    elif kind == 7:
        file.create_dataset("more", (10**pick.randrange(12), ), dtype=pick.choice(
            ("f8", "u1", "S5", h5py.ref_dtype))).make_scale("more")
    else:
        del file[name].attrs[pick.choice(ATTRIBUTES)]


def main():
    seconds, seed = float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    pick = random.Random(seed)
    read = refused = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "spec.toml").write_text(
            "[design]\nslope = { values = [0.1, 0.2, 0.3] }\nmass_ratio = { values = [1, 2, 3, 4, 5] }\n")
        subprocess.run([PROGRAM, "sweep", folder / "spec.toml", "-o", folder / "map.h5", "--quiet"],
                       check=True)
        end = time.time() + seconds
        while time.time() < end:
            path = folder / "changed.h5"
            shutil.copy(folder / "map.h5", path)
            with h5py.File(path, "r+") as file:
                for _ in range(pick.randrange(1, 4)):
                    try:
                        change(file, pick, folder / "map.h5")
                    except (KeyError, OSError, RuntimeError, TypeError, ValueError):
                        pass
            try:
                read_map(path)
                read += 1
            except NotAMap as error:
                refused += 1
                assert "\n" not in str(error), error
    print(f"read_map: {read} maps read, {refused} refused")
    assert read > 0 and refused > 0


if __name__ == "__main__":
    main()
