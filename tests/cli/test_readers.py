# SPDX-License-Identifier: GPL-3.0-or-later
"""Other people's programs read our files: h5dump, h5ls, ncdump, h5py, xarray with both engines."""
import re
import subprocess

import h5py
import numpy as np
import pytest
import xarray
from support.program import SMALL, leapmap, sweep

FIELDS = {
    "jump_height": "<f8", "jump_time": "<f8", "spurious_first_jump": "u1", "status": "u1",
    "jump_angle": "<f8", "jump_spin": "<f8", "jump_distance": "<f8", "apex_time": "<f8", "flight_time": "<f8",
    "first_jump_height": "<f8", "first_jump_time": "<f8", "dip": "<f8", "candidates": "u1"
}


@pytest.fixture(scope="module")
def grid(tmp_path_factory):
    return sweep(tmp_path_factory.mktemp("grid"))


@pytest.fixture(scope="module")
def points(tmp_path_factory):
    folder = tmp_path_factory.mktemp("points")
    (folder / "designs.csv").write_text(
        'label,slope,mass_ratio\n"the paper\'s, or so",0.4,2.44\n"""light""",0.5,1\nflät,0.05,0.1\n')
    return sweep(folder, '[design]\npoints = "designs.csv"\n')


def printed(*command):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True).stdout


def test_each_dataset_is_as_the_interface_says(grid):
    with h5py.File(grid) as m:
        assert list(
            m["jump_height"].dims[i][0].name for i in range(3)) == ["/slope", "/mass_ratio", "/offset_ratio"]
        for name, dtype in FIELDS.items():
            dataset = m[name]
            assert dataset.dtype == np.dtype(dtype), name
            assert dataset.attrs["units"] and dataset.attrs["long_name"]
            fill = dataset.attrs["_FillValue"]
            assert fill.dtype == dataset.dtype and fill.shape == (1,)
            assert np.array_equal(dataset.fillvalue, fill[0], equal_nan=dtype == "<f8")
            assert dataset.chunks is not None
        status = m["status"].attrs
        assert status["flag_meanings"].split() == [
            "not_computed", "jumped", "no_jump", "stalled", "airborne_at_release", "indeterminate", "failed"
        ]
        assert list(status["flag_values"]) == list(range(7)) and status["flag_values"].dtype == np.uint8
        assert m["spurious_first_jump"].fillvalue == 255
        assert m["slope"].attrs["units"] == "rad"


def test_creation_order_is_tracked_so_that_axes_and_fields_come_in_ours(grid):
    listing = printed("h5dump", "-q", "creation_order", "-H", grid)
    assert re.findall(r'DATASET "(\w+)"', listing) == ["slope", "mass_ratio", "offset_ratio", *FIELDS]


def test_root_attributes_tell_where_the_map_comes_from(grid):
    with h5py.File(grid) as m:
        a = m.attrs
        assert a["filetype"] == "leapmap map" and a["Conventions"].startswith("CF-")
        assert list(a["version"]) == [1, 19]
        for name in ("title", "program_version", "git_revision", "spec", "date", "host", "method"):
            assert isinstance(a[name], str) and a[name], name
        assert a["method"] == "exact" and a["tolerance"] == 1e-10 and a["threads"] >= 1 and a["wall_time"] > 0
        assert a["audit_designs"] == 14 and a["audit_flag_mismatches"] == 0
        assert a["audit_undecided"] == 0 and a["audit_beyond_tolerance"] == 0
        assert 0 <= a["audit_max_abs_height_error"] < 1e-11 and 0 <= a["audit_max_rel_time_error"] < 1e-11
        assert a["audit_method"] != a["method"]


def test_f4_halves_the_numbers_and_every_reader_still_sees_the_holes(grid, tmp_path):
    single = sweep(tmp_path, SMALL, "--set", "precision=f4", "--set",
                   "fields=[\"jump_height\",\"spurious_first_jump\"]")
    with h5py.File(grid) as m, h5py.File(single) as s, xarray.open_dataset(single) as d:
        assert s["jump_height"].dtype == np.float32 and "jump_time" not in s
        assert np.array_equal(m["jump_height"][()].astype(np.float32), s["jump_height"][()], equal_nan=True)
        assert np.array_equal(m["spurious_first_jump"][()], s["spurious_first_jump"][()])
        assert np.array_equal(d.jump_height.values, s["jump_height"][()], equal_nan=True)
    assert "jump_height" in leapmap("info", single).stdout


@pytest.mark.parametrize("engine", ["netcdf4", "h5netcdf"])
def test_xarray_reads_grids_lists_and_traces(engine, grid, points, tmp_path):
    with h5py.File(grid) as m, xarray.open_dataset(grid, engine=engine) as d:
        assert dict(d.sizes) == {"slope": 12, "mass_ratio": 11, "offset_ratio": 2}
        assert d.jump_height.dims == ("slope", "mass_ratio", "offset_ratio")
        assert set(d.data_vars) == set(FIELDS)
        assert np.array_equal(d.jump_height.values, m["jump_height"][()], equal_nan=True)
        assert np.array_equal(d.slope.values, m["slope"][()])
        assert (d.status == 1).sum() == (m["status"][()] == 1).sum()
        assert np.isnan(d.spurious_first_jump.values).sum() == (m["spurious_first_jump"][()] == 255).sum()
        assert d.jump_time.attrs["units"] == "s"
        at = d.jump_height.sel(slope=0.4, mass_ratio=2.44, offset_ratio=1.0, method="nearest")
        assert 0.5 < at < 1.5
    with xarray.open_dataset(points, engine=engine) as d:
        assert dict(d.sizes) == {"design": 3}
        assert list(d.slope.values) == [0.4, 0.5, 0.05]
        assert d.jump_height.dims == ("design",)
        assert list(d.label.values) == ["the paper's, or so", '"light"', "flät"]
    for flags in ([], ["--slope", "1deg", "--mass-ratio", "0"]):  # with lift-offs and without any
        assert leapmap("hop", "--trace", tmp_path / f"{engine}.h5", *flags).returncode == 0
        with xarray.open_dataset(tmp_path / f"{engine}.h5", engine=engine) as d:
            assert d.phi.dims == ("t",) and d.candidate_time.dims == ("candidate",)
            assert d.sizes["candidate"] == (0 if flags else 2)


def test_stock_tools_read_it(grid, points):
    for path in (grid, points):
        assert "jump_height" in printed("h5dump", "-H", path)
        assert "jump_height" in printed("h5ls", "-r", path)
        header = printed("ncdump", "-h", path)
        assert "jump_height:_FillValue = NaN" in header and "status:flag_values = 0UB" in header
    values = printed("h5dump", "-d", "/slope", "-m", "%.17g", points)
    assert "0.40000000000000002" in values


@pytest.mark.parametrize("which", ["grid", "points"])
def test_nexus_viewers_are_led_to_the_plot(which, request):
    """NeXus's own rules for NXdata: https://manual.nexusformat.org/classes/base_classes/NXdata.html"""
    with h5py.File(request.getfixturevalue(which)) as m:
        group = m
        for nexus_class in ("NXroot", "NXentry"):
            assert group.attrs["NX_class"] == nexus_class
            group = group[group.attrs["default"]]
        assert group.attrs["NX_class"] == "NXdata" and group.attrs["signal"] == "jump_height"
        signal = group[group.attrs["signal"]]
        assert signal == m["jump_height"], "a link, not a copy"
        assert len(group.attrs["axes"]) == signal.ndim
        for i, axis in enumerate(group.attrs["axes"]):
            assert group[axis].shape == (signal.shape[i],)
        for name in group.attrs["auxiliary_signals"]:
            assert group[name].shape == signal.shape


# The clauses of CF-1.8 that a map of ours can break; Debian has no conformance checker, and no clause on
# geography, time since an epoch, cells or compression by gathering applies.
def test_conformance_to_cf(grid, points):
    names = re.compile(r"[A-Za-z][A-Za-z0-9_]*$")
    udunits = {"1", "s", "rad"}
    for path in (grid, points):
        with h5py.File(path) as h, xarray.open_dataset(path, decode_cf=False) as d:
            assert "CF-1.8" in d.attrs["Conventions"]  # 2.6.1
            assert d.attrs["title"]  # 2.6.2
            for name, v in d.variables.items():
                assert names.match(name)  # 2.3
                # 2.2
                is_number = v.dtype.kind in "fiu" and v.dtype.itemsize <= 8
                assert is_number or name == "label" and v.dtype.kind == "O"
                assert len(set(v.dims)) == len(v.dims)  # 2.4: no dimension twice
                assert v.attrs["units"] in udunits and v.attrs["long_name"]  # 3.1, 3.2
                assert "standard_name" not in v.attrs  # 3.3: there is none for what we tell
                # 2.5.1, 5: a coordinate variable is one-dimensional and has no missing values
                if name in d.sizes:
                    assert v.dims == (name,) and "_FillValue" not in v.attrs and np.isfinite(v.values).all()
                    assert len(np.unique(v.values)) == v.size
                    continue
                if "_FillValue" in v.attrs:
                    assert h[name].attrs["_FillValue"].dtype == v.dtype  # 2.5.1
                assert not {"valid_range", "valid_min", "valid_max"} & set(v.attrs)
                if "flag_values" in v.attrs:  # 3.5
                    assert h[name].attrs["flag_values"].dtype == v.dtype
                    meanings = v.attrs["flag_meanings"].split(" ")
                    assert len(meanings) == len(v.attrs["flag_values"]) == len(set(v.attrs["flag_values"]))
                    assert all(re.match(r"[A-Za-z0-9_.+@-]+$", meaning) for meaning in meanings)


def test_only_the_fields_asked_for_are_stored(tmp_path):
    path = sweep(tmp_path,
                 '[design]\nslope = { values = [0.3, 0.4] }\n[output]\nfields = ["status", "jump_height"]\n')
    with h5py.File(path) as m:
        assert set(m) == {"slope", "status", "jump_height", "entry"}
    assert leapmap("info", path).returncode == 0


def test_radius_and_gravity_scale_times_only(tmp_path):
    spec = '[design]\nslope = { values = [0.3, 0.4] }\n[scene]\nradius = {}\ngravity = {}\n'
    paper = sweep(tmp_path, spec.replace("{}", "0.041", 1).replace("{}", "9.81"), name="paper.h5")
    unit = sweep(tmp_path, spec.replace("{}", "1", 1).replace("{}", "1"), name="unit.h5")
    with h5py.File(paper) as p, h5py.File(unit) as u:
        second = (0.041 / 9.81) ** 0.5
        for name in FIELDS:
            scale = second if "time" in name else 1.0
            assert np.allclose(p[name][()], u[name][()] * scale, rtol=1e-15, atol=0), name
