# SPDX-License-Identifier: GPL-3.0-or-later
"""A hoop with a driven pendulum on the command line: hop, traces, maps, searches, tolerances, fits."""
import json

import h5py
import numpy as np
from support.program import TOP, leapmap, scripted, sweep

ROBOT = ["--model", "pendulum", "--slope", "0", "--mass-ratio", "3", "--motor-torque", "2"]


def hop(*words):
    result = leapmap("hop", *words, "--json")
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def test_hop_tells_the_jump_and_what_the_motor_gave():
    told = hop(*ROBOT)
    assert told["scene"]["model"] == "pendulum" and told["method"] == "gsl-rk8pd"
    assert told["status"] == "jumped" and told["motor_max_torque"] == 2.0
    assert abs(told["efficiency"] - 2 * told["jump_height"] / told["motor_energy"]) < 1e-14
    # Without friction's losses all work is energy, of which the flight's is not more than there is.
    assert 0 < told["efficiency"] < 1
    text = leapmap("hop", *ROBOT).stdout
    assert "gsl-rkck at 1e-12 agrees" in text and "Reference solver: within" in text


def test_units_of_a_target_are_an_angles():
    base = [*ROBOT, "--motor-law", "until_angle", "--motor-target"]
    assert hop(*base, "90 deg") == hop(*base, str(np.pi / 2))


def test_what_one_model_lacks_is_refused_in_one_line():
    for words, why in [
        (["--motor-torque", "1"], "the model is hoop; allowed: with model = \"pendulum\""),
        (["--model", "pendulum", "--drive-torque", "1"], "is pendulum; allowed: with model = \"hoop\""),
        (["--model", "pendulum", "--set", "clear_height=0.2"], "the model is pendulum"),
        (["--model", "pendulum", "--gradient"], "needs derivatives, which the model \"pendulum\" lacks"),
        (["--model", "pendulum", "--prove"], "nothing can be proved of a pendulum"),
        (["--model", "pendulum", "--set", "method=exact"], "no semi-analytic solver"),
        (["--model", "wheel"], "'wheel' is unknown"),
        (["--model", "pendulum", "--motor-target", "1"], "has no effect with motor_law = \"constant\""),
        (["--model", "pendulum", "--set", "jumps=3"], "jumps that begin at a landing"),
        ([TOP / "sweeps/drawing.toml", "--model", "pendulum"], "fixed to the ring"),
        (["--model", "pendulum", "--motor-law", "angle"], "motor_gain"),
    ]:
        refused = leapmap("hop", *words)
        assert refused.returncode == 2 and why in refused.stderr and refused.stderr.count("\n") == 1, words


def test_a_trace_holds_the_pendulum_and_its_energy_is_the_motors_work(tmp_path):
    trace = tmp_path / "robot.h5"
    told = leapmap("hop", *ROBOT, "--set", "radius=1", "--set", "gravity=1", "--trace", trace,
                   "--trace-interval", "0.01", "--json")
    assert told.returncode == 0, told.stderr
    with h5py.File(trace) as m:
        t, phi, w, x, y = (m[name][()] for name in ("t", "phi", "spin", "x", "y"))
        psi, u, torque = (m[name][()] for name in ("pendulum_angle", "pendulum_spin", "motor_torque"))
    alpha, hub = 0.75, 0.25
    assert (torque == 2.0).all() and (np.diff(t) >= 0).all()
    contact = y == 0
    # the kinetic energy of rolling, and the weight's
    energy = 0.5 * ((1 + hub) * w**2 + alpha * u**2 - 2 * alpha * np.cos(psi) * u * w) - alpha * np.cos(psi)
    work = torque * ((psi - psi[0]) - (phi - phi[0]))
    assert np.abs((energy - energy[0] - work)[contact]).max() < 1e-8
    assert scripted("trace_chart.py", trace, "-o", tmp_path / "robot.png").returncode == 0


def test_a_map_is_audited_by_two_steppers_and_the_referee_and_drawn(tmp_path):
    for friction in ("sticking", "coulomb"):
        path = sweep(
            tmp_path, f"""
[scene]
model = "pendulum"
friction = "{friction}"
[design]
slope = 0.0
mass_ratio = 3.0
motor_law = "until_angle"
motor_target = "200 deg"
no_load_speed = 8.0
offset_ratio = {{ from = 0.4, to = 1.0, count = 6 }}
motor_torque = {{ from = 0.2, to = 2.0, count = 6 }}
[numerics]
audit = 0.3
[output]
fields = ["jump_height", "jump_time", "status", "candidates", "spurious_first_jump", "motor_energy",
          "motor_max_power", "motor_max_spin", "motor_max_torque", "efficiency", "max_normal_force"]
""", name=f"{friction}.h5")
        with h5py.File(path) as m:
            assert m.attrs["audit_designs"] > 5 and m.attrs["audit_flag_mismatches"] == 0
            assert m.attrs["audit_max_abs_height_error"] < 1e-8
            jumped = m["status"][()] == 1
            assert jumped.sum() > 10
            assert (m["motor_max_torque"][()][jumped] <= m["motor_torque"][()][None, :].repeat(6, 0)[jumped]
                    * (1 + m["motor_max_spin"][()][jumped] / 8) * (1 + 1e-12)).all()
        checked = leapmap("check", path, "--sample", "8")
        assert checked.returncode == 0 and "right" in checked.stdout
        assert scripted("phase_diagram.py", path, "-o", tmp_path / "map.png").returncode == 0
        page = scripted("explorer", path, "-o", tmp_path / "map.html")
        assert page.returncode != 0 and "has no solver of pendulums" in page.stderr


def test_a_map_depends_on_its_spec_alone_and_its_designs_can_be_solved_again(tmp_path):
    text = """
[scene]
model = "pendulum"
[design]
slope = 0.0
motor_torque = { from = 0.2, to = 2.0, count = 40 }
motor_law = "until_speed"
motor_target = 4.0
"""
    one = sweep(tmp_path, text, "--threads", "1", name="one.h5")
    two = sweep(tmp_path, text, "--threads", "2", name="two.h5")
    with h5py.File(one) as a, h5py.File(two) as b:
        for name in a:
            if isinstance(a[name], h5py.Dataset):
                assert a[name][()].tobytes() == b[name][()].tobytes(), name
        spec = a.attrs["spec"]
        torque, height = a["motor_torque"][30], a["jump_height"][30]
    assert "model = 'pendulum'" in spec and "drive_torque" not in spec and "no_load_speed = inf" in spec
    again = hop("--model", "pendulum", "--slope", "0", "--motor-law", "until_speed", "--motor-target", "4",
                "--motor-torque", repr(float(torque)))
    assert again["jump_height"] == height


def test_a_search_finds_the_timing_of_the_brake(tmp_path):
    best = tmp_path / "best.h5"
    found = leapmap("design", TOP / "sweeps/questions/pendulum.toml", "-o", best, "--sample", "512")
    assert found.returncode == 0, found.stderr
    with h5py.File(best) as m:
        # carried over the top as fast as the motor can: faster than sqrt((m + m_p) g / (m_p L))
        assert abs(m["jump_height"][0] - 0.356) < 1e-3 and abs(m["offset_ratio"][0] - 0.568) < 0.01


def test_tolerances_and_fits_work_without_derivatives(tmp_path):
    spec = tmp_path / "robot.toml"
    spec.write_text("""
[scene]
model = "pendulum"
[design]
slope = 0.0
mass_ratio = 3.0
motor_torque = 2.0
[tolerances]
mass_ratio = { normal = "2 %" }
motor_torque = { uniform = "5 %" }
[goal]
jump_height = { at_least = 1.3 }
""")
    made = leapmap("hop", spec, "--scatter", "--json")
    assert made.returncode == 0, made.stderr
    assert 0 < json.loads(made.stdout)["scatter"]["yield"]["value"] < 1

    truth = hop(*ROBOT, "--pendulum-angle", "0.4")
    events = tmp_path / "events.csv"
    events.write_text("event,value,error\n" + "".join(
        f"{name},{truth[name]!r},{error}\n" for name, error in
        (("jump_time", 1e-4), ("jump_height", 1e-3), ("apex_time", 1e-4), ("jump_distance", 1e-3))))
    fitted = leapmap("fit", events, "--model", "sticking", "--set", "model=pendulum", "--set", "slope=0",
                     "--set", "mass_ratio=3", "--set", "motor_torque={from=1,to=3}", "--set",
                     "pendulum_angle={from=-1,to=1}", "--json")
    assert fitted.returncode == 0, fitted.stderr
    told = json.loads(fitted.stdout)
    found = (told["models"] if "models" in told else told["fits"])[0]["parameters"]
    assert abs(found["motor_torque"]["value"] - 2.0) < 1e-3
    assert abs(found["pendulum_angle"]["value"] - 0.4) < 1e-3
