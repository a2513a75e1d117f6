# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields that maps hold only if they are named are told, and may be asked for, everywhere else."""
import json

import pytest
from support.program import leapmap

FIELDS = ("jump_range", "landing_normal_speed", "landing_tangential_speed", "landing_impulse",
          "landing_energy_lost")
MODELS = pytest.mark.parametrize("friction", ["sticking", "coulomb"])


def told(*arguments):
    done = leapmap(*arguments, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@MODELS
def test_hop_has_them_and_their_derivatives(friction):
    hoop = ("hop", "--friction", friction, "--slope", "0.4", "--mass-ratio", "3")
    numbers = told(*hoop)
    assert numbers["status"] == "jumped"
    assert all(isinstance(numbers[field], float) for field in FIELDS)
    table = leapmap(*hoop, "--gradient").stdout
    assert all(field in table for field in FIELDS)


@MODELS
def test_a_map_that_stores_them_tells_them_of_a_place(friction, tmp_path):
    path = tmp_path / "map.h5"
    done = leapmap("sweep", "-o", path, "--set", f"friction={friction}", "--set",
                   "slope={from=0.3,to=0.5,count=9}", "--set", f"fields={json.dumps(['status', *FIELDS])}")
    assert done.returncode == 0, done.stderr
    words = leapmap("info", path, "--at", "slope=0.4").stdout
    assert all(field in words for field in FIELDS)


@MODELS
def test_a_design_has_them_as_goal_and_objective(friction, tmp_path):
    (tmp_path / "q.toml").write_text(f'''[scene]
friction = "{friction}"
[design]
slope = {{ from = 0.2, to = 0.5 }}
[goal]
landing_impulse = {{ at_most = 1.5 }}
maximize = ["jump_range"]
''')
    best = told("design", tmp_path / "q.toml", "--sample", "4096")["designs"][0]
    assert best["objectives"]["jump_range"] == best["fields"]["jump_range"] > 0
    assert best["fields"]["landing_impulse"] <= 1.5


@MODELS
def test_a_fit_takes_them_as_events(friction, tmp_path):
    truth = told("hop", "--friction", friction, "--slope", "0.42")
    rows = [f"{name},{truth[name]!r},0.001" for name in ("jump_range", "landing_normal_speed", "jump_height")]
    (tmp_path / "events.csv").write_text("\n".join(["event,value,error", *rows]) + "\n")
    (tmp_path / "spec.toml").write_text("[design]\nslope = { from = 0.38, to = 0.46 }\n")
    done = leapmap("fit", tmp_path / "events.csv", tmp_path / "spec.toml", "--model", friction, "--json")
    assert done.returncode == 0, done.stderr
    slope = json.loads(done.stdout)["models"][0]["parameters"]["slope"]["value"]
    assert slope == pytest.approx(0.42, abs=1e-3)
