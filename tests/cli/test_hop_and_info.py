# SPDX-License-Identifier: GPL-3.0-or-later
"""`leapmap hop` and `leapmap info` tell what is true."""
import json
import math

import h5py
import numpy as np
import pytest
from support.program import TOP, leapmap, sweep


def test_hop_tells_the_papers_jump():
    done = leapmap("hop", TOP / "sweeps/paper.toml")
    assert done.returncode == 0
    for number in ("0.982801", "0.131666", "0.200146", "0.003444", "799.2044"):
        assert number in done.stdout


def test_json_is_nothing_but_data_under_the_maps_names():
    done = leapmap("hop", "--json", "--set", "radius=1", "--set", "gravity=1", "--set", "tolerance=1e-12")
    hop = json.loads(done.stdout)
    assert done.stderr == ""
    assert hop["status"] == "jumped" and hop["spurious_first_jump"] == 1 and hop["candidates"] == 2
    assert hop["jump_time"] == pytest.approx(8.3639138031881432, abs=1e-11)
    assert hop["jump_height"] == pytest.approx(0.98280096607011718, abs=1e-11)
    assert len(hop["lift_offs"]) == 2
    stalled = json.loads(leapmap("hop", "--json", "--slope", "1deg", "--release-angle", "20deg").stdout)
    assert stalled["status"] == "stalled" and stalled["jump_height"] is None
    assert stalled["spurious_first_jump"] is None


@pytest.mark.parametrize("friction", ["sticking", "coulomb"])
def test_json_holds_any_number_of_jumps(friction):
    for jumps in (1, 2, 4, 18, 20):  # each adds two members to the object
        hop = json.loads(
            leapmap("hop", "--friction", friction, "--jumps", jumps, "--set", "gait.settle=10",
                    "--json").stdout)
        assert len(hop["lift_offs"]) >= 1 and f"jump_height_{max(jumps, 2)}" in hop or jumps == 1
        assert list(hop)[-3:] == ["grazes", "check", "phases"]


def test_every_parameter_has_a_flag_that_beats_the_spec():
    hop = json.loads(
        leapmap("hop", TOP / "sweeps/paper.toml", "--json", "--slope", "30deg", "--mass-ratio", "3",
                "--offset-ratio", "0.9", "--inertia-factor", "0.8", "--release-angle", "170 deg",
                "--release-spin", "0.1", "--drive-torque", "0.2", "--resisting-torque", "0.01").stdout)
    assert hop["design"] == pytest.approx({
        "slope": math.radians(30), "mass_ratio": 3, "offset_ratio": 0.9, "inertia_factor": 0.8,
        "release_angle": math.radians(170), "release_spin": 0.1, "drive_torque": 0.2,
        "resisting_torque": 0.01
    })


def test_a_driven_hoop_is_told_with_what_its_motor_must_have():
    driven = ["hop", "--slope", "0", "--release-angle", "0", "--drive-torque", "0.6", "--mass-ratio", "3"]
    hop = json.loads(leapmap(*driven, "--mass", "0.1", "--json").stdout)
    motor, R, g = hop["motor"], 0.041, 9.81
    assert hop["status"] == "jumped" and motor["torque"] == pytest.approx(0.6 * 0.1 * g * R)
    # Rolling without slip it works all the way to the lift-off: torque times angle, but for the last of 4,000
    # samples.
    assert motor["work"] == pytest.approx(motor["torque"] * hop["jump_angle"], rel=2e-3)
    fastest = max(abs(f["spin"]) for f in hop["lift_offs"]) / math.sqrt(R / g)
    assert motor["rpm"] >= 0.999 * fastest * 30 / math.pi
    assert motor["power"] == pytest.approx(motor["torque"] * motor["rpm"] * math.pi / 30)
    twice = json.loads(leapmap(*driven, "--mass", "0.2", "--json").stdout)["motor"]
    assert twice["torque"] == pytest.approx(2 * motor["torque"]) and twice["rpm"] == motor["rpm"]
    weighed = leapmap(*driven, "--mass", "100 g").stdout
    assert "Motor until the lift-off, for a total mass of 0.1 kg: " in weighed
    weighed, pure = leapmap("hop", "--mass", "0.1").stdout, leapmap("hop").stdout
    assert " N s, " in weighed and " J lost" in weighed and " N s" not in pure and " J " not in pure
    assert "motor" not in json.loads(leapmap("hop", "--json").stdout)


def test_a_hop_is_what_the_map_says_of_the_same_design(tmp_path):
    path = sweep(tmp_path)
    with h5py.File(path) as m:
        for i, j, k in [(3, 5, 1), (11, 10, 0), (7, 2, 1)]:
            hop = json.loads(
                leapmap("hop", "--json", "--slope", repr(float(m["slope"][i])), "--mass-ratio",
                        repr(float(m["mass_ratio"][j])), "--offset-ratio",
                        repr(float(m["offset_ratio"][k]))).stdout)
            for name in ("jump_height", "jump_time", "jump_angle", "apex_time", "dip", "first_jump_time"):
                stored = m[name][i, j, k]
                # times share their number of nodes with the tile's other designs: 1e-12, and the same digits
                # else
                same = abs(hop[name] / stored -
                           1) < 1e-12 if name.endswith("_time") and hop[name] else hop[name] == stored
                assert same or (hop[name] is None and np.isnan(stored)), name


def test_a_trace_holds_the_motion_from_release_to_landing(tmp_path):
    done = leapmap("hop", TOP / "sweeps/paper_figures.toml", "--trace", tmp_path / "trace.h5", "--json")
    hop = json.loads(done.stdout)
    with h5py.File(tmp_path / "trace.h5") as trace:
        assert trace.attrs["filetype"] == "leapmap trace"
        t, phi, x, y, n, phase = (trace[k][()] for k in ("t", "phi", "x", "y", "normal_force", "phase"))
        assert {"t", "phi", "spin", "x", "y", "normal_force", "friction", "phase"} <= set(trace)
        assert t[0] == 0 and t[-1] == pytest.approx(hop["jump_time"] + hop["flight_time"], rel=1e-12)
        rolling = phase == 1
        assert np.allclose(x[rolling], 0.041 * (phi[rolling] - phi[0]), atol=1e-15)
        assert (y[rolling] == 0).all() and (n[~rolling] == 0).all()
        assert y.max() / 0.082 == pytest.approx(hop["jump_height"], abs=1e-4)  # sampled every millisecond
        assert list(trace["candidate_time"]) == pytest.approx([0.17, 0.32], abs=1e-6)
        assert dict(enumerate(trace["phase"].attrs["flag_meanings"].split(), 1))[3] == "flight"


def test_info_counts_statuses_and_places_extremes(tmp_path):
    path = sweep(tmp_path)
    text = leapmap("info", path).stdout
    with h5py.File(path) as m:
        height = m["jump_height"][()]
        i, j, k = np.unravel_index(np.nanargmax(height), height.shape)
        assert f"{(m['status'][()] == 1).sum()}" in text
        place = (f"at slope {m['slope'][i]:.6g}, mass_ratio {m['mass_ratio'][j]:.6g}, offset_ratio "
                 f"{m['offset_ratio'][k]:.6g}")
        assert f"most  {height[i, j, k]:.8g}" in text and place in text
        assert f" ({82 * height[i, j, k]:.4g} mm) at slope" in text  # of the paper's hoop
        assert f"none  in {np.isnan(height).sum()} designs" in text
    assert "check    14 designs" in text  # 5 % of 264, rounded up
    assert leapmap("info", path, "--spec").stdout.startswith("[scene]")  # a TOML and nothing else


@pytest.mark.parametrize("make,word", [(lambda p: None, "No such file"),
                                       (lambda p: p.write_text("words"), "cannot be read as HDF5"),
                                       (lambda p: h5py.File(p, "w").close(), "not a leapmap map")])
def test_info_refuses_other_files_with_one_line(make, word, tmp_path):
    make(tmp_path / "x.h5")
    done = leapmap("info", tmp_path / "x.h5")
    assert done.returncode == 3 and done.stderr.count("\n") == 1 and word in done.stderr and done.stdout == ""


def test_info_refuses_maps_with_odd_dimensions_or_attributes(tmp_path):
    def attributes(file, filetype="leapmap map"):
        file.attrs["filetype"], file.attrs["version"] = filetype, np.array([1, 0], dtype="i4")

    def scale(file, name, data):
        file[name] = data
        file[name].make_scale(name)
        file[name].attrs["units"] = "1"

    odd = {
        "none": lambda f: attributes(f), "two_types": lambda f: attributes(f, ["leapmap map", "leapmap map"]),
        "scalar": lambda f: (attributes(f), scale(f, "a", 1.0)), "square": lambda f:
        (attributes(f), scale(f, "a", np.ones(
            (3, 3)))), "empty": lambda f: (attributes(f), scale(f, "a", np.ones(0))),
        "scalar_field": lambda f: (attributes(f), scale(f, "a", np.ones(2)), f.create_dataset("x", data=1.0))
    }
    for name, make in odd.items():
        with h5py.File(tmp_path / f"{name}.h5", "w") as file:
            make(file)
        done = leapmap("info", tmp_path / f"{name}.h5")
        assert done.returncode == 3 and done.stderr.count("\n") == 1, (name, done)


def test_json_is_valid_whatever_the_units(tmp_path):
    done = leapmap("hop", "--json", "--set", "radius=1e9", "--set", "gravity=1e-9")
    assert json.loads(done.stdout)["status"] == "jumped"
    assert leapmap("hop", "--set", "radius=1e308").returncode == 2


def test_dry_run_plans_and_writes_nothing(tmp_path):
    (tmp_path / "spec.toml").write_text(
        '[design]\nslope={from=0,to=1,count=1000}\nmass_ratio={from=0.1,to=20,count=1000}\n'
        'offset_ratio={from=0.3,to=1,count=1000}\n[output]\nfields=["jump_height","spurious_first_jump"]\n')
    done = leapmap("sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5", "--dry-run")
    assert done.returncode == 0
    for words in ("1,000,000,000", "memory   at most", "file     about 9 GB", "time     about", "chunks"):
        assert words in done.stdout
    assert not list(tmp_path.glob("map.h5*"))


@pytest.mark.parametrize(
    "scene, design", [("coulomb", ("--mass-ratio", "1.0583892617449666", "--slope", "0.09384433666502173")),
                      ("never", ("--mass-ratio", "2.4", "--slope", "23 deg", "--set", "runway=2"))])
def test_a_first_jump_that_lands_beyond_the_runway_is_the_last(scene, design):
    words = ("hop", *design, "--jumps", "4", "--json",
             *(["--set", "friction=coulomb"] if scene == "coulomb" else []))
    done = leapmap(*words)
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["status"] == "jumped" and told["jumps"] == 1 and told["sequence_end"] == "no_jump"
    assert told["jump_height_2"] is None


def test_help_teaches_and_version_is_told():
    assert "slope" in leapmap("sweep", "--help").stdout and leapmap("--help").returncode == 0
    assert leapmap("--version").stdout.startswith("leapmap ")


def test_an_audit_that_disagrees_ends_with_status_1_and_the_command_that_shows_it(tmp_path):
    (tmp_path / "spec.toml").write_text(
        '[design]\nslope={from=0.1,to=0.8,count=40}\nmass_ratio={from=0.5,to=10,count=40}\n'
        '[numerics]\nmethod="gsl-rk8pd"\ntolerance=3e-3\naudit=1\n')
    done = leapmap("sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5", "--quiet")
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    command = done.stderr.split("show it: leapmap ")[1].split()
    ours = json.loads(leapmap(*command, "--json").stdout)
    truth = json.loads(leapmap(*command, "--json", "--set", "tolerance=1e-12").stdout)
    assert any(ours[k] != truth[k] for k in ("status", "spurious_first_jump", "candidates"))
    with h5py.File(tmp_path / "map.h5") as m:
        assert m.attrs["audit_flag_mismatches"] > 0


def test_models_are_compared_on_one_file_which_says_what_one_of_them_does_not_use(tmp_path):
    (tmp_path / "spec.toml").write_text(
        '[scene]\nfriction = "coulomb"\nmu_static = 0.6\nrestitution = 0.2\nrest_speed = 0.01\n[design]\n'
        'slope = 0.5\n'
    )
    done = leapmap("hop", tmp_path / "spec.toml", "--set", "friction=sticking", "--json")
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("\n") == 1 and "mu_static, restitution, rest_speed" in done.stderr
    assert "not used" in done.stderr and "never slips" in done.stderr
    assert json.loads(done.stdout)["jump_height"] == json.loads(
        leapmap("hop", "--slope", "0.5", "--json").stdout)["jump_height"]
    for given in (("--mu-static", "0.5"), ("--set", "restitution=0.1")):  # on the command line both are meant
        done = leapmap("hop", tmp_path / "spec.toml", "--set", "friction=sticking", *given)
        assert done.returncode == 2 and "has no effect" in done.stderr, done.stderr
    (tmp_path / "spec.toml").write_text('[scene]\nmu_static = 0.6\n')
    assert leapmap("hop", tmp_path / "spec.toml").returncode == 2, "nobody chose another model"
    (tmp_path / "spec.toml").write_text(
        '[scene]\nfriction = "coulomb"\nmu_static = { values = [0.3, 0.6] }\n')
    done = leapmap("sweep", tmp_path / "spec.toml", "--set", "friction=sticking", "-o", tmp_path / "m.h5")
    assert done.returncode == 2 and "has no effect" in done.stderr, "an axis cannot be left out"
