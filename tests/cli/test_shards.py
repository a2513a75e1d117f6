# SPDX-License-Identifier: GPL-3.0-or-later
"""Shards: a map in parts for jobs of their own, and leapmap join."""
import os
import shutil
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest
from support.program import PROGRAM, SMALL, TOP, finished, leapmap, scripted, sweep

COULOMB = """
[scene]
friction = "coulomb"
restitution = 0.3
mu_static = { from = 0.05, to = 1.2, count = 12 }
[design]
slope = { from = "2 deg", to = "45 deg", count = 30 }
mass_ratio = { from = 0.2, to = 12, count = 20, scale = "log" }
[numerics]
audit = 0.01
"""


def shards(folder, spec, count, *arguments, which=None, name="map.h5"):
    """Sweeps shards of a spec's text, whose map's path is returned."""
    (folder / "shards.toml").write_text(spec)
    for i in which or range(1, count + 1):
        done = leapmap("sweep", folder / "shards.toml", "-o", folder / name, "--quiet", "--shard",
                       f"{i}/{count}", *arguments)
        assert done.returncode == 0, done.stderr
    return folder / name


def shard(map_path, i, count):
    return map_path.with_name(f"{map_path.stem}.{i}-of-{count}{map_path.suffix}")


def same_datasets(one, other):
    with h5py.File(one) as a, h5py.File(other) as b:
        names = [name for name in a if isinstance(a[name], h5py.Dataset)]
        assert names == [name for name in b if isinstance(b[name], h5py.Dataset)] and len(names) > 5
        for name in names:
            assert a[name].chunks == b[name].chunks and a[name].dtype == b[name].dtype, name
            if a[name].dtype.kind == "O":
                assert list(a[name][()]) == list(b[name][()]), name
            else:
                assert a[name][()].tobytes() == b[name][()].tobytes(), name
        ignored = {"date", "host", "threads", "wall_time", "shards"}
        for name in set(a.attrs) - ignored:
            assert np.array_equal(a.attrs[name], b.attrs[name]), name
        assert set(b.attrs) - set(a.attrs) == {"shards"}


@pytest.mark.parametrize(
    ("spec", "count"),
    [(SMALL, 3), (COULOMB, 5),
     (SMALL + '[output]\ngradients = ["jump_height"]\nprecision = "f4"\ncompression = 4\n', 2),
     (SMALL + "[scene]\njumps = 3\n", 4), (SMALL, 1)])
def test_the_map_of_all_shards_is_that_of_one_sweep_bit_for_bit(spec, count, tmp_path):
    joined = shards(tmp_path, spec, count)
    done = leapmap("join", joined)
    assert done.returncode == 0 and f"{count} shards" in done.stdout, done.stderr
    same_datasets(sweep(tmp_path, spec, name="one.h5"), joined)
    assert leapmap("check", joined).returncode == 0
    assert all(shard(joined, i, count).exists() for i in range(1, count + 1)), "the shards stay"


@pytest.mark.parametrize(("spec", "count"), [(COULOMB, 3),
                                             (SMALL + '[output]\nprecision = "f4"\ncompression = 4\n', 4),
                                             (SMALL + "[scene]\njumps = 3\n", 1)])
def test_a_virtual_map_looks_its_values_up_in_its_shards(spec, count, tmp_path):
    joined = shards(tmp_path, spec, count)
    done = leapmap("join", joined, "--virtual")
    assert done.returncode == 0 and "stay in the shards" in done.stdout, done.stderr
    one = sweep(tmp_path, spec, name="one.h5")
    with h5py.File(one) as a, h5py.File(joined) as b:
        for name in a:
            if isinstance(a[name], h5py.Dataset):
                assert np.array_equal(a[name][()], b[name][()], equal_nan=a[name].dtype.kind == "f"), name
        assert b["status"].is_virtual and a.attrs["tiles_checksum"] == b.attrs["tiles_checksum"]
        assert len(b.attrs["shard_checksums"]) == len(
            {source.file_name for source in b["status"].virtual_sources()})
    checked = leapmap("check", joined)
    assert checked.returncode == 0 and "check    " in checked.stdout, checked
    fields = lambda path: leapmap("info", path).stdout.split("dimensions")[1]
    assert fields(joined) == fields(one)
    assert leapmap("join", joined, "--overwrite").returncode == 0  # copied after all
    same_datasets(one, joined)


@pytest.mark.parametrize("harm", ["gone", "another", "flipped", "moved"])
def test_a_virtual_map_without_its_shards_tells_no_fill_values(harm, tmp_path):
    joined = shards(tmp_path, SMALL, 3)
    assert leapmap("join", joined, "--virtual").returncode == 0
    second = shard(joined, 2, 3)
    if harm == "gone":
        second.unlink()
    elif harm == "another":
        shards(tmp_path, SMALL.replace("0.1", "0.11", 1), 3, "--overwrite", which=[2])
    elif harm == "flipped":
        with second.open("r+b") as file:
            file.seek(second.stat().st_size // 2)
            byte = file.read(1)
            file.seek(-1, os.SEEK_CUR)
            file.write(bytes([byte[0] ^ 1]))
    else:
        joined = joined.rename(tmp_path.parent / f"{tmp_path.name}-map.h5")
    checked = leapmap("check", joined)
    assert checked.returncode == 1 and "WRONG" in checked.stdout, checked
    if harm != "flipped":  # what is read of it may be none of the flipped bytes
        told = leapmap("info", joined)
        assert told.returncode != 0 and "shard" in told.stderr, told
    joined.unlink()


def test_a_virtual_map_of_a_list_is_read_and_one_behind_a_link_too(tmp_path):
    (tmp_path / "list.csv").write_text("slope,mass_ratio\n" +
                                       "".join(f"{0.1 + 0.003 * i!r},{1 + 0.02 * i!r}\n" for i in range(200)))
    joined = shards(tmp_path, f"[design]\npoints = \"{tmp_path / 'list.csv'}\"\n", 2)
    assert leapmap("join", joined, "--virtual").returncode == 0
    (tmp_path / "links").mkdir()
    link = tmp_path / "links" / "l.h5"
    link.symlink_to(joined)
    for path in (joined, link):
        assert leapmap("info", path).returncode == 0 and leapmap("check", path).returncode == 0, path


def test_shards_of_equal_sums_are_told_apart(tmp_path):
    spec = ("[design]\nslope = { from = 0.5, to = 0.6, count = 256 }\n"
            "mass_ratio = { from = 5, to = 6, count = 256 }\n[output]\nfields = [\"status\"]\n[numerics]\n"
            "audit = 0\n")
    joined = shards(tmp_path, spec, 2)
    assert leapmap("join", joined, "--virtual").returncode == 0
    with h5py.File(joined) as m:
        first, second = m.attrs["shard_checksums"]
        assert first == second, "else there is nothing to tell apart"
    shutil.copy(shard(joined, 1, 2), shard(joined, 2, 2))
    told = leapmap("info", joined)
    assert told.returncode != 0 and "a different one" in told.stderr


def test_what_a_killed_virtual_join_left_is_in_nobodys_way(tmp_path):
    joined = shards(tmp_path, SMALL, 2)
    assert leapmap("join", joined, "--virtual").returncode == 0
    with h5py.File(joined, "r+") as part:  # as it is before its end
        del part.attrs["shard_checksums"]
    joined.rename(joined.with_name("map.h5.part"))
    assert leapmap("join", joined, "--virtual").returncode == 0
    assert leapmap("info", joined).returncode == 0


def test_a_virtual_map_is_not_changed_and_not_drawn(tmp_path):
    joined = shards(tmp_path, SMALL, 2)
    assert leapmap("join", joined, "--virtual").returncode == 0
    before = [path.read_bytes() for path in sorted(tmp_path.glob("*.h5"))]
    retried = leapmap("sweep", tmp_path / "shards.toml", "-o", joined, "--retry-failed")
    assert retried.returncode != 0 and "--virtual" in retried.stderr, retried
    drawn = scripted("status_chart.py", joined, "-o", tmp_path / "x.png")
    assert drawn.returncode != 0 and "--virtual" in drawn.stderr, drawn
    assert [path.read_bytes() for path in sorted(tmp_path.glob("*.h5"))] == before


def test_a_list_has_shards_too(tmp_path):
    (tmp_path /
     "list.csv").write_text("label,slope,mass_ratio\n" +
                            "".join(f"hoop {i},{0.1 + 0.003 * i!r},{1 + 0.02 * i!r}\n" for i in range(200)))
    spec = f"[design]\npoints = \"{tmp_path / 'list.csv'}\"\n"
    joined = shards(tmp_path, spec, 2)
    assert leapmap("join", joined).returncode == 0
    same_datasets(sweep(tmp_path, spec, name="one.h5"), joined)


def test_shards_hold_every_tile_once_and_as_much_work_as_the_others(tmp_path):
    count = 6
    joined = shards(tmp_path, COULOMB, count, "--set", "audit=0")
    designs = []
    for i in range(1, count + 1):
        with h5py.File(shard(joined, i, count)) as file:
            assert file.attrs["filetype"] == "leapmap shard" and file.attrs["shard"] == f"{i}/{count}"
            designs.append(
                int((file["status"][()] != 255
                     ).sum()) if file["status"].fillvalue == 255 else int(sum(file.attrs["status_counts"])))
    assert sum(designs) == 12 * 30 * 20 and min(designs) > 0.2 * sum(designs) / count
    planned = leapmap("sweep", tmp_path / "shards.toml", "-o", joined, "--dry-run", "--shards", count,
                      "--time-limit", 1).stdout
    ratio = float(planned.split(" times the mean")[0].split()[-1])
    assert 1.0 <= ratio <= 1.25 and "limit" in planned and f"--shard 1/{count}" in planned


def test_a_shard_is_no_map_to_anything_else(tmp_path):
    joined = shards(tmp_path, SMALL, 2, which=[1])
    for command in (("info",), ("boundaries",)):
        done = leapmap(*command, shard(joined, 1, 2))
        assert done.returncode == 2 and "shard 1/2" in done.stderr and "join" in done.stderr, command
    checked = leapmap("check", shard(joined, 1, 2))
    assert checked.returncode == 0 and "all intact" in checked.stdout, checked


def test_a_shard_that_was_killed_is_gone_on_with(tmp_path):
    spec = COULOMB.replace("count = 30", "count = 300").replace("count = 20", "count = 30").replace(
        "audit = 0.01", "audit = 0.02")
    (tmp_path / "shards.toml").write_text(spec)
    command = [
        PROGRAM, "sweep", tmp_path / "shards.toml", "-o", tmp_path / "map.h5", "--quiet", "--threads", "1",
        "--commit-interval", "0"
    ]
    for i, sign in ((1, signal.SIGKILL), (2, signal.SIGTERM)):
        part = tmp_path / f"map.{i}-of-3.h5.part"
        process = subprocess.Popen([str(word) for word in [*command, "--shard", f"{i}/3"]],
                                   stderr=subprocess.PIPE, text=True)
        end = time.monotonic() + 60
        while time.monotonic() < end and not (part.exists() and part.stat().st_size > 200_000):
            time.sleep(0.02)
        process.send_signal(sign)
        said = process.communicate(timeout=60)[1]
        assert process.returncode == (-9 if sign == signal.SIGKILL else 143) and part.exists()
        if sign == signal.SIGTERM:
            assert f"--shard {i}/3" in said and "--resume" in said
    missing = leapmap("join", tmp_path / "map.h5")
    assert missing.returncode == 2 and "--array=1-3" in missing.stderr
    assert "2 of them unfinished" in missing.stderr
    joined = shards(tmp_path, spec, 3, "--resume")
    assert leapmap("join", joined).returncode == 0
    same_datasets(sweep(tmp_path, spec, name="one.h5"), joined)


def refused(map_path, *words, status=2):
    """leapmap join says what is wrong in one line, and leaves nothing."""
    done = leapmap("join", map_path)
    assert done.returncode == status and len(done.stderr.splitlines()) == 1, done
    for word in words:
        assert word in done.stderr
    assert not map_path.exists() and not map_path.with_name(map_path.name + ".part").exists()


def test_what_is_missing_is_named_as_an_array_of_slurm(tmp_path):
    joined = shards(tmp_path, SMALL, 8, which=[2, 5, 8])
    refused(joined, "5 of its 8 shards", "--array=1,3-4,6-7")
    refused(tmp_path / "other.h5", "no shard")


@pytest.mark.parametrize("harm", [
    "torn", "flipped", "renamed", "doubled", "foreign spec", "foreign program", "foreign library", "two sets",
    "whole map", "unreadable"
])
def test_a_shard_that_cannot_be_right_is_named_and_nothing_is_written(harm, tmp_path):
    joined = shards(tmp_path, SMALL, 3)
    path = shard(joined, 2, 3)
    if harm == "torn":
        os.truncate(path, path.stat().st_size // 2)
        refused(joined, path.name, status=3)
    elif harm == "flipped":
        with h5py.File(path) as file:
            dataset = file["jump_height"]
            at = next(dataset.id.get_chunk_info(k) for k in range(dataset.id.get_num_chunks())).byte_offset
        raw = bytearray(path.read_bytes())
        raw[at + 40] ^= 1
        path.write_bytes(raw)
        refused(joined, path.name, status=3)
    elif harm == "renamed":
        path.rename(tmp_path / "kept")
        shard(joined, 1, 3).rename(path)
        (tmp_path / "kept").rename(shard(joined, 1, 3))
        refused(joined, "is shard 2/3", "despite its name")
    elif harm == "doubled":
        shutil.copy(shard(joined, 1, 3), path)
        refused(joined, path.name, "is shard 1/3")
    elif harm == "foreign spec":
        path.unlink()
        shards(tmp_path, SMALL.replace("0.6, 1.0", "0.6, 0.9"), 3, which=[2])
        refused(joined, path.name, "another spec", "offset_ratio")
    elif harm == "foreign program":
        with h5py.File(path, "r+") as file:
            file.attrs["instruction_set"] = "pdp11"
        refused(joined, path.name, "pdp11", "--instruction-set")
    elif harm == "foreign library":
        with h5py.File(path, "r+") as file:
            assert file.attrs["math_library"].startswith("glibc 2.")
            file.attrs["math_library"] = "glibc 1.0"
        refused(joined, path.name, "glibc 1.0", "C library")
    elif harm == "two sets":
        shards(tmp_path, SMALL, 2)
        refused(joined, "of 2 and of 3", "--shards")
        assert leapmap("join", joined, "--shards", 3).returncode == 0
    elif harm == "whole map":
        path.unlink()
        sweep(tmp_path, SMALL, name=path.name)
        refused(joined, path.name, "not a shard")
    elif harm == "unreadable":
        path.write_text("no HDF5 at all")
        refused(joined, path.name, status=3)


def test_all_that_is_wrong_is_told_at_once_and_mended_by_removing_what_is_broken(tmp_path):
    joined = shards(tmp_path, SMALL, 5, which=[1, 2, 3, 5])
    broken = [shard(joined, i, 5) for i in (2, 3)]
    for path in broken:
        os.truncate(path, path.stat().st_size // 2)
    refused(joined, "1 of its 5 shards is missing", broken[0].name, broken[1].name, "--array=2-4", status=3)
    for path in broken:
        path.unlink()
    shards(tmp_path, SMALL, 5, "--resume", which=[2, 3, 4])
    assert leapmap("join", joined).returncode == 0
    same_datasets(sweep(tmp_path, SMALL, name="one.h5"), joined)


def test_what_a_killed_join_left_is_in_nobodys_way(tmp_path):
    joined = shards(tmp_path, SMALL, 2)
    assert leapmap("join", joined).returncode == 0
    part = joined.with_name(joined.name + ".part")
    joined.rename(part)
    resumed = leapmap("sweep", tmp_path / "shards.toml", "-o", joined, "--resume")
    assert resumed.returncode == 2 and "leapmap join" in resumed.stderr and part.exists()
    assert leapmap("join", joined).returncode == 0 and not part.exists()
    same_datasets(sweep(tmp_path, SMALL, name="one.h5"), joined)


def test_a_file_under_anothers_name_is_not_whole_already(tmp_path):
    joined = shards(tmp_path, SMALL, 2)
    first, second = (shard(joined, i, 2) for i in (1, 2))
    spec = tmp_path / "shards.toml"
    for path, words, said in ((joined, (), "shard 1/2"), (second, ("--shard", "2/2"), "shard 1/2")):
        path.write_bytes(first.read_bytes())
        done = leapmap("sweep", spec, "-o", joined, "--resume", *words)
        assert done.returncode == 2 and said in done.stderr, done
    joined.unlink()
    first.write_bytes(sweep(tmp_path, SMALL, name="one.h5").read_bytes())
    done = leapmap("sweep", spec, "-o", joined, "--resume", "--shard", "1/2")
    assert done.returncode == 2 and "a whole map" in done.stderr


def test_a_map_of_thousands_of_tiles_has_shards_that_are_resumed_checked_and_joined(tmp_path):
    axes = {"mu_static": (0.3, 0.9), "mu_kinetic": (0.2, 0.3), "restitution": (0, 0.4)}
    design = {
        "slope": (0.2, 0.6), "mass_ratio": (1, 4), "offset_ratio": (0.6, 1), "inertia_factor": (0.8, 1),
        "release_angle": (3, 3.3), "release_spin": (0, 0.2), "drive_torque": (0, 0.02),
        "resisting_torque": (0, 0.01)
    }
    said = lambda parts: "".join(f"{name} = {{ from = {a}, to = {b}, count = 3 }}\n" for name,
                                 (a, b) in parts.items())
    spec = (f'[scene]\nfriction = "coulomb"\nrunway = 1\n{said(axes)}[design]\n{said(design)}[numerics]\n'
            'audit = 0\n[output]\nfields = ["status"]\n')
    joined = shards(tmp_path, spec, 2)
    assert leapmap("sweep", tmp_path / "shards.toml", "-o", joined, "--resume", "--shard",
                   "2/2").returncode == 0
    assert leapmap("check", shard(joined, 1, 2)).returncode == 0
    done = leapmap("join", joined)
    tiles = int(done.stdout.split(" chunks")[0].split()[-1].replace(",", ""))
    assert done.returncode == 0 and tiles > 64 * 64, done
    with h5py.File(sweep(tmp_path, spec, name="one.h5")) as a, h5py.File(joined) as b:
        assert a.attrs["tiles_checksum"] == b.attrs["tiles_checksum"]
    assert "in 2 shards" in leapmap("info", joined).stdout


def test_an_audit_that_disagrees_is_told_by_the_exit_status_quiet_or_not(tmp_path):
    joined = shards(tmp_path, SMALL, 2, "--set", "audit=0.1")
    with h5py.File(shard(joined, 2, 2), "r+") as file:
        file.attrs["audit_first_mismatch"] = np.int64(0)
    for words in ((), ("--quiet",)):
        assert leapmap("join", joined, "--overwrite", *words).returncode == 1


def test_a_map_that_is_there_stays_unless_it_may_be_replaced(tmp_path):
    joined = shards(tmp_path, SMALL, 2)
    joined.write_bytes(sweep(tmp_path, SMALL, name="one.h5").read_bytes())
    before = joined.read_bytes()
    assert leapmap("join", joined).returncode == 2 and joined.read_bytes() == before
    assert leapmap("join", joined, "--overwrite").returncode == 0
    same_datasets(tmp_path / "one.h5", joined)


@pytest.mark.parametrize("text", ["0/3", "4/3", "3", "a/b", "1/0", "1/99999", "1/3/5", "-1/3"])
def test_what_is_no_part_of_a_whole_is_refused(text, tmp_path):
    done = leapmap("sweep", "-o", tmp_path / "m.h5", f"--shard={text}")
    assert done.returncode == 2 and "--shard" in done.stderr and not list(tmp_path.iterdir())


def test_shards_for_which_there_is_no_tile_left_are_empty(tmp_path):
    joined = shards(tmp_path, SMALL, 9)
    shard(joined, 9, 9).unlink()
    told = leapmap("sweep", tmp_path / "shards.toml", "-o", joined, "--shard", "9/9").stdout
    assert "shard 9/9 has none" in told and "nan" not in told
    assert leapmap("join", joined).returncode == 0
    same_datasets(sweep(tmp_path, SMALL, name="one.h5"), joined)


def test_a_plan_of_shards_wants_a_dry_run():
    done = finished(PROGRAM, "sweep", "--shards", "4")
    assert done.returncode == 2 and "--dry-run" in done.stderr


def test_the_plan_tells_places_that_threads_are_bound_to(tmp_path):
    told = subprocess.run(
        [PROGRAM, "sweep", "-o", tmp_path / "m.h5", "--set", "slope={from=0.1,to=0.8,count=50}", "--dry-run"],
        capture_output=True, text=True, env={**os.environ, "OMP_PLACES": "threads", "OMP_PROC_BIND": "close"})
    assert told.returncode == 0 and "places " in told.stdout and "bound" in told.stdout
    assert "places " not in leapmap("sweep", "-o", tmp_path / "m.h5", "--set",
                                    "slope={from=0.1,to=0.8,count=50}", "--dry-run").stdout


def test_bound_threads_make_the_same_map(tmp_path):
    sweep(tmp_path, SMALL)
    bound = subprocess.run([PROGRAM, "sweep", tmp_path / "spec.toml", "-o", tmp_path / "bound.h5", "--quiet"],
                           env={**os.environ, "OMP_PLACES": "threads", "OMP_PROC_BIND": "spread"})
    assert bound.returncode == 0
    with h5py.File(tmp_path / "map.h5") as a, h5py.File(tmp_path / "bound.h5") as b:
        assert a.attrs["tiles_checksum"] == b.attrs["tiles_checksum"]


def test_gnu_parallel_runs_all_shards_and_joins_them(tmp_path):
    if not shutil.which("parallel"):
        pytest.skip("GNU parallel is missing")
    sweep(tmp_path, SMALL, name="one.h5")
    again = lambda *words: subprocess.run([
        "sh", TOP / "sweeps" / "cluster" / "parallel.sh", "3", tmp_path / "spec.toml", tmp_path / "all" /
        "map.h5", *words
    ], capture_output=True, text=True, env={**os.environ, "LEAPMAP": PROGRAM})
    done = again()
    assert done.returncode == 0, done.stderr
    same_datasets(tmp_path / "one.h5", tmp_path / "all" / "map.h5")
    # complete already; of another spec
    assert again().returncode == 0 and again("--set", "runway=2").returncode == 2
