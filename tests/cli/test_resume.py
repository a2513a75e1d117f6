# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever stops a sweep, --resume ends it with the map of a sweep that was never stopped."""
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import h5py
import numpy as np
import pytest
from support.program import PROGRAM, SMALL, TOP, finished, leapmap, scripted

# About a second and a half on two cores, in some 800 tiles.
SPEC = """
[design]
slope = { from = "2 deg", to = "50 deg", count = 160 }
mass_ratio = { from = 0.1, to = 20, count = 160, scale = "log" }
offset_ratio = { from = 0.3, to = 1.0, count = 100 }
[numerics]
audit = 1e-4
[output]
fields = ["jump_height", "jump_time", "spurious_first_jump", "status"]
"""


HALF = 10_000_000  # bytes; its whole map has 24 million


def values(path):
    """Every dataset's bytes, and the attributes that tell of numbers."""
    with h5py.File(path) as m:
        datasets = {name: d[()].tobytes() for name, d in m.items() if isinstance(d, h5py.Dataset)}
        about = {k: np.asarray(m.attrs[k]).tobytes() for k in m.attrs
                 if k.startswith(("audit_", "status_counts", "tiles_checksum")) and k != "audit_method"}
        return datasets, about


@pytest.fixture(scope="module")
def uninterrupted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole")
    (folder / "spec.toml").write_text(SPEC)
    begin = time.time()
    done = leapmap("sweep", folder / "spec.toml", "-o", folder / "map.h5")
    assert done.returncode == 0, done.stderr
    return folder / "map.h5", time.time() - begin


def command(folder, *more):
    # committed after every tile, so that a kill meets commits as often as computing
    return [
        str(w) for w in (PROGRAM, "sweep", folder / "spec.toml", "-o", folder / "map.h5", "--commit-interval",
                         "0", *more)
    ]


def killed(folder, seconds, number=signal.SIGKILL, *more):
    process = subprocess.Popen(command(folder, *more), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True)
    time.sleep(seconds)
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    return process.returncode, out, err


def wait_for(path, size):
    """Until the file is so large; false if it never is."""
    for _ in range(30000):
        if path.exists() and path.stat().st_size >= size:
            return True
        time.sleep(0.002)
    return False


def has_all_designs(part):
    """Whether it was stopped between its last tile and its renaming."""
    done, count = re.search(r"INCOMPLETE: ([\d,]+) of ([\d,]+) designs",
                            leapmap("info", part).stdout).groups()
    return done == count


def stopped(folder, size, number=signal.SIGINT, *more):
    """A sweep stopped once its .part is so large, before its last tile, whatever the machine is doing
    meanwhile."""
    part = folder / "map.h5.part"
    for _ in range(8):
        process = subprocess.Popen(command(folder, *more), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True)
        assert wait_for(part, size) or process.poll() is not None
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
        if process.returncode == -signal.SIGKILL or process.returncode != 0 and not has_all_designs(part):
            return process.returncode, out, err
        (part if process.returncode else folder / "map.h5").unlink()  # it was faster than we saw
        size //= 2
    pytest.fail("a sweep could not be stopped in eight trials")


def tiles_done(part):
    with h5py.File(part) as p:
        return int(p.attrs.get("tiles_done", 10**9))


def test_killed_at_random_moments_it_is_gone_on_with_to_the_same_bits(uninterrupted, tmp_path):
    whole, duration = uninterrupted
    expected = values(whole)
    moments = random.Random(4)
    resumed_in_the_middle = 0
    kills = int(os.environ.get("LEAPMAP_KILLS", 2))  # slow.kills: 40
    for run in range(kills):
        folder = tmp_path / str(run)
        folder.mkdir()
        (folder / "spec.toml").write_text(SPEC)
        # Killed at a random time, which may be before its file is there, or at a random size of its file;
        # some are killed twice, the second time while resuming.
        if run % 2:
            assert stopped(folder, moments.randrange(22_000_000), signal.SIGKILL)[0] == -signal.SIGKILL
        else:
            assert killed(folder, moments.uniform(0.0, 1.5 * duration))[0] in (-signal.SIGKILL, 0)
        if run % 3 == 0:
            killed(folder, moments.uniform(0.0, duration), signal.SIGKILL, "--resume")
        assert not ((folder / "map.h5").exists() and (folder / "map.h5.part").exists())
        done = finished(*command(folder, "--resume"))
        assert done.returncode == 0, done.stderr
        resumed_in_the_middle += "resumed" in done.stdout
        assert values(folder / "map.h5") == expected
        assert not (folder / "map.h5.part").exists()
        shutil.rmtree(folder)
    assert resumed_in_the_middle >= max(1, kills // 4), "kills were to fall into the work"


def test_a_part_cut_anywhere_is_refused_with_a_line_or_gone_on_with(uninterrupted, tmp_path):
    (tmp_path / "spec.toml").write_text(SPEC)
    assert stopped(tmp_path, HALF)[0] == 130
    part = tmp_path / "map.h5.part"
    bytes_ = part.read_bytes()
    cuts = random.Random(5)
    for cut in [0, 1, 7, 8, 9, 47, 48, len(bytes_) - 1, *(cuts.randrange(len(bytes_)) for _ in range(25))]:
        part.write_bytes(bytes_[:cut])
        told = leapmap("info", part)
        assert told.returncode == 3 and told.stderr.count("\n") == 1, told.stderr
        if cut == 0:
            continue  # nothing was ever written: --resume begins anew
        done = finished(*command(tmp_path, "--resume"))
        assert done.returncode == 3 and done.stderr.count("\n") == 1 and "--overwrite" in done.stderr, (
            cut, done.stderr)
        assert not (tmp_path / "map.h5").exists()
        assert part.read_bytes() == bytes_[:cut], "what is refused is left alone"
    part.write_bytes(bytes_ + os.urandom(5000))  # what a commit that never came left
    assert finished(*command(tmp_path, "--resume")).returncode == 0
    assert values(tmp_path / "map.h5") == values(uninterrupted[0])


def test_a_part_whose_bytes_changed_is_refused_and_left_alone(uninterrupted, tmp_path):
    (tmp_path / "spec.toml").write_text(SPEC)
    assert stopped(tmp_path, HALF)[0] == 130
    part = tmp_path / "map.h5.part"
    whole = part.read_bytes()
    with h5py.File(part) as p:
        places = {
            name: p[name].id.get_offset() + 8 * 3 + 2 for name in ("slope", "mass_ratio", "offset_ratio")
        }
        places["jump_height"] = p["jump_height"].id.get_chunk_info(0).byte_offset + 20
        places["the superblock"] = 20
    places["a text"] = whole.index(b"slope of the plane") + 4
    for what, place in places.items():
        broken = bytearray(whole)
        broken[place] ^= 1
        part.write_bytes(broken)
        done = finished(*command(tmp_path, "--resume"))
        assert done.returncode == 3 and done.stderr.count("\n") == 1 and done.stderr.count(
            "--overwrite") == 1, (what, done.stderr)
        assert part.read_bytes() == broken, what
    part.write_bytes(b"words" * 40000)
    refused = finished(*command(tmp_path, "--resume"))
    assert refused.returncode == 2 and "not an unfinished leapmap map" in refused.stderr
    assert part.read_bytes() == b"words" * 40000


def test_ctrl_c_tells_the_command_that_goes_on_and_it_does(uninterrupted, tmp_path):
    (tmp_path / "spec.toml").write_text(SPEC)
    status, out, err = stopped(tmp_path, HALF, signal.SIGTERM, "--set", "output.compression=2")
    assert status == 143 and out == "" and err.count("\n") == 1
    line = err.split("resume: leapmap ")[1].strip()
    done = subprocess.run(f"{PROGRAM} {line}", shell=True, capture_output=True, text=True)
    assert done.returncode == 0 and "resumed" in done.stdout, done.stderr
    assert values(tmp_path / "map.h5")[0] == values(uninterrupted[0])[0], "compression changes no value"
    again = subprocess.run(f"{PROGRAM} {line}", shell=True, capture_output=True, text=True)
    assert again.returncode == 0 and "complete already" in again.stdout


@pytest.mark.parametrize("second", [signal.SIGINT, signal.SIGTERM])
def test_a_second_signal_stops_at_once_and_leaves_a_part_to_go_on_with(second, tmp_path):
    slow = SPEC.replace("audit = 1e-4", 'method = "gsl-rk4"\ntolerance = 1e-13\naudit = 0')
    (tmp_path / "spec.toml").write_text(slow)
    process = subprocess.Popen(command(tmp_path), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert wait_for(tmp_path / "map.h5.part", 10_000)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    time.sleep(0.2)
    process.send_signal(second)
    process.communicate(timeout=60)
    assert process.returncode == -second
    assert leapmap("info", tmp_path / "map.h5.part").returncode == 0
    assert not (tmp_path / "map.h5").exists()


def test_ctrl_c_while_a_resumed_sweep_gathers_its_audit(tmp_path):
    slow = SPEC.replace("audit = 1e-4", 'method = "gsl-rk8pd"\naudit = 0.6')
    (tmp_path / "spec.toml").write_text(slow)
    assert stopped(tmp_path, 50_000)[0] == 130  # about 15,000 designs, half a second or more to solve again
    tiles = tiles_done(tmp_path / "map.h5.part")
    # the latter: even before that
    assert killed(tmp_path, 0.3, signal.SIGINT, "--resume")[0] in (130, -signal.SIGINT)
    assert tiles_done(tmp_path / "map.h5.part") == tiles


def test_an_unfinished_map_tells_what_it_lacks(uninterrupted, tmp_path):
    sys.path.insert(0, str(TOP / "analysis"))
    from read_map import read_map
    # without status holes look like no jump
    (tmp_path / "spec.toml").write_text(SPEC.replace(', "status"', ""))
    assert stopped(tmp_path, HALF)[0] == 130
    part = read_map(tmp_path / "map.h5.part")
    whole = read_map(uninterrupted[0])
    computed = part.computed()
    assert not part.whole and whole.whole and whole.computed().all()
    assert computed.sum() == part.attributes["status_counts"].sum() and 0 < computed.sum() < computed.size
    expected = np.where(computed, whole.fields["jump_height"], np.nan)
    assert np.array_equal(part.fields["jump_height"], expected, equal_nan=True)
    told = leapmap("info", tmp_path / "map.h5.part").stdout
    assert f"INCOMPLETE: {computed.sum():,} of {computed.size:,} designs" in told
    plan = finished(*command(tmp_path, "--resume", "--dry-run")).stdout
    assert f"holds {computed.sum():,} designs: the sweep will resume it" in plan
    not_yet = leapmap("info", tmp_path / "map.h5")
    assert not_yet.returncode == 3 and "map.h5.part" in not_yet.stderr


def test_the_chart_of_an_unfinished_map_says_so(tmp_path):
    (tmp_path / "spec.toml").write_text("""[design]
slope = { from = 0.1, to = 0.8, count = 200 }
mass_ratio = { from = 0.5, to = 10, count = 200 }
[numerics]
method = "gsl-rk8pd"
audit = 0
""")
    assert stopped(tmp_path, 500_000)[0] == 130
    chart = scripted("design_chart.py", tmp_path / "map.h5.part", "-o", tmp_path / "chart")
    assert chart.returncode == 0 and "INCOMPLETE" in chart.stderr
    assert (tmp_path / "chart_jump_height.png").exists()


def test_another_spec_is_refused_by_its_key(uninterrupted, tmp_path):
    (tmp_path / "spec.toml").write_text(SPEC)
    assert stopped(tmp_path, HALF)[0] == 130
    before = (tmp_path / "map.h5.part").read_bytes()
    for key, setting in {
            "numerics.tolerance": "tolerance=1e-9", "scene.runway": "runway=3",
            "design.slope": "slope={values=[0.1,0.2]}", "output.precision": "precision=f4",
            "output.fields": 'fields=["status"]', "design.release_spin": "release_spin=0.1"
    }.items():
        done = finished(*command(tmp_path, "--resume", "--set", setting))
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and key in done.stderr, done.stderr
    assert (tmp_path / "map.h5.part").read_bytes() == before
    done = finished(*command(tmp_path, "--overwrite", "--set", "runway=3"))
    assert done.returncode == 0, "--overwrite starts anew"


def test_a_list_is_gone_on_with_unless_its_designs_changed(tmp_path):
    rows = [f"{0.1 + 1e-5 * i},{1 + 1e-4 * i}" for i in range(60000)]
    (tmp_path / "designs.csv").write_text("slope,mass_ratio\n" + "\n".join(rows))
    (tmp_path / "spec.toml"
     ).write_text('[design]\npoints = "designs.csv"\n[numerics]\nmethod = "gsl-rk8pd"\naudit = 0\n')
    assert stopped(tmp_path, 5_000_000)[0] == 130  # of which 3.4 MB are the list itself
    (tmp_path / "designs.csv").write_text("slope,mass_ratio\n" + "\n".join(rows[:-1] + ["0.3,2"]))
    done = finished(*command(tmp_path, "--resume"))
    assert done.returncode == 2 and "design.slope" in done.stderr, done.stderr
    (tmp_path / "designs.csv").write_text("mass_ratio,slope\n" + "\n".join(",".join(r.split(",")[::-1])
                                                                           for r in rows))
    done = finished(*command(tmp_path, "--resume"))
    assert done.returncode == 0 and "resumed" in done.stdout, "the columns' order does not matter"


def test_two_sweeps_on_one_output_the_second_is_refused(tmp_path):
    (tmp_path / "spec.toml").write_text(SPEC.replace("audit = 1e-4", 'method = "gsl-rk8pd"\naudit = 0'))
    first = subprocess.Popen(command(tmp_path), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        assert wait_for(tmp_path / "map.h5.part", 10_000)
        for more in ([], ["--overwrite"], ["--resume"]):
            second = finished(*command(tmp_path, *more))
            assert second.returncode == 2 and second.stderr.count(
                "\n") == 1 and "map.h5.part" in second.stderr, second.stderr
        reading = leapmap("info", tmp_path / "map.h5.part")
        assert reading.returncode == 2 and "writing" in reading.stderr
    finally:
        first.send_signal(signal.SIGINT)
        first.communicate(timeout=120)
    assert first.returncode == 130


def test_resume_without_anything_to_go_on_with_begins_anew(tmp_path):
    (tmp_path / "spec.toml").write_text(SMALL)
    assert finished(*command(tmp_path, "--resume")).returncode == 0
    assert "complete already" in finished(*command(tmp_path, "--resume")).stdout
    other = finished(*command(tmp_path, "--resume", "--set", "runway=3"))
    assert other.returncode == 2 and "exists already" in other.stderr and "scene.runway" in other.stderr


def grown(folder, limit=None):
    """A sweep of 40,000 designs and all fields, 3 MB; limit: of the bytes a file may have."""
    def preexec():
        if limit:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    words = command(folder, "--resume", "--set", "slope={from=0.1,to=0.8,count=200}", "--set",
                    "mass_ratio={from=0.1,to=20,count=200}", "--set", "offset_ratio=1", "--set", "audit=0",
                    "--set", "compression=0")
    return subprocess.run(words, capture_output=True, text=True, preexec_fn=preexec)


def test_a_file_that_may_not_grow_is_gone_on_with_once_it_may(tmp_path):
    (tmp_path / "spec.toml").write_text(SMALL)
    # less than a tile
    for limit in (500, 1000, 4000, 8000, 12_000, 16_000, 24_000, 30_000, 40_000, 60_000, 100_000):
        done = grown(tmp_path, limit)
        assert done.returncode == 3 and done.stderr.count("\n") == 1, (limit, done.stderr)
        assert os.listdir(tmp_path) == ["spec.toml"], limit
    for limit in (300_000, 900_000, 1_700_000):
        done = grown(tmp_path, limit)
        assert done.returncode == 3 and done.stderr.count("\n") == 1, done.stderr
        assert "File too large" in done.stderr and "designs are kept" in done.stderr, done.stderr
        assert leapmap("info", tmp_path / "map.h5.part").returncode == 0
    last = grown(tmp_path)
    assert last.returncode == 0 and "resumed" in last.stdout, last.stderr
    (tmp_path / "whole").mkdir()
    (tmp_path / "whole" / "spec.toml").write_text(SMALL)
    assert grown(tmp_path / "whole").returncode == 0
    assert values(tmp_path / "map.h5") == values(tmp_path / "whole" / "map.h5")


def test_a_full_disk_ends_with_status_3_and_with_space_again_the_sweep_goes_on(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = finished("mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", disk)
    if mounted.returncode != 0:
        pytest.skip(f"mounting a tmpfs is not allowed here: {mounted.stderr.strip()}")
    try:
        (disk / "spec.toml").write_text(SMALL)
        (disk / "ballast").write_bytes(bytes(2_500_000))
        done = grown(disk)
        assert done.returncode == 3 and done.stderr.count("\n") == 1, done.stderr
        assert "No space left" in done.stderr and "designs are kept" in done.stderr, done.stderr
        assert not (disk / "map.h5").exists()
        (disk / "ballast").unlink()  # 4 MB hold the map once, not twice
        done = grown(disk)
        assert done.returncode == 0 and "resumed" in done.stdout, done.stderr
        got = values(disk / "map.h5")
        (disk / "map.h5").unlink()
        assert grown(disk).returncode == 0
        assert values(disk / "map.h5") == got
    finally:
        subprocess.run(["umount", disk], check=True)


def test_a_map_behind_a_symbolic_link_stays_there(tmp_path):
    (tmp_path / "spec.toml").write_text(SMALL)
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "map.h5").symlink_to(tmp_path / "elsewhere" / "real.h5")
    assert finished(*command(tmp_path)).returncode == 0
    assert (tmp_path / "map.h5").is_symlink()
    assert leapmap("info", tmp_path / "elsewhere" / "real.h5").returncode == 0
    (tmp_path / "other.h5.part").symlink_to(tmp_path / "victim")
    (tmp_path / "victim").write_text("precious")
    refused = leapmap("sweep", tmp_path / "spec.toml", "-o", tmp_path / "other.h5", "--overwrite")
    assert refused.returncode == 2 and (tmp_path / "victim").read_text() == "precious"


def test_names_and_streams_that_cannot_be_written_are_a_status_and_no_crash(tmp_path):
    (tmp_path / "spec.toml").write_text(SMALL)
    done = leapmap("sweep", tmp_path / "spec.toml", "-o", tmp_path / ("x" * 252), "--resume")
    assert done.returncode == 3 and done.stderr.count("\n") == 1, done.stderr
    with open("/dev/full", "w") as full:
        assert subprocess.run([PROGRAM, "sweep", tmp_path / "nowhere.toml"], stderr=full).returncode == 2


FAILING = """
[design]
slope = { from = 0.1, to = 0.8, count = 20 }
mass_ratio = { from = 0.5, to = 10, count = 30 }
[numerics]
method = "gsl-rk8pd"
max_steps = 40
audit = 0
"""


def test_failed_designs_are_listed_as_commands_that_fail_and_retried(tmp_path):
    (tmp_path / "spec.toml").write_text(FAILING)
    assert finished(*command(tmp_path)).returncode == 0
    with h5py.File(tmp_path / "map.h5") as m:
        failed = int((m["status"][()] == 6).sum())
        assert failed > 100 and m.attrs["status_counts"][6] == failed
        assert np.isnan(m["jump_height"][()][m["status"][()] == 6]).all()
    listed = leapmap("info", tmp_path / "map.h5", "--failed", "--limit", 2).stdout.splitlines()
    assert len([line for line in listed if line.startswith("leapmap hop")]) == 2
    assert f"{failed} failed designs" in listed[-1]
    hop = subprocess.run(listed[0].replace("leapmap", PROGRAM, 1), shell=True, capture_output=True, text=True)
    assert hop.returncode == 1 and "The method failed" in hop.stdout, hop.stdout
    done = finished(*command(tmp_path, "--retry-failed"))
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"{failed} solved, 0 failed again" in done.stdout, done.stdout + done.stderr
    with h5py.File(tmp_path / "map.h5") as m:
        assert (m["status"][()] == 6).sum() == 0 and m.attrs["status_counts"].sum() == 600
        assert np.isfinite(m["jump_height"][()][m["status"][()] == 1]).all()
    other = finished(*command(tmp_path, "--retry-failed", "--set", "slope=0.3"))
    assert other.returncode == 2 and "axes" in other.stderr
    assert sorted(os.listdir(tmp_path)) == ["map.h5", "spec.toml"]


def test_a_map_that_stores_no_status_still_counts_the_failed(tmp_path):
    (tmp_path / "spec.toml").write_text(FAILING + '[output]\nfields = ["jump_height"]\n')
    assert finished(*command(tmp_path)).returncode == 0
    assert " failed\n" in leapmap("info", tmp_path / "map.h5").stdout
    refused = leapmap("info", tmp_path / "map.h5", "--failed")
    assert refused.returncode == 2 and "status" in refused.stderr
