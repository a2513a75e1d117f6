# SPDX-License-Identifier: GPL-3.0-or-later
"""friction = "coulomb" from outside: the reference tables through leapmap sweep, hop, traces, axes over
friction."""
import csv
import json
import sys

import h5py
import numpy as np
import pytest
from support.program import REFERENCE, TOP, leapmap, sweep

sys.path.insert(0, str(TOP / "analysis"))
from read_map import phases  # noqa: E402

PARAMETERS = ("slope", "mass_ratio", "offset_ratio", "release_angle", "release_spin", "inertia_factor",
              "mu_static", "mu_kinetic", "restitution")
SPEC = ('[scene]\nfriction = "coulomb"\nhop_height = {}\nradius = 1\ngravity = 1\n[design]\n'
        'points = "designs.csv"\n[numerics]\naudit = 1\n')


@pytest.mark.parametrize("table, hop_height, time_error", [("coulomb_first_liftoff", 0.0, 1e-8),
                                                           ("coulomb_multihop", 0.05, 1e-7)])
def test_the_reference_table_through_a_sweep(table, hop_height, time_error, tmp_path):
    rows = list(csv.DictReader(open(REFERENCE / f"{table}.csv")))
    (tmp_path / "designs.csv").write_text("\n".join(
        [",".join(PARAMETERS), *(",".join(r[p] for p in PARAMETERS) for r in rows)]))
    with h5py.File(sweep(tmp_path, SPEC.format(hop_height))) as m:
        assert m.attrs["audit_flag_mismatches"] == 0 and m.attrs["audit_designs"] == len(rows)
        names = dict(zip(m["status"].attrs["flag_values"], m["status"].attrs["flag_meanings"].split()))
        for i, row in enumerate(rows):
            assert names[m["status"][i]] == row["status"], i
            if table == "coulomb_multihop" and i == 69:
                continue  # it has a hop more than the table; see tests/trajectory/coulomb_test.cpp
            assert phases(m["phase_sequence"][i]) == row["sequence"], i
            for name in ("jump_height", "first_jump_height", "jump_time", "first_jump_time", "apex_time",
                         "flight_time", "jump_distance"):
                if row[name]:
                    error = abs(m[name][i] - float(row[name]))
                    assert error < (1e-8 if "height" in name else time_error * float(row[name])), (i, name,
                                                                                                   error)
            if row["spurious"]:
                assert m["spurious_first_jump"][i] == int(row["spurious"]), i


def test_friction_and_restitution_take_axes_and_mu_kinetic_follows_mu_static(tmp_path):
    spec = (
        '[scene]\nfriction = "coulomb"\nmu_static = { values = [0.2, 0.4] }\nrestitution = { values = [0, '
        '0.5] }\n'
        '[design]\nrelease_angle = "190 deg"\n[numerics]\naudit = 1\n')
    with h5py.File(sweep(tmp_path, spec)) as m:
        assert m["jump_height"].shape == (2, 2) and m.attrs["audit_flag_mismatches"] == 0
        assert phases(m["phase_sequence"][1, 0]) == "RSRSRSSF"
        assert m["jump_height"][1, 0] == pytest.approx(0.912381, abs=1e-6)
        assert m["energy_lost"][1, 0] > 0 and m["slip_distance"][1, 0] > 0
    told = leapmap("info", tmp_path / "map.h5").stdout
    assert "RSRSRSSF" in told
    plan = leapmap("sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5", "--resume")
    assert plan.returncode == 0 and "complete already" in plan.stdout, plan.stderr


@pytest.mark.parametrize("method", ["exact", "gsl-rk8pd", "gsl-msbdf", "gsl-bsimp"])
def test_hop_names_every_phase_by_any_method(method):
    arguments = ("hop", "--set", "friction=coulomb", "--mu-static", 0.4, "--release-angle", "190deg", "--set",
                 f"method={method}", "--set", "tolerance=1e-9")
    told = leapmap(*arguments)
    assert told.returncode == 0, told.stdout + told.stderr
    assert "RSRSRSSF" in told.stdout, told.stdout + told.stderr
    assert "agrees" in told.stdout, told.stdout + told.stderr
    found = json.loads(leapmap(*arguments, "--json").stdout)
    assert found["phase_sequence"] == "RSRSRSSF" and found["jump_height"] == pytest.approx(0.912381, abs=2e-6)


def test_a_trace_shows_every_phase_on_one_continuous_motion(tmp_path):
    done = leapmap("hop", "--set", "friction=coulomb", "--mu-static", 0.4, "--trace", tmp_path / "trace.h5")
    assert done.returncode == 0, done.stderr
    with h5py.File(tmp_path / "trace.h5") as t:
        time, phase, angle, travel, y = (t[k][()] for k in ("t", "phase", "phi", "x", "y"))
        assert set(phase) == {1, 2, 3} and (np.diff(time) >= 0).all()
        assert np.abs(np.diff(angle)).max() < 0.2 and np.abs(np.diff(travel)).max() < 0.01
        assert (y[phase != 3] == 0).all() and (y[phase == 3] > -1e-12).all()
        sliding = phase == 2
        assert np.abs(np.abs(t["friction"][()][sliding]) - 0.4 * t["normal_force"][()][sliding]).max() < 1e-9
