# SPDX-License-Identifier: GPL-3.0-or-later
"""Jump after jump on the command line: sequences in maps and told, and gaits."""
import json
import shutil

import h5py
import numpy as np
import pytest

from support.program import leapmap, sweep

HOOP = ["--slope", "12 deg", "--mass-ratio", "3", "--offset-ratio", "0.5"]


def told(*arguments):
    done = leapmap(*arguments, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_hop_tells_every_jump():
    done = leapmap("hop", *HOOP, "--jumps", "5", "--set", "runway=20")
    assert done.returncode == 0, done.stderr
    assert "F  jumps, 5" in done.stdout and "5 jumps of 5" in done.stdout
    hop = told("hop", *HOOP, "--jumps", "5", "--set", "runway=20")
    heights = [hop["jump_height"]] + [hop[f"jump_height_{k}"] for k in range(2, 6)]
    assert [one["height"] for one in hop["lift_offs"] if one["is_jump"]] == pytest.approx(heights, abs=1e-12)
    assert hop["jumps"] == 5 and hop["sequence_end"] == "jumped"


@pytest.mark.parametrize("friction", ["sticking", "coulomb"])
def test_a_map_of_sequences_holds_what_hop_tells_and_its_end(tmp_path, friction):
    spec = (f"[scene]\nfriction = \"{friction}\"\njumps = 3\nrunway = 6.0\n[design]\n"
            f"slope = {{ from = 0.1, to = 0.5, count = 9 }}\n[numerics]\naudit = 1\n")
    path = sweep(tmp_path, spec)
    with h5py.File(path) as m:
        jumps, end = m["jumps"][:], m["sequence_end"][:]
        later = m["jump_height_3"][:]
        assert (np.isfinite(later) == (jumps == 3)).all() and (end[jumps == 3] == 1).all()
        assert (end[jumps < 3] != 1).all()
        assert len(set(jumps.tolist())) > 1
        for i in (0, 4, 8):
            hop = told("hop", "--friction", friction, "--slope", repr(float(m["slope"][i])), "--jumps", "3",
                       "--set", "runway=6")
            assert hop["jumps"] == jumps[i]
            for k in range(2, jumps[i] + 1):
                assert hop[f"jump_height_{k}"] == pytest.approx(m[f"jump_height_{k}"][i], abs=1e-12)
                assert hop[f"jump_time_{k}"] == pytest.approx(m[f"jump_time_{k}"][i], rel=1e-9)


def test_the_audit_tells_of_later_jumps_and_gaits_and_check_sees_a_wrong_one(tmp_path):
    spec = (
        "[scene]\njumps = 4\nrunway = 20.0\n[design]\nslope = { from = 0.1, to = 0.4, count = 8 }\n"
        "mass_ratio = { from = 1, to = 4, count = 4 }\n"
        "offset_ratio = 0.5\n[gait]\nsettle = 200\n[numerics]\naudit = 1\n")
    (tmp_path / "spec.toml").write_text(spec)
    path = tmp_path / "map.h5"
    done = leapmap("sweep", tmp_path / "spec.toml", "-o", path)
    assert done.returncode == 0, done.stderr
    assert "later jumps: 0 designs wrong" in done.stdout
    assert "by integration over one period: 0 wrong" in done.stdout
    with h5py.File(path) as m:
        made, period = m["jumps"][:], m["gait_period"][:]
        assert m.attrs["audit_jumps_compared"] + m.attrs["audit_jumps_beyond"] == (made[made > 0] -
                                                                                   1).sum() > 20
        assert m.attrs["audit_gaits"] == ((period > 0) & (period < 255)).sum() > 5
        assert m.attrs["audit_gaits_wrong"] == 0
        assert 0 < m.attrs["audit_jump_max_error"] < 1e-11 and m.attrs["audit_first_wrong_gait"] == -1
    assert "later jumps" in leapmap("info", path).stdout
    assert leapmap("check", path, "--sample", "32").returncode == 0
    shutil.copy(path, path.with_suffix(".right"))
    for field, words in (("jump_height_3", "later jumps"), ("gait_height", "does not find the stored gait")):
        with h5py.File(path, "r+") as m:
            del m.attrs["tiles_checksum"]
            values = m[field][:]
            where = tuple(np.argwhere(np.isfinite(values))[0])
            m[field][where] = values[where] + 1e-6
        found = leapmap("check", path, "--sample", "32")
        assert found.returncode == 1 and words in found.stdout, found.stdout + found.stderr
        shutil.copy(path.with_suffix(".right"), path)


def test_the_growth_of_errors_is_told_where_it_is_asked_for(tmp_path):
    spec = ("[scene]\njumps = 40\nrunway = 500.0\n[design]\n"
            "slope = {{ values = [0.2094395102393195, 0.35] }}\nmass_ratio = 3.0\noffset_ratio = {}\n{}")
    plain = sweep(tmp_path, spec.format(0.5, ""), name="plain.h5")
    with h5py.File(plain) as m:
        assert "sequence_condition" not in m
    asked = "[output]\nfields = [\"jumps\", \"sequence_condition\"]\n"
    with h5py.File(sweep(tmp_path, spec.format(0.5, asked), name="tame.h5")) as m:
        assert m["jumps"][0] == 40 and 1 < m["sequence_condition"][0] < 1e3
    with h5py.File(sweep(tmp_path, spec.format(0.8, asked), name="wild.h5")) as m:
        assert m["jumps"][1] == 40 and m["sequence_condition"][1] > 1e4
    hop = told("hop", "--slope", "0.35", "--mass-ratio", "3", "--offset-ratio", "0.8", "--jumps", "250",
               "--set", "runway=1000")
    assert hop["jumps"] == 250 and hop["sequence_condition"] == 1e20


def test_sequences_and_gaits_have_the_same_bits_whatever_the_threads(tmp_path):
    spec = (
        "[scene]\njumps = 4\nrunway = 20.0\n[design]\nslope = { from = 0.1, to = 0.5, count = 40 }\n"
        "mass_ratio = { from = 0.5, to = 9, count = 30 }\noffset_ratio = 0.5\n[gait]\nsettle = 100\n"
        "[numerics]\naudit = 0\n"
    )
    maps = [sweep(tmp_path, spec, "--threads", threads, name=f"{threads}.h5") for threads in ("1", "2")]
    with h5py.File(maps[0]) as one, h5py.File(maps[1]) as two:
        for name in ("jump_height_4", "jump_time_4", "gait_period", "gait_multiplier", "gait_speed"):
            assert one[name][:].tobytes() == two[name][:].tobytes(), name
        period, multiplier = one["gait_period"][:], one["gait_multiplier"][:]
    found = (period > 0) & (period < 255)
    assert found.sum() > 100 and (np.abs(multiplier[found]) < 1).all() and np.isnan(multiplier[~found]).all()


def test_gait_tells_every_gait_of_a_hoop_and_which_the_release_settles_on():
    done = leapmap("gait", *HOOP)
    assert done.returncode == 0, done.stderr
    assert "converge to a gait of period 1" in done.stdout and "unstable" in done.stdout
    all_of_them = told("gait", *HOOP, "--most-period", "2")
    stable = [gait for gait in all_of_them["gaits"] if abs(gait["multiplier"]) < 1]
    assert len(stable) == 1 and stable[0]["height"] == pytest.approx(all_of_them["gait_height"], abs=1e-10)
    assert stable[0]["multiplier"] == pytest.approx(all_of_them["gait_multiplier"], abs=1e-8)
    assert {gait["period"] for gait in all_of_them["gaits"]} == {1, 2}
    # The return map's own slope where it crosses the diagonal is the multiplier.
    angle, following, slope = np.array([row[:3] for row in all_of_them["return_map"] if None not in row[:3]],
                                       float).T
    there = stable[0]["jumps"][0]["angle"] % (2 * np.pi)
    nearest = np.argmin(np.abs(angle - there))
    assert abs(following[nearest] - angle[nearest]) < 0.02
    assert slope[nearest] == pytest.approx(stable[0]["multiplier"], abs=0.02)


def test_gait_shows_the_units_of_a_drawing_and_those_asked_for():
    plain = leapmap("gait", *HOOP, "--set", "radius=0.06", "--most-period", "1").stdout
    height = told("gait", *HOOP, "--set", "radius=0.06", "--most-period", "1")["gait_height"]
    assert f"{height:.6f} ({120 * height:.4g} mm)" in plain and "height [hoop diameters]" in plain
    asked = leapmap("gait", *HOOP, "--set", "radius=0.06", "--most-period", "1", "--units", "mm ms").stdout
    assert "height [mm]" in asked and f"period 1: {120 * height:.6g} mm, " in asked
    refused = leapmap("gait", *HOOP, "--units", "N")
    assert refused.returncode == 2 and "no column can be given in N" in refused.stderr


def test_hop_says_how_many_later_jumps_were_checked_and_how_far_to_believe_them():
    tame = leapmap("hop", *HOOP, "--jumps", "5", "--set", "runway=20").stdout
    assert "Later jumps: 4 of 4 compared, all within" in tame
    wild = leapmap("hop", "--slope", "0.6", "--mass-ratio", "8", "--offset-ratio", "0.9", "--jumps", "60",
                   "--set", "runway=1000").stdout
    line = next(line for line in wild.splitlines() if line.startswith("Later jumps: "))
    assert 2 <= int(line.split()[2]) < 30 and "of 59 compared" in line and "not those of this hoop" in line
    settled = leapmap("hop", *HOOP, "--set", "gait.settle=500")
    assert "converge to a gait of period 1" in settled.stdout


def test_gait_does_not_depend_on_what_a_spec_stores():
    plain, other = (leapmap("gait", *HOOP, "--most-period", "1", *more).stdout
                    for more in ([], ["--set", 'output.fields=["jump_height"]']))
    assert plain == other and "converge to a gait of period 1" in plain


def test_with_friction_gait_tells_what_the_release_settles_on():
    hop = told("gait", *HOOP, "--friction", "coulomb", "--mu-static", "0.8")
    assert hop["gaits"] is None and 0 <= hop["gait_period"] <= 255


@pytest.mark.parametrize(
    "arguments, words",
    [(["hop", "--jumps", "251"], "jumps"), (["hop", "--jumps", "1.5"], "jumps"),
     (["gait", "--most-period", "17"], "most-period"), (["gait", "--set", "gait.settle=-1"], "settle"),
     (["gait", "--set", "method=gsl-rk8pd"], "settle"),
     (["gait", "--set", "slope={from=0.1,to=0.2,count=3}"], "leapmap sweep"),
     (["sweep", "--set", "fields=[\"jump_height_3\"]", "--set", "jumps=2", "--dry-run"], "jump_height_3"),
     (["sweep", "--set", "fields=[\"gait_period\"]", "--dry-run"], "gait"),
     (["gait", "--set", "gait.settle=0"], "settle"),
     (["gait", "--friction", "coulomb", "--mu-static", "0.5", "--most-period", "3"], "most-period"),
     (["gait", "--jumps", "3"], "jumps"),
     (["sweep", "--set", "goal.gait_period={is=1}", "--dry-run"], "gait"),
     (["sweep", "--set", "gradients=[\"gait_height\"]", "--set", "settle=50", "--dry-run"], "gait_height")])
def test_bad_input_is_one_line(tmp_path, arguments, words):
    if arguments[0] == "sweep":
        (tmp_path / "spec.toml").write_text("[design]\nslope = { values = [0.3, 0.4] }\n")
        arguments = ["sweep", tmp_path / "spec.toml"] + arguments[1:]
    done = leapmap(*arguments)
    assert done.returncode == 2 and done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1 and words in done.stderr
