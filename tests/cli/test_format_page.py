# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/reference/file_format.md names every dataset and attribute of a map with its type and unit, and
nothing else."""
import json
import re

import h5py
import numpy as np
import pytest
from support.program import TOP, leapmap, sweep

PAGE = (TOP / "docs" / "reference" / "file_format.md").read_text()


def section(title):
    return PAGE.split(f"## {title}\n")[1].split("\n## ")[0]


def rows(title):
    """The table's rows as {name: cells}; a row may name several."""
    found = {}
    for line in section(title).splitlines():
        names = re.match(r"\| (`[^|]*`) \|", line)
        if names:
            for name in re.findall(r"`(\w+)`", names[1]):
                found[name] = [cell.strip() for cell in line.strip("|").split("|")]
    return found


@pytest.fixture(scope="module")
def maps(tmp_path_factory):
    folder = tmp_path_factory.mktemp("maps")
    (folder / "designs.csv").write_text("label,slope,mass_ratio\nsteep,0.4,2.44\nsteeper,0.5,1\n")
    axes = "".join(
        f"{k} = {{ values = [{v}] }}\n" for k, v in {
            "slope": "0.3, 0.4", "mass_ratio": "2, 3", "offset_ratio": "0.9, 1", "inertia_factor": "1",
            "release_angle": "3.1", "release_spin": "0, 0.1"
        }.items())
    grid = sweep(folder, f"[design]\n{axes}[numerics]\nmethod = \"gsl-rk8pd\"\nmax_steps = 60\naudit = 0\n",
                 name="grid.h5")
    retried = leapmap("sweep", folder / "spec.toml", "-o", grid, "--retry-failed")
    assert retried.returncode == 0, retried.stderr
    joined = folder / "joined.h5"
    assert leapmap("sweep", "-o", joined, "--shard", "1/1").returncode == 0
    assert leapmap("join", joined).returncode == 0
    linked = folder / "linked.h5"
    assert leapmap("sweep", "-o", linked, "--shard", "1/1").returncode == 0
    assert leapmap("join", linked, "--virtual").returncode == 0
    walled = "[scene]\nclear_height = 0.1\n[design]\nslope = { values = [0.3, 0.4] }\n"
    slipping = '[scene]\nfriction = "coulomb"\n[design]\npoints = "designs.csv"\n[numerics]\naudit = 1\n'
    named = [name for name, cells in rows("Fields").items() if cells[3].startswith("if named")]
    of_robot = [name for name, cells in rows("Fields").items() if cells[3].startswith("pendulum, if named")]
    driven = ('[scene]\nmodel = "pendulum"\n[design]\npoints = "designs.csv"\nmotor_torque = 1.0\n[output]\n'
              f"fields = {json.dumps(['status', *of_robot])}\n")
    return [
        grid, joined, linked,
        sweep(folder, '[design]\npoints = "designs.csv"\n[numerics]\naudit = 1\n', name="list.h5"),
        sweep(folder, slipping, name="slipping.h5"),
        sweep(folder, walled, name="walled.h5"),
        sweep(folder, driven, name="driven.h5"),
        sweep(
            folder,
            "[scene]\njumps = 2\nrunway = 20.0\n[design]\nslope = { values = [0.2, 0.3] }\n[gait]\nsettle = "
            "50\n"
            "[numerics]\naudit = 1\n", name="gaits.h5"),
        sweep(
            folder, "[scene]\njumps = 2\nrunway = 20.0\n[design]\nslope = { values = [0.2, 0.3] }\n"
            f"[output]\nfields = {json.dumps(['status', 'sequence_condition', *named])}\n", name="named.h5")
    ]


def kind(dtype):
    return {
        np.dtype("<f8"): "f8",
        np.dtype("<f4"): "f4",
        np.dtype("u1"): "u1",
        np.dtype("<i8"): "i8",
        np.dtype("<u8"): "u8",
        np.dtype("<i4"): "i4"
    }.get(dtype, "text")


def test_the_version_is_the_files(maps):
    with h5py.File(maps[0]) as m:
        major, minor = m.attrs["version"]
    assert f"version {major}.{minor}\n" in PAGE.splitlines()[0] + "\n"


def test_each_dataset_is_on_the_page_with_type_and_unit_and_the_page_names_no_other(maps):
    page = {
        **rows("Dimensions"),
        **{k: v for k, v in rows("Fields").items() if k not in ("long_name", "units", "_FillValue")}
    }
    later = {"jump_height_2": "1", "jump_time_2": "s"}  # the page tells them in words
    seen = set()
    for path in maps:
        with h5py.File(path) as m:
            for name, dataset in m.items():
                if not isinstance(dataset, h5py.Dataset):
                    continue
                if name in later:
                    assert dataset.attrs["units"] == later[name]
                    assert kind(dataset.dtype) == "f8"
                    continue
                cells = page[name]
                assert kind(dataset.dtype) in cells[1].split(", "), name
                assert dataset.attrs["units"] in cells[2:4], name
                seen.add(name)
    attributes = {"flag_values", "flag_meanings", "DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME"}
    assert set(page) - attributes == seen


def test_each_attribute_is_on_the_page_with_its_type_and_the_page_names_no_other(maps):
    page = rows("The root's attributes")
    seen = set()
    for path in maps:
        with h5py.File(path) as m:
            for name in m.attrs:
                dtype = h5py.h5a.open(m.id, name.encode()).dtype
                assert page[name][1].split(" ")[0].rstrip(",") == kind(dtype), name
                seen.add(name)
            for dataset in m.values():
                if isinstance(dataset, h5py.Dataset):
                    for name in dataset.attrs:
                        assert f"`{name}`" in section("Fields"), name
    assert set(page) == seen


def test_every_checksum_is_what_the_page_says(maps):
    import zlib
    with h5py.File(maps[1]) as m:
        crc = 0
        for name in [n for n in rows("Fields") if n in m]:
            mask, data = m[name].id.read_direct_chunk((0,))
            crc = zlib.crc32(np.uint32(mask).tobytes(), zlib.crc32(data, crc))
        assert crc == m.attrs["tiles_checksum"]
