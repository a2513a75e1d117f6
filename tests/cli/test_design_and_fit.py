# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap design and leapmap fit, as they are typed."""
import csv
import json
import os
import shlex
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest
from support.program import PROGRAM, TOP, leapmap, sweep

BOX = """
[design]
slope = { from = "5 deg", to = "30 deg" }
mass_ratio = { from = 0.5, to = 10, scale = "log" }
[goal]
jump_height = { at_least = 0.9 }
minimize = ["mass_ratio"]
"""
FEWER = ("--sample", "20000")


def asked(tmp_path, spec, *arguments):
    (tmp_path / "q.toml").write_text(spec)
    return leapmap("design", tmp_path / "q.toml", *FEWER, *arguments)


def test_the_answer_reaches_its_goals_by_its_own_hop_command(tmp_path):
    told = json.loads(asked(tmp_path, BOX, "--json").stdout)
    assert told["reached"] and told["designs"]
    for design in told["designs"]:
        words = design["hop"].split()
        hop = json.loads(
            subprocess.run([PROGRAM, *words[1:], "--json"], capture_output=True, text=True,
                           check=True).stdout)
        assert hop["jump_height"] >= 0.9, "never a hair short"
        assert hop["design"]["mass_ratio"] == design["parameters"]["mass_ratio"] == design["objectives"][
            "mass_ratio"]
    assert any("jump_height at least 0.9" in bind for bind in told["designs"][0]["binds"])


def test_the_command_told_asks_for_later_jumps_and_gaits_too(tmp_path):
    more = BOX + "[scene]\njumps = 3\n[gait]\nsettle = 60\nmost_period = 4\n"
    told = json.loads(asked(tmp_path, more, "--json").stdout)
    words = told["designs"][0]["hop"].split()
    hop = json.loads(
        subprocess.run([PROGRAM, *words[1:], "--json"], capture_output=True, text=True, check=True).stdout)
    assert "jump_height_3" in hop and "gait_period" in hop


def test_a_command_with_quotes_is_json_too(tmp_path):
    question = os.path.join(TOP, "sweeps", "questions", "surest.toml")
    told = json.loads(leapmap("design", question, "-o", tmp_path / "surest.h5", "--json", *FEWER).stdout)
    words = shlex.split(told["designs"][0]["hop"])
    assert "--scatter" in words
    done = subprocess.run([PROGRAM, *words[1:], "--json"], capture_output=True, text=True)
    assert done.returncode == 0 and json.loads(done.stdout)["scatter"]["yield"], done.stderr


def test_a_fit_says_which_given_values_it_fits_anew():
    events = os.path.join(TOP, "sweeps", "paper_events.csv")
    told = leapmap("fit", events, "--model", "sticking", "--set", "release_spin=0.5")
    assert told.returncode == 0 and "release_spin is fitted, so its value 0.5 is ignored" in told.stderr
    assert told.stderr.count("\n") == 1
    assert leapmap("fit", events, "--model", "sticking").stderr == ""


def test_people_are_told_what_binds_how_far_the_cliff_is_and_what_to_type(tmp_path):
    done = asked(tmp_path, BOX)
    assert done.returncode == 0
    for words in ("active constraints: jump_height at least 0.9", "nearest discontinuity:",
                  "a degree of slope", "leapmap hop --slope", "designs solved in"):
        assert words in done.stdout, done.stdout


def test_the_list_is_a_map_that_sweeps_and_charts_take(tmp_path):
    assert asked(tmp_path, BOX, "-o", tmp_path / "best.h5", "--csv", tmp_path / "best.csv").returncode == 0
    with h5py.File(tmp_path / "best.h5") as found:
        assert (found["jump_height"][()] >= 0.9).all() and (np.diff(found["mass_ratio"][()]) >=
                                                            0).all(), "best first"
        ratios = found["mass_ratio"][()]
        assert "minimize" in found.attrs["spec"]
    (tmp_path / "list.toml").write_text("")
    assert leapmap("sweep", tmp_path / "list.toml", "--points", tmp_path / "best.csv", "-o",
                   tmp_path / "again.h5").returncode == 0
    with h5py.File(tmp_path / "again.h5") as again:
        assert (again["mass_ratio"][()] == ratios).all()
    assert leapmap("check", tmp_path / "best.h5").returncode == 0
    chart = subprocess.run(
        ["/usr/bin/python3", TOP / "analysis/list_chart.py", tmp_path / "best.h5", "-o", tmp_path / "best"],
        capture_output=True, text=True)
    assert chart.returncode == 0, chart.stderr
    assert asked(tmp_path, BOX, "-o",
                 tmp_path / "best.h5").returncode == 0, "a list of an earlier search gives way"
    assert asked(
        tmp_path,
        BOX + f'[output]\nfile = "{tmp_path}/named.h5"\nfields = ["jump_height", "status"]\n').returncode == 0
    with h5py.File(tmp_path / "named.h5") as named:
        assert "jump_height" in named and "jump_time" not in named, "the spec's own output"


def test_what_no_search_wrote_is_not_replaced_and_that_is_said_before_anything_is_looked_for(tmp_path):
    map_file = sweep(tmp_path, "[design]\nslope = { from = 0.1, to = 0.5, count = 5 }\n")
    begin = time.monotonic()
    (tmp_path / "q.toml").write_text(BOX)
    done = leapmap("design", tmp_path / "q.toml", "-o", map_file, "--csv", tmp_path / "best.csv", "--sample",
                   "100000000")
    assert done.returncode == 2 and "map.h5" in done.stderr and done.stderr.count("\n") == 1
    assert time.monotonic() - begin < 5
    assert not (tmp_path / "best.csv").exists()
    assert asked(tmp_path, BOX, "-o", map_file, "--overwrite").returncode == 0


def test_no_design_that_does_it_is_an_answer_with_the_nearest_miss(tmp_path):
    done = asked(tmp_path, BOX.replace("0.9", "2.5"), "-o", tmp_path / "none.h5")
    assert done.returncode == 1 and not (tmp_path / "none.h5").exists()
    assert "No design within the bounds meets all goals" in done.stdout and "nearest miss" in done.stdout
    assert "leapmap hop" in done.stdout
    told = json.loads(asked(tmp_path, BOX.replace("0.9", "2.5"), "--json").stdout)
    assert not told["reached"] and len(told["designs"]) == 1 and 0.9 < told["missed"]["jump_height"] < 2.5
    made = BOX.replace(
        "[goal]",
        "[scatter]\nslope = { normal = \"3 deg\" }\nsamples = 64\n[goal]\nyield = { at_least = 0.9999 }")
    told = json.loads(asked(tmp_path, made.replace("0.9 }", "1.3 }"), "--json").stdout)
    assert not told[
        "reached"] and 0 < told["missed"]["yield"] < 0.9999, "a yield that is missed is told as well"


def test_two_objectives_give_a_front(tmp_path):
    done = asked(
        tmp_path,
        BOX.replace('minimize = ["mass_ratio"]', 'maximize = ["jump_height"]\nminimize = ["mass_ratio"]'),
        "-o", tmp_path / "front.h5")
    assert done.returncode == 0 and "front:" in done.stdout and "rectangle" in done.stdout
    with h5py.File(tmp_path / "front.h5") as front:
        assert len(front["jump_height"]) > 50
        assert (np.diff(front["jump_height"][()]) < 0).all() and (np.diff(front["mass_ratio"][()]) < 0).all()


def test_the_same_seed_says_the_same_and_another_one_nearly(tmp_path):
    one, two, other = (asked(tmp_path, BOX, "--json", "--seed", seed, "--threads", threads).stdout
                       for seed, threads in (("3", "1"), ("3", "2"), ("4", "2")))
    strip = lambda text: [(d["parameters"], d["objectives"]) for d in json.loads(text)["designs"]]
    assert strip(one) == strip(two)
    assert strip(one)[0][1]["mass_ratio"] == pytest.approx(strip(other)[0][1]["mass_ratio"], rel=1e-9)


@pytest.mark.parametrize("command",
                         [["sweep"], ["sweep", "--dry-run"], ["boundaries"], ["hop"], ["hop", "--scatter"]])
def test_other_commands_refuse_a_question(tmp_path, command):
    (tmp_path / "q.toml").write_text(BOX)
    done = leapmap(command[0], tmp_path / "q.toml", *command[1:],
                   *(["-o", tmp_path / "m.h5"] if command[0] in ("sweep", "boundaries") else []))
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "allowed" in done.stderr, done.stderr
    assert not (tmp_path / "m.h5").exists()


def test_bad_questions_are_refused_before_anything_is_looked_for(tmp_path):
    for change, word in ((BOX.replace("mass_ratio\"]", "mass\"]"), "mass"), (BOX.replace(
            'minimize = ["mass_ratio"]', ""), "maximize"), ("[goal]\nmaximize = [\"jump_height\"]", "free")):
        done = asked(tmp_path, change)
        assert done.returncode == 2 and done.stderr.count(
            "\n") == 1 and word in done.stderr and done.stdout == "", done.stderr
    (tmp_path / "q.toml").write_text(BOX)
    assert leapmap("design", tmp_path / "q.toml", "--csv", tmp_path / "q.toml").returncode == 2
    assert (tmp_path / "q.toml").read_text() == BOX


def test_a_yield_that_is_a_goal_is_told_with_its_error_and_binds(tmp_path):
    made = BOX.replace(
        "[goal]",
        "[scatter]\nslope = { normal = \"1 deg\" }\nsamples = 64\n[goal]\nyield = { at_least = 0.9 }")
    design = json.loads(asked(tmp_path, made, "--json").stdout)["designs"][0]
    yields = design["yield"]  # of fresh samples: the goal holds on those of the search
    assert yields["value"] >= 0.9 - 3 * yields["error"] and yields["error"] > 0
    assert any(bind.startswith("yield at least") for bind in design["binds"])
    told = asked(tmp_path, made).stdout
    assert "from 64 fresh manufactured hoops" in told
    command = next(line.strip() for line in told.splitlines() if line.strip().startswith("leapmap hop"))
    hop = subprocess.run(f"{PROGRAM} {command.removeprefix('leapmap ')} --json", shell=True,
                         capture_output=True, text=True)
    assert json.loads(
        hop.stdout
    )["scatter"]["yield"]["value"] == design["yield"]["value"], "the command tells the same, hoop by hoop"


def test_objectives_may_be_one_name_and_a_goal_on_a_parameter_says_where_it_belongs(tmp_path):
    assert asked(tmp_path, BOX.replace('minimize = ["mass_ratio"]', 'minimize = "mass_ratio"'),
                 "--quiet").returncode == 0
    done = asked(tmp_path, BOX + 'slope = { at_most = "10 deg" }\n')
    assert done.returncode == 2 and "is a parameter" in done.stderr and "[design]" in done.stderr


def test_ctrl_c_ends_a_search_and_writes_nothing(tmp_path):
    (tmp_path / "q.toml").write_text(BOX)
    running = subprocess.Popen(
        [PROGRAM, "design", tmp_path / "q.toml", "--sample", "20000000", "-o", tmp_path / "m.h5"],
        stderr=subprocess.PIPE)
    time.sleep(0.7)
    running.send_signal(signal.SIGINT)
    assert running.wait(timeout=20) == 130 and not (tmp_path / "m.h5").exists()


def film(path, error=0.0, **design):
    told = leapmap("hop", "--trace", path.with_suffix(".h5"),
                   *(w for k, v in design.items() for w in (f"--{k.replace('_', '-')}", str(v))))
    assert told.returncode == 0, told.stderr
    with h5py.File(path.with_suffix(".h5")) as trace:
        t, first = np.unique(trace["t"][()], return_index=True)
        phi = trace["phi"][()][first] + error * np.random.default_rng(1).standard_normal(len(t))
    path.write_text("t,phi\n" + "".join(f"{a!r},{b!r}\n" for a, b in zip(t.tolist(), phi.tolist())))
    return path


def test_a_film_of_angles_tells_its_release_and_its_friction(tmp_path):
    path = film(tmp_path / "film.csv", 1e-3, friction="coulomb", mu_static=0.45, release_angle="192deg",
                release_spin=0.1)
    told = json.loads(leapmap("fit", path, "--json", "--csv", tmp_path / "fit.csv").stdout)
    best = told["models"][0]
    assert best["friction"] == "coulomb"
    for name, truth in (("release_angle", np.radians(192)), ("release_spin", 0.1), ("mu_static", 0.45)):
        parameter = best["parameters"][name]
        assert abs(parameter["value"] - truth) < 4 * parameter["error"] < 0.05, (name, parameter)
    assert best["error"] == pytest.approx(1e-3, rel=0.15)
    rows = list(csv.DictReader((tmp_path / "fit.csv").open()))
    assert len(rows) == len(best["residuals"])
    assert {"t", "quantity", "measured", "model_coulomb", "residual_sticking"} <= rows[0].keys()
    chart = subprocess.run(
        ["/usr/bin/python3", TOP / "analysis/fit_chart.py", tmp_path / "fit.csv", "-o", tmp_path / "fit"],
        capture_output=True, text=True)
    assert chart.returncode == 0 and (tmp_path / "fit.png").stat().st_size > 10_000, chart.stderr


# Both models take tens of seconds, mostly for friction.
MODELS = pytest.mark.parametrize(
    "flags", [["--model", "sticking"], pytest.param([], marks=pytest.mark.slow)], ids=["sticking", "both"])


@MODELS
def test_people_are_told_estimates_errors_correlations_and_which_model_the_data_prefer(flags, tmp_path):
    done = leapmap("fit", film(tmp_path / "film.csv", 1e-3), *flags)
    assert done.returncode == 0
    for words in ("release_angle", "+-", "fixed: slope 22.9183 deg", "correlations", "residuals",
                  "leapmap hop --slope"):
        assert words in done.stdout, done.stdout
    assert ('clearly prefer "sticking"' in done.stdout) == (not flags)


@MODELS
def test_a_hoop_that_is_not_the_films_is_told_as_no_explanation(flags, tmp_path):
    path = film(tmp_path / "film.csv", 1e-3, slope="20deg")
    done = leapmap("fit", path, *flags)
    assert done.returncode == 0, done.stdout
    assert "does not explain" in done.stdout, done.stdout
    assert "prefer" not in done.stdout, done.stdout
    assert flags or "Neither model explains" in done.stdout, done.stdout
    free = json.loads(
        leapmap("fit", path, "--set", "slope={from=0.3,to=0.5}", "--set", "release_spin={from=-0.1,to=0.1}",
                "--model", "sticking", "--json").stdout)
    assert free["models"][0]["explains"]
    assert free["models"][0]["parameters"]["slope"]["value"] == pytest.approx(np.radians(20), abs=1e-3)


@MODELS
def test_the_papers_events_are_fitted(flags):
    done = leapmap("fit", TOP / "sweeps/paper_events.csv", "--json", *flags)
    models = {model["friction"]: model for model in json.loads(done.stdout)["models"]}
    assert models["sticking"]["degrees"] == 2 and 8 < models["sticking"]["chi_square"] < 9.5
    if flags:
        return
    assert models["coulomb"]["chi_square"] < models["sticking"]["chi_square"]
    assert not models["coulomb"]["parameters"]["mu_static"][
        "identified"], "four numbers do not tell three parameters of a ridge"


def test_wrong_measurements_are_one_line_and_exit_2(tmp_path):
    for text, word in (("t,phi\n0,1\n0.002,1\n0.001,1\n", "ascend"), ("t,phi\n0,nan\n1,2\n2,2\n", "three"),
                       ("t,phi\n0,100\n0.001,101\n0.002,102\n", "degrees")):
        (tmp_path / "bad.csv").write_text(text)
        done = leapmap("fit", tmp_path / "bad.csv")
        assert done.returncode == 2 and done.stderr.count(
            "\n") == 1 and word in done.stderr and "bad.csv" in done.stderr, done.stderr
    assert leapmap("fit", tmp_path / "none.csv").returncode == 2
    for flags, word in ((["--scale", "0.1"], "--scale"), (["--error", "0.1"], "--error"), ([
            "--set", "goal.jump_height={at_least=1}"
    ], "[goal]"), (["--set", "slope={values=[0.3,0.4,0.5]}"], "list of values"), ([
            "--set", "slope={values=[0.4]}"
    ], "0.4"), (["--set", "scatter.slope={normal=0.1}"], "[scatter]"), (["--set",
                                                                         "method=gsl-rk4"], "exact")):
        done = leapmap("fit", TOP / "sweeps/paper_events.csv", *flags)
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and word in done.stderr, done.stderr


def test_a_film_that_begins_late_wants_bounds_of_the_release(tmp_path):
    path = film(tmp_path / "film.csv")
    lines = path.read_text().splitlines()
    (tmp_path / "late.csv").write_text("\n".join([lines[0], *lines[100:]]) + "\n")
    done = leapmap("fit", tmp_path / "late.csv")
    assert done.returncode == 2 and "begins at" in done.stderr and "release_angle" in done.stderr, done.stderr
    free = ["--set", "release_angle={from=3.0,to=3.3}", "--set", "release_spin={from=-0.1,to=0.2}"]
    told = json.loads(
        leapmap("fit", tmp_path / "late.csv", *free, "--model", "sticking", "--error", "1e-3",
                "--json").stdout)["models"][0]
    assert told["parameters"]["release_angle"]["value"] == pytest.approx(np.pi, abs=1e-3)


@pytest.mark.parametrize("release",
                         [pytest.param([], marks=pytest.mark.slow), ["--set", "release_spin=0.05"]],
                         ids=["free", "given"])
def test_friction_that_is_given_stays_as_it_is_given(release):
    fit = [
        "fit", TOP / "sweeps/paper_events.csv", "--model", "coulomb", "--json", "--set",
        "mu_static={from=0.3,to=1}", *release
    ]
    given = json.loads(leapmap(*fit, "--set", "mu_kinetic=0.3").stdout)["models"][0]
    assert "--mu-kinetic 0.3" in given["hop"]
    follows = json.loads(leapmap(*fit).stdout)["models"][0]
    assert "--mu-kinetic" not in follows["hop"]


def test_a_model_with_too_many_free_parameters_leaves_the_other(tmp_path):
    (tmp_path / "two.csv").write_text("event,value,error\njump_time,0.54,0.01\njump_height,0.98,0.02\n")
    models = {
        model["friction"]: model
        for model in json.loads(leapmap("fit", tmp_path / "two.csv", "--json").stdout)["models"]
    }
    assert models["sticking"]["found"] and not models["coulomb"]["found"]
    assert "2 numbers for 3 free parameters" in leapmap("fit", tmp_path / "two.csv").stdout


@pytest.mark.parametrize("friction", ["sticking", pytest.param("coulomb", marks=pytest.mark.slow)])
def test_markers_in_pixels_that_count_downwards_are_read_with_their_scale(friction, tmp_path):
    path = film(tmp_path / "film.csv", friction=friction, release_angle="192deg",
                **({"mu_static": 0.45} if friction == "coulomb" else {}))
    with h5py.File(path.with_suffix(".h5")) as trace:
        t, first = np.unique(trace["t"][()], return_index=True)
        phi, x, y = (trace[n][()][first] for n in ("phi", "x", "y"))
    metre, radius = 5000.0, 0.041  # pixels
    columns = [x - radius * np.sin(phi), y - radius * np.cos(phi), x, y]
    pixels = [100 + metre * c if k % 2 == 0 else 900 - metre * c for k, c in enumerate(columns)]
    (tmp_path / "pixels.csv").write_text("t,x_P,y_P,x_O,y_O\n" +
                                         "".join(",".join(map(repr, map(float, row))) + "\n"
                                                 for row in zip(t, *pixels)))
    name, truth = ("mu_static", 0.45) if friction == "coulomb" else ("release_angle", np.radians(192))
    for flags in (["--scale", "0.0002", "--y-down"], []):
        told = json.loads(
            leapmap("fit", tmp_path / "pixels.csv", *flags, "--model", friction, "--json").stdout)
        found = told["models"][0]["parameters"]
        assert found[name]["value"] == pytest.approx(truth, abs=1e-6)
        assert ("scale" in found) == (not flags)
    assert found["scale"]["value"] == pytest.approx(1 / metre, rel=1e-6)
