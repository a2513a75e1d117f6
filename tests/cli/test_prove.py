# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap prove: maps are judged, cells and hoops within tolerances proved, and what cannot be is refused."""
import json
import re
import shutil
import subprocess

import h5py
import numpy as np
import pytest
from support.program import PROGRAM, TOP, leapmap, sweep

WITHIN = [
    w for key, law in (("slope", '{uniform="1 deg"}'), ("mass_ratio", '{uniform="2 %"}'),
                       ("release_angle", '{uniform="3 deg"}')) for w in ("--set", f"tolerances.{key}={law}")
]
SMALL = """
[design]
slope = { from = "20 deg", to = "24 deg", count = 9 }
mass_ratio = { from = 2.3, to = 2.6, count = 7 }
[numerics]
audit = 0
"""


def test_a_design_s_height_and_time_are_enclosed():
    told = json.loads(leapmap("hop", "--prove", "--json").stdout)
    proof = told["proof"]
    assert proof["proved"] and proof["status"] == "jumped" and proof["lift_offs"] == 2
    for name in ("jump_height", "jump_time", "first_jump_height", "first_jump_time"):
        low, high = proof[name]
        # the solver's own rounding is of the size of the enclosure
        assert low - 1e-12 <= told[name] <= high + 1e-12 and high - low < 1e-10, name
    assert "Proved: jumped at lift-off 2." in leapmap("prove").stdout


def test_a_map_is_what_is_proved_until_a_number_of_it_is_changed(tmp_path):
    path = sweep(tmp_path, SMALL)
    right = leapmap("prove", path)
    assert right.returncode == 0 and "proved   63 of 63 designs" in right.stdout, right.stdout
    assert leapmap("prove", path, "-q").stdout == ""
    with h5py.File(path, "r+") as m:
        height = m["jump_height"][()]
        height[4, 3] *= 1 + 1e-9
        m["jump_height"][...] = height
    wrong = leapmap("prove", path)
    assert wrong.returncode == 1
    assert re.search(r"WRONG    design 31: jump_height \S+ outside the proved \[.*leapmap hop", wrong.stdout)
    assert leapmap("prove", path, "-q").stdout.startswith("WRONG")
    share = leapmap("prove", path, "--share", "0.1")
    assert "of 7 designs, of 63 in the map" in share.stdout


def test_a_sweep_is_audited_by_proofs(tmp_path):
    (tmp_path / "s.toml").write_text(SMALL.replace("audit = 0", 'audit = 1.0\naudit_by = "proof"'),
                                     encoding="utf-8")
    done = leapmap("sweep", tmp_path / "s.toml", "-o", tmp_path / "m.h5")
    assert done.returncode == 0 and "by proof" in done.stdout, done.stdout + done.stderr
    with h5py.File(tmp_path / "m.h5") as m:
        assert m.attrs["audit_method"] == "proof" and m.attrs["audit_designs"] == 63
        assert m.attrs["audit_flag_mismatches"] == 0 and m.attrs["audit_max_abs_height_error"] < 1e-13
    slips = leapmap("sweep", tmp_path / "s.toml", "--set", "friction=coulomb", "-o", tmp_path / "n.h5")
    assert slips.returncode == 2 and "audit_by" in slips.stderr


def test_cells_of_a_grid_are_proved_and_hold_their_designs(tmp_path):
    (tmp_path / "s.toml").write_text(SMALL, encoding="utf-8")
    done = leapmap("prove", tmp_path / "s.toml", "-o", tmp_path / "p.h5")
    assert done.returncode == 0, done.stderr
    with h5py.File(tmp_path / "p.h5") as m:
        proof, low, high = (m[name][()] for name in ("proof", "jump_height_low", "jump_height_high"))
        assert m["proof"].dtype == np.uint8
        assert m["proof"].attrs["flag_meanings"] == "not_computed proved crossed open"
        height = m["jump_height"][()]
        soonest, latest, time = (m[name][()] for name in ("jump_time_low", "jump_time_high", "jump_time"))
    assert set(np.unique(proof)) <= {1, 2, 3} and (proof == 1).mean() > 0.9
    assert (np.isnan(low) == (proof != 1)).all(), "all of this chart jumps"
    assert ((low <= height) & (height <= high))[proof == 1].all()
    assert ((soonest <= time) & (time <= latest))[proof == 1].all()
    assert leapmap("check", tmp_path / "p.h5").returncode == 0
    told = leapmap("info", tmp_path / "p.h5").stdout
    assert re.search(rf"^proof\n +{(proof == 1).sum()} +.*proved", told, re.M), told
    again = leapmap("prove", tmp_path / "s.toml", "-o", tmp_path / "p.h5")
    assert again.returncode == 2 and "--overwrite" in again.stderr


def test_bounds_keep_every_digit_in_a_map_of_f4(tmp_path):
    (tmp_path / "s.toml").write_text(SMALL + '[output]\nprecision = "f4"\n', encoding="utf-8")
    assert leapmap("prove", tmp_path / "s.toml", "-o", tmp_path / "p.h5").returncode == 0
    with h5py.File(tmp_path / "p.h5") as m:
        assert m["jump_height"].dtype == np.float32 and m["jump_height_low"].dtype == np.float64
        assert m["proof"].dtype == np.uint8


def test_failed_designs_of_a_map_with_proofs_are_retried(tmp_path):
    """A rotation that reverses against a torque is followed by no method, and stays failed and open."""
    (tmp_path / "d.csv").write_text(
        "slope,release_spin,resisting_torque\n-0.2,1,0.01\n0.4,0,0\n", encoding="utf-8")
    (tmp_path / "s.toml").write_text('[design]\npoints = "d.csv"\n[numerics]\naudit = 0\n',
                                     encoding="utf-8")
    assert leapmap("prove", tmp_path / "s.toml", "-o", tmp_path / "p.h5").returncode == 0
    with h5py.File(tmp_path / "p.h5") as m:
        before = m["proof"][()].tolist()
        names = list(m["status"].attrs["flag_meanings"].split())
        assert names[m["status"][0]] == "failed" and before == [3, 1]
        fields = [name for name in m if isinstance(m[name], h5py.Dataset)]
    again = leapmap("sweep", tmp_path / "s.toml", "-o", tmp_path / "p.h5", "--retry-failed", "--set",
                    "output.fields=[" + ",".join(f'"{name}"' for name in fields if name in (
                        "status", "spurious_first_jump", "candidates", "jump_height", "jump_time", "proof",
                        "jump_height_low", "jump_height_high", "jump_time_low", "jump_time_high")) + "]")
    assert again.returncode in (0, 1), again.stderr
    with h5py.File(tmp_path / "p.h5") as m:
        assert m["proof"][()].tolist() == before


def test_printed_bounds_are_rounded_outwards():
    flags = ["--set", 'tolerances.slope={uniform="0.2 deg"}']
    found = leapmap("prove", *flags).stdout
    low, high = map(float, re.search(r"lies in \[(.*), (.*)\] diameters", found).groups())
    command = re.search(r"leapmap (hop .*)", found)[1].split()
    worst = json.loads(leapmap(*command, "--prove", "--json").stdout)["proof"]["jump_height"]
    assert low <= worst[0] and high >= worst[1], "the hoop named lies in the enclosure that is printed"


def test_designs_of_a_list_have_enclosures_of_their_times(tmp_path):
    (tmp_path / "d.csv").write_text("slope,mass_ratio\n0.4,2.4\n0.3,0.1\n", encoding="utf-8")
    (tmp_path / "s.toml").write_text('[design]\npoints = "d.csv"\n[numerics]\naudit = 0\n', encoding="utf-8")
    assert leapmap("prove", tmp_path / "s.toml", "-o", tmp_path / "p.h5").returncode == 0
    with h5py.File(tmp_path / "p.h5") as m:
        assert (m["proof"][()] == 1).all()
        low, high, time = (m[name][()] for name in ("jump_time_low", "jump_time_high", "jump_time"))
    assert low[0] - 1e-12 <= time[0] <= high[0] + 1e-12 and np.isnan(low[1]) and np.isnan(time[1])


def test_all_hoops_within_tolerances_are_proved_or_one_misses():
    proved = leapmap("prove", *WITHIN, "--set", "goal.jump_height={at_least=0.9}")
    assert proved.returncode == 0, proved.stderr
    assert proved.stdout.startswith("Proved: every hoop within the tolerances reaches every goal (")
    low, high = map(float, re.search(r"lies in \[(.*), (.*)\] diameters", proved.stdout).groups())
    assert 0.9 < low <= high < low + 2e-3
    missed = leapmap("prove", *WITHIN, "--set", "goal.jump_height={at_least=0.921}")
    assert missed.returncode == 1 and missed.stdout.startswith("Counterexample: ")
    command = re.search(r"leapmap (hop .*)", missed.stdout)[1].split()
    assert json.loads(leapmap(*command, "--json").stdout)["jump_height"] < 0.921
    sampled = json.loads(leapmap("hop", *WITHIN, "--set", "goal.jump_height={at_least=0.921}", "--scatter",
                                 "--json").stdout)
    assert sampled["scatter"]["yield"]["value"] == 1.0, "a thousand hoops do not find it"


@pytest.mark.parametrize("arguments, words", [
    (["--set", "friction=coulomb"], ["friction", "sticking"]),
    (['--set', 'tolerances.slope={normal="1 deg"}'], ["tolerances.slope", "uniform"]),
    ([*WITHIN, "--set", "goal.flight_time={at_least=0.1}"], ["goal.flight_time", "jump_height"]),
    ([TOP / "sweeps" / "smoke.toml"], ["-o", "proof.h5"]),
    (["--set", "goal.jump_height={at_least=0.9}"], ["goal.jump_height", "tolerances"]),
    ([TOP / "sweeps" / "smoke.toml", *WITHIN[2:4], "-o", "never.h5"],
     ["tolerances.mass_ratio", "one design"]),
    (["--resume"], ["--resume"]),
    (["--share", "0.5"], ["--share", "with a map"]),
    ([TOP / "sweeps" / "drawing.toml", "--set", "friction=sticking", "--set",
      'hoop.slug.mass={from="80 g",to="90 g",count=3}', "-o", "never.h5"], ["hoop.slug.mass", "mass_ratio"]),
])
def test_what_cannot_be_proved_is_refused_in_a_line(arguments, words):
    refused = leapmap("prove", *arguments)
    assert refused.returncode == 2 and refused.stderr.count("allowed:") == 1, refused.stderr
    for word in words:
        assert word in refused.stderr, refused.stderr


def test_the_design_whose_worst_hoop_is_best_is_proved(tmp_path):
    (tmp_path / "q.toml").write_text(
        """
[design]
slope = { from = "15 deg", to = "25 deg" }
[tolerances]
slope = { uniform = "1 deg" }
mass_ratio = { uniform = "2 %" }
samples = 32
[goal]
maximize = ["worst_case"]
""", encoding="utf-8")
    found = json.loads(leapmap("design", tmp_path / "q.toml", "--json").stdout)
    best = found["designs"][0]
    low, high = best["worst_case"]["jump_height"]
    assert best["worst_case"]["proved"] and best["objectives"]["worst_case"] == low
    assert 0.8 < low <= high < best["fields"]["jump_height"]
    slope = best["parameters"]["slope"]
    for tilt in (-1, 0.3, 1):  # no hoop within them jumps lower
        for share in (-0.02, 0.02):
            made = json.loads(leapmap("hop", "--slope", repr(slope + np.radians(tilt)), "--mass-ratio",
                                      repr(20 / 8.2 * (1 + share)), "--json").stdout)
            assert made["jump_height"] >= low - 1e-12
    normal = leapmap("design", tmp_path / "q.toml", "--set", 'tolerances.slope={normal="1 deg"}')
    assert normal.returncode == 2 and "tolerances.slope" in normal.stderr and "uniform" in normal.stderr
    slips = leapmap("design", tmp_path / "q.toml", "--set", "friction=coulomb")
    assert slips.returncode == 2 and "worst_case" in slips.stderr


def test_a_worst_case_that_is_a_goal_is_proved_of_what_is_found(tmp_path):
    (tmp_path / "q.toml").write_text(
        """
[design]
mass_ratio = { from = 1, to = 5 }
[tolerances]
slope = { uniform = "1 deg" }
samples = 32
[goal]
worst_case = { at_least = 0.8 }
minimize = ["mass_ratio"]
""", encoding="utf-8")
    best = json.loads(leapmap("design", tmp_path / "q.toml", "--json").stdout)["designs"][0]
    assert best["worst_case"]["proved"] and best["worst_case"]["jump_height"][0] >= 0.8
    assert best["worst_case"]["jump_height"][1] == pytest.approx(0.8, abs=1e-3), "no more than it has to"
    missed = leapmap("design", tmp_path / "q.toml", "--set", "goal.worst_case={at_least=2.9}")
    assert missed.returncode == 1 and "worst_case at least 2.9" in missed.stdout


def test_a_program_without_its_module_says_where_that_should_be(tmp_path):
    alone = shutil.copy(PROGRAM, tmp_path / "leapmap")
    done = subprocess.run([alone, "hop", "--prove"], capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr.startswith("leapmap: leapmap-late.so cannot be loaded: ")
    assert f"; copy it beside the program, or to {tmp_path.parent}/lib" in done.stderr
    assert subprocess.run([alone, "hop"], capture_output=True).returncode == 0
