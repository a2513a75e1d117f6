# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference tables as CSV lists through `leapmap sweep`, as a user would run them."""
import csv

import h5py
import numpy as np
import pytest
from support.program import REFERENCE, sweep

INPUTS = ["slope", "mass_ratio", "offset_ratio", "release_angle", "release_spin", "inertia_factor"]


@pytest.mark.parametrize("table", ["noslip_top_release", "noslip_general"])
def test_every_status_flag_and_count_is_equal_and_heights_and_times_are_within_1e_9(table, tmp_path):
    rows = list(csv.DictReader((REFERENCE / f"{table}.csv").open()))
    with (tmp_path / "designs.csv").open("w") as file:
        writer = csv.DictWriter(file, INPUTS, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    path = sweep(tmp_path, '[scene]\nradius = 1\ngravity = 1\n[design]\npoints = "designs.csv"\n',
                 "--set", "numerics.method=gsl-rk8pd", "--set", "tolerance=1e-12")
    with h5py.File(path) as m:
        meanings = m["status"].attrs["flag_meanings"].split()
        assert [meanings[s] for s in m["status"]] == [r["status"] for r in rows]
        assert list(m["spurious_first_jump"]) == [int(r["spurious"] or 255) for r in rows]
        assert list(m["candidates"]) == [int(r["candidates"] or 0) for r in rows]
        for name in INPUTS:
            assert list(m[name]) == [float(r[name]) for r in rows], "inputs are stored to the last bit"
        for name in ("jump_height", "jump_time"):
            expected = np.array([float(r[name] or "nan") for r in rows])
            scale = np.abs(expected) if name == "jump_time" else 1.0
            assert np.array_equal(np.isnan(m[name]), np.isnan(expected))
            assert np.nanmax(np.abs(m[name] - expected) / scale) < 1e-9  # the issue's own bound; measured 1e-12
