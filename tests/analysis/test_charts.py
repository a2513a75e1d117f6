# SPDX-License-Identifier: GPL-3.0-or-later
"""The charts, drawn from small maps and read back from their SVG: what they must contain, not merely that
they exist."""
import json
import os
import re
import sys
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np
import pytest
from matplotlib import image
from matplotlib.colors import to_rgb
from support.program import TOP, finished, leapmap, scripted, sweep

CHART = """
[design]
slope = { from = "2 deg", to = "50 deg", count = 60 }
mass_ratio = { from = 0.1, to = 20, count = 60, scale = "log" }
offset_ratio = { values = [0.7, 1.0] }
[numerics]
tolerance = 1e-6
"""


def draw(script, *arguments):
    return scripted(script, *arguments, formats=["svg"])


def texts(svg):
    return [t.text or "" for t in ElementTree.parse(svg).iter("{http://www.w3.org/2000/svg}text")]


@pytest.fixture(scope="module")
def charts(tmp_path_factory):
    folder = tmp_path_factory.mktemp("charts")
    done = scripted("design_chart.py", sweep(folder, CHART), "-o", folder / "chart")
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [
        f"{folder}/chart_{f}.{e}" for f in ("jump_height", "jump_time", "agility")
        for e in ("png", "svg", "pdf")
    ]
    return folder


def test_a_chart_of_a_drawing_s_hoop_shows_millimetres_beside_diameters(monkeypatch, tmp_path):
    monkeypatch.setenv("PYTHONPATH", f"{os.environ['LEAPMAP_BUILD']}/python")
    spec = """[hoop]
diameter = "120 mm"
mass = "61 g"
[[hoop.weight]]
name = "slug"
mass = { from = "60 g", to = "120 g", count = 5 }
at = "47 mm"
[design]
slope = { from = "20 deg", to = "40 deg", count = 5 }
"""
    done = draw("design_chart.py", sweep(tmp_path, spec), "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "chart_jump_height.svg")
    assert "jump height [hoop diameters] (in mm)" in words and "0.2 (24)" in words, words


BODY = """[scene]
friction = "coulomb"
mu_static = 0.6
[hoop]
diameter = { from = "110 mm", to = "130 mm", count = 3 }
mass = "61 g"
[[hoop.weight]]
name = "slug"
mass = SLUG
at = "45 mm"
[design]
slope = SLOPE
"""


def test_tolerances_and_goals_of_a_drawing_are_charted_and_goals_in_mm_left_out_of_the_page(monkeypatch,
                                                                                            tmp_path):
    """The page's solver takes no goals in millimetres of hoops of several sizes."""
    monkeypatch.setenv("PYTHONPATH", f"{os.environ['LEAPMAP_BUILD']}/python")
    slopes = '{ from = "20 deg", to = "34 deg", count = 4 }'
    spec = BODY.replace("SLUG", '"85 g"').replace("SLOPE", slopes) + """
[tolerances]
hoop.slug.mass = { normal = "2 g" }
hoop.diameter = { uniform = "1 mm" }
slope = { normal = "1 deg" }
samples = 32
[goal]
jump_height = { at_least = "50 mm" }
"""
    path = sweep(tmp_path, spec)
    done = draw("yield_chart.py", path, "-o", tmp_path / "yield")
    assert done.returncode == 0, done.stderr
    words = " ".join(texts(tmp_path / "yield.svg"))
    assert "highest nominal jump: " in done.stdout and " diameters at slope" in done.stdout
    shown = draw("yield_chart.py", path, "--units", "mm", "-o", tmp_path / "mm")
    assert shown.returncode == 0, shown.stderr
    height = lambda text: float(text.split("highest nominal jump: ")[1].split()[0])
    with h5py.File(path) as m:
        along = [dim[0].name.strip("/") for dim in m["jump_height"].dims]
        heights = np.moveaxis(m["jump_height"][:], along.index("hoop.diameter"), -1)
        highest = np.nanmax(1000 * m["hoop.diameter"][:] * heights)
    assert height(shown.stdout) == pytest.approx(highest, rel=0.01), "three digits are shown"
    assert "jump height [mm]" in " ".join(texts(tmp_path / "mm.svg"))
    for word in ("jump height at least 0.05 m", "diameter of hoop [mm]", "mass of slug σ = 2 g",
                 "diameter of hoop ± 1 mm"):
        assert word in words, word
    made = scripted("explorer", path, "--module", f"{os.environ['LEAPMAP_BUILD']}/leapmap.wasm", "-o",
                    tmp_path / "page.html")
    assert made.returncode == 0, made.stderr
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>',
                                (tmp_path / "page.html").read_text(), re.S)[1])
    assert data["beyond_page"] == ["goals in units of the SI"]
    assert data["spreads"] == data["goals"] == []


def units_of(path, field, unit):
    """A field of a map as charts have it in a unit."""
    code = ("import sys, looks, planes; from read_map import read_map; "
            "m = planes.in_units(read_map(sys.argv[1]), sys.argv[3]); "
            "print(*map(repr, map(float, m.fields[sys.argv[2]])))")
    done = finished("env", f"PYTHONPATH={TOP}/analysis:{os.environ['PYTHONPATH']}", "/usr/bin/python3", "-c",
                    code, path, field, unit)
    assert done.returncode == 0, done.stderr
    return np.array(done.stdout.split(), float)


@pytest.mark.parametrize("goal", ['landing_impulse = { at_most = "1 N s" }', pytest.param(
    'max_normal_force = { at_most = "30 N" }', marks=pytest.mark.slow)])
def test_designs_found_for_a_drawing_are_charted_by_its_numbers(goal, monkeypatch, tmp_path):
    monkeypatch.setenv("PYTHONPATH", f"{os.environ['LEAPMAP_BUILD']}/python")
    question = (tmp_path / "q.toml")
    question.write_text(
        BODY.replace("SLUG", '{ from = "40 g", to = "120 g" }').replace("SLOPE", '"30 deg"').replace(
            ", count = 3", "") + '[goal]\nmaximize = ["jump_height"]\nminimize = ["hoop.slug.mass"]\n' +
        goal + "\n")
    best = tmp_path / "best.h5"
    assert leapmap("design", question, "--most", 60, "--sample", 1024, "-o", best).returncode == 0
    front = draw("front_chart.py", best, "--question", question, "-o", tmp_path / "front")
    assert front.returncode == 0, front.stderr
    words = texts(tmp_path / "front.svg")
    assert "mass of slug [g]" in words and any("diameter of hoop [mm]" in word for word in words), words
    front = draw("front_chart.py", best, "--units", "mm", "-o", tmp_path / "mm")
    assert front.returncode == 0, front.stderr
    assert "jump height [mm]" in texts(tmp_path / "mm.svg")
    for asked in ((best, "--question", question), (question, )):
        refused = draw("front_chart.py", *asked, "--units", "mm", "-o", tmp_path / "x")
        assert refused.returncode == 2 and "--units mm" in refused.stderr and refused.stderr.count("\n") == 1
    listed = draw("list_chart.py", best, "-x", "hoop.slug.mass", "--units", "mm ms", "-o", tmp_path / "list")
    assert listed.returncode == 0, listed.stderr
    words = " ".join(texts(tmp_path / "list.svg"))
    assert "mass of slug [g]" in words and "[mm]" in words and "[ms]" in words, words
    with h5py.File(best) as m:
        masses = 0.061 + m["hoop.slug.mass"][:]
        assert np.ptp(masses) > 0.01, "each design has its own"
        sizes = {"max_normal_force": ("N", 9.81 * masses), "landing_impulse": (
            "N.s", masses * np.sqrt(9.81 * m["hoop.diameter"][:] / 2))}
        for name in sizes.keys() & m.keys():
            unit, size = sizes[name]
            np.testing.assert_allclose(units_of(best, name, unit), size * m[name][:], rtol=1e-12)
        assert sizes.keys() & m.keys()
    refused = draw("front_chart.py", question, "-o", tmp_path / "x")
    assert refused.returncode == 2 and "-o MAP.h5" in refused.stderr and refused.stderr.count("\n") == 1
    for asked in (("-x", "hoop.slg.mass"), ("--units", "furlongg")):
        refused = draw("list_chart.py", best, *asked, "-o", tmp_path / "x")
        assert refused.returncode == 2 and refused.stderr.count("\n") == 1


@pytest.mark.parametrize("field,label,level",
                         [("jump_height", "jump height [hoop diameters]", "0.75"),
                          ("jump_time", "time from release to the jump [s]", "0.4"),
                          ("agility", "agility: height over time from release to apex [m/s]", "0.05")])
def test_the_design_chart_has_units_panels_levels_and_marks(field, label, level, charts):
    words = texts(charts / f"chart_{field}.svg")
    for word in ("slope [degrees]", label, "L/R = 0.7", "L/R = 1", "first lift-off below the threshold",
                 "no jump within the rolling limit", "the paper's hoop"):
        assert word in words, word
    assert "mass ratio mₚ/m" in words
    assert words.count(level) >= 2, "an isoline's label, besides the colour bar's"
    assert "40" in words and "10" in words
    svg = (charts / f"chart_{field}.svg").read_text()
    assert "<pattern" in svg, "spurious designs are hatched"
    assert (charts / f"chart_{field}.png").read_bytes().startswith(b"\x89PNG")
    told = finished("pdftotext", charts / f"chart_{field}.pdf", "-").stdout
    assert "slope [degrees]" in told and "first lift-off below the threshold" in told


def test_the_agility_chart_marks_published_jumpers_with_their_source(charts):
    words = " ".join(texts(charts / "chart_agility.svg"))
    assert "Salto 1.75" in words and "galago 2.24" in words and "Haldane et al., Science Robotics" in words
    assert "Salto" not in " ".join(texts(charts / "chart_jump_height.svg"))


def test_charts_are_the_same_bytes_for_the_same_map(charts, tmp_path):
    assert scripted("design_chart.py", charts / "map.h5", "-o", tmp_path / "chart").returncode == 0
    for field in ("jump_height", "agility"):
        for ending in ("png", "svg", "pdf"):
            assert (tmp_path / f"chart_{field}.{ending}").read_bytes() == (
                charts / f"chart_{field}.{ending}").read_bytes(), ending


def test_any_two_axes_of_any_map_can_be_drawn(charts, tmp_path):
    done = draw("design_chart.py", charts / "map.h5", "-x", "mass_ratio", "-y", "offset_ratio", "--at",
                "slope=23", "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "chart_jump_height.svg")
    assert "offset ratio L/R" in words and any(w.startswith("mass ratio") for w in words)
    assert any("slope = 22.3" in w or "slope = 23.1" in w for w in words), "the nearest slope there is"
    for wrong, word in ((["--at", "weight=3"], "no axis weight"),
                        (["--at", "slope=steep"], "not a number"), (["-x", "weight"], "no axis weight"), ([
                            "-x", "slope", "-y", "slope"
                        ], "both slope"), (["-x", "mass_ratio", "-y", "offset_ratio"], "--at")):
        refused = draw("design_chart.py", charts / "map.h5", *wrong, "-o", tmp_path / "no")
        assert refused.returncode == 2 and refused.stderr.count(
            "\n") == 1 and word in refused.stderr, refused.stderr


def test_the_status_chart_tells_how_designs_end_and_how_many(charts, tmp_path):
    done = draw("status_chart.py", charts / "map.h5", "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "chart.svg")
    with h5py.File(charts / "map.h5") as file:
        status, flag = file["status"][()], file["spurious_first_jump"][()]
    for label, where in (("jumps at its first lift-off", (status == 1) & (flag == 0)),
                         ("jumps after a sub-threshold first lift-off", (status == 1) & (flag == 1)),
                         ("no jump: all lift-offs below the jump threshold", (status == 2) & (flag == 1)),
                         ("no lift-off at all", (status == 2) & (flag == 255))):
        assert f"{label}: {100 * where.mean():.3g} %" in words, (label, words)
    assert "slope [degrees]" in words and "L/R = 0.7" in words and "the paper's hoop" in words


def test_the_cut_chart_draws_a_line_for_each_value_with_units_and_what_is_fixed(charts, tmp_path):
    done = draw("cut_chart.py", charts / "map.h5", "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "chart.svg")
    for word in ("[hoop diameters]", "[m/s]", "slope [degrees]", "mₚ/m = 0.1", "mₚ/m = 20",
                 "dashed: first lift-off below the threshold"):
        assert word in words, (word, words)
    assert any("L/R = 1" in w for w in words) and any("R = 41 mm" in w for w in words)
    done = draw("cut_chart.py", charts / "map.h5", "--along", "mass_ratio", "--by", "offset_ratio", "--at",
                "slope=30", "--fields", "dip", "-o", tmp_path / "dip")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "dip.svg")
    assert "lowest height right after lift-off" in words and "L/R = 0.7" in words
    assert any("slope = 30" in w or "slope = 29.6" in w for w in words)
    for wrong, word in ((["--along", "mu_static"], "mu_static"), (["--by", "slope"], "both slope"),
                        (["--by", "weight"], "no other axis"), (["--values", "99"], "beyond the map"), ([
                            "--at", "offset_ratio=3"
                        ], "beyond the map"), (["--fields", "beauty"], "beauty")):
        refused = draw("cut_chart.py", charts / "map.h5", *wrong, "-o", tmp_path / "no")
        assert refused.returncode == 2 and refused.stderr.count(
            "\n") == 1 and word in refused.stderr, refused.stderr


def colours_of(png, colour):
    """The share of pixels of that colour, a name or a hex text."""
    return (np.abs(image.imread(png)[..., :3] - to_rgb(colour)) < 0.02).all(axis=-1).mean()


@pytest.mark.slow  # its twin draws any two axes of any map
def test_a_coarse_logarithmic_axis_fills_its_panel_row_by_row(tmp_path):
    path = sweep(
        tmp_path,
        "[design]\nslope = { values = [0.1, 0.4, 0.7] }\nmass_ratio = { values = [0.1, 1, 10, 100] }\n"
        "[numerics]\naudit = 0\n"
    )
    for script, output in (("status_chart.py", "chart.png"), ("design_chart.py", "chart_jump_height.png")):
        done = scripted(script, path, "-o", tmp_path / "chart")
        assert done.returncode == 0 and done.stderr == "", done.stderr
        assert "100" in texts(tmp_path / output.replace("png", "svg"))
    # Each design is a twelfth of the panel, which is some 60 % of the picture.
    with h5py.File(path) as file:
        shares = {
            "#1b7837": (file["spurious_first_jump"][()] == 0).mean(),
            "#fdae61": (file["spurious_first_jump"][()] == 1)[file["status"][()] == 1].sum() / 12
        }
    seen = {colour: colours_of(tmp_path / "chart.png", colour) for colour in shares}
    assert seen["#1b7837"] / seen["#fdae61"] == pytest.approx(shares["#1b7837"] / shares["#fdae61"], rel=0.05)


def test_the_axis_to_fix_that_a_refusal_names_can_be_typed_as_it_stands(tmp_path):
    path = sweep(
        tmp_path, '[design]\nslope = { from = 0.2, to = 0.9, count = 14 }\n'
        "mass_ratio = { values = [1, 3] }\noffset_ratio = { values = [0.6, 1] }\n[numerics]\naudit = 0\n")
    refused = draw("design_chart.py", path, "-x", "mass_ratio", "-y", "offset_ratio", "-o", tmp_path / "x")
    assert refused.returncode == 2 and "--at slope=11.46°" in refused.stderr, refused.stderr
    named = refused.stderr.split("--at ")[1].split()[0]
    assert draw("design_chart.py", path, "-x", "mass_ratio", "-y", "offset_ratio", "--at", named, "-o",
                tmp_path / "x").returncode == 0


@pytest.mark.parametrize("damage", ["spin", "phase", "candidate_time", "status", "spec"])
def test_a_damaged_trace_is_refused_with_one_line_that_names_it(damage, tmp_path):
    leapmap("hop", "--trace", tmp_path / "trace.h5")
    with h5py.File(tmp_path / "trace.h5", "a") as file:
        if damage in file:
            del file[damage]
        else:
            del file.attrs[damage]
    done = draw("trace_chart.py", tmp_path / "trace.h5", "-o", tmp_path / "x")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and str(
        tmp_path / "trace.h5") in done.stderr, done.stderr


@pytest.mark.slow
def test_designs_without_a_jump_are_told_apart_and_the_star_needs_its_panel(tmp_path):
    spec = CHART.replace("offset_ratio = { values = [0.7, 1.0] }",
                         'release_angle = { values = ["30 deg", "190 deg"] }')
    done = draw("design_chart.py", sweep(tmp_path, spec), "-o", tmp_path / "chart.png")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "chart_jump_height.svg")
    assert "trapped (stalled)" in words and "no jump within the rolling limit" in words
    assert "release angle = 30°" in words
    assert "the paper's hoop" not in words, "no panel has its release"
    assert any("L/R = 1" in w and "rolling limit 5 revolutions" in w for w in words), "what is fixed is told"


@pytest.mark.parametrize(
    "design,word", [("slope = { values = [0.01, 0.02] }\nmass_ratio = { values = [0.1, 0.2] }", "jumps"),
                    ("slope = { values = [0.4] }\nmass_ratio = { values = [1, 2] }", "at least two")])
def test_what_cannot_be_drawn_is_refused_with_one_line(design, word, tmp_path):
    done = draw("design_chart.py", sweep(tmp_path, f"[design]\n{design}\n"), "-o", tmp_path / "x")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and word in done.stderr, done.stderr


def test_the_trace_chart_marks_both_candidates(tmp_path):
    leapmap("hop", TOP / "sweeps/paper_figures.toml", "--trace", tmp_path / "trace.h5")
    done = draw("trace_chart.py", tmp_path / "trace.h5", "-o", tmp_path / "figure")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "figure.svg")
    for word in ("angle φ [degrees]", "spin [rad/s]", "normal force [weights]", "friction [weights]",
                 "height y [mm]", "time since release [s]", "lift-off 0.1700 s", "jump 0.3200 s",
                 "flies 0.0074 diameters", "flies 0.997 diameters"):
        assert word in words, word


def test_the_jump_chart_shows_the_hoop_where_the_trace_has_it(tmp_path):
    leapmap("hop", "--trace", tmp_path / "trace.h5", "--trace-interval", "0.01")
    done = draw("jump_chart.py", tmp_path / "trace.h5", "--count", "12", "--animate", "-o", tmp_path / "jump")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "jump.gif").read_bytes()[:6] == b"GIF89a"
    sys.path.insert(0, str(TOP / "analysis"))
    import jump_chart
    from read_map import read_trace

    trace = read_trace(str(tmp_path / "trace.h5"))
    slope = jump_chart.Slope(0.4)
    centre, mass = jump_chart.markers(trace, trace.numbers(), slope)
    assert np.allclose(np.linalg.norm(mass - centre, axis=1), 0.041), "the mass is on the rim"
    assert np.allclose(centre @ slope.away - 0.041,
                       trace.fields["y"]), "the lowest point is y above the plane"
    rolls = trace.code("phase", "rolling")
    at_plane = rolls & (np.cos(trace.fields["phi"]) > 0.95)
    assert at_plane.any() and (mass[at_plane] @ slope.away <
                               2.1e-3).all(), "phi = 0: the mass touches the plane"


def test_the_trace_charts_mark_what_the_paper_published(tmp_path):
    leapmap("hop", TOP / "sweeps/paper_figures.toml", "--trace", tmp_path / "trace.h5")
    done = draw("trace_chart.py", tmp_path / "trace.h5", "--paper", "-o", tmp_path / "figure")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "figure.svg")
    for word in ("paper: about 0.17 s", "paper: about 0.30 s", "seen 0.330 s"):
        assert word in words, word
    words = texts(tmp_path / "figure_flight.svg")
    for word in ("Δx along the plane [mm]", "Δy above the plane [mm]", "Δφ [degrees]",
                 "time since lift-off [s]", "measured apex 0.129 s", "measured landing 0.198 s",
                 "one diameter", "apex 0.997 diameters", "lands after 0.2003 s"):
        assert word in words, (word, words)
    unmarked = draw("trace_chart.py", tmp_path / "trace.h5", "-o", tmp_path / "plain")
    assert unmarked.returncode == 0
    assert not any("paper" in w or "measured" in w
                   for w in texts(tmp_path / "plain.svg") + texts(tmp_path / "plain_flight.svg"))


def test_the_papers_times_are_not_marked_on_another_release(tmp_path):
    leapmap("hop", "--trace", tmp_path / "trace.h5")
    done = draw("trace_chart.py", tmp_path / "trace.h5", "--paper", "-o", tmp_path / "figure")
    assert done.returncode == 0 and "another moment" in done.stderr
    assert not any("about" in w for w in texts(tmp_path / "figure.svg"))
    assert "one diameter" in texts(tmp_path / "figure_flight.svg")


def test_a_trace_with_friction_has_its_flight_drawn_from_the_jump_on(tmp_path):
    leapmap("hop", "--set", "friction=coulomb", "--mu-static", "0.4", "--trace", tmp_path / "trace.h5")
    done = draw("trace_chart.py", tmp_path / "trace.h5", "-o", tmp_path / "figure")
    assert done.returncode == 0, done.stderr
    told = json.loads(leapmap("hop", "--set", "friction=coulomb", "--mu-static", "0.4", "--json").stdout)
    words = texts(tmp_path / "figure_flight.svg")
    assert f"lands after {told['flight_time']:.4f} s" in words, words
    assert f"apex {told['jump_height']:.3f} diameters" in words, words


def test_a_trace_of_several_jumps_marks_each_and_its_flight_chart_is_of_the_first(tmp_path):
    leapmap("hop", "--slope", "12 deg", "--mass-ratio", "3", "--offset-ratio", "0.5", "--jumps", "3", "--set",
            "runway=20", "--trace", tmp_path / "trace.h5")
    done = draw("trace_chart.py", tmp_path / "trace.h5", "-o", tmp_path / "figure")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "figure.svg")
    assert sum(word.startswith("jump ") for word in words) == 3
    assert not any(word.startswith("candidate") for word in words)
    assert "apex 0.142 diameters" in texts(tmp_path / "figure_flight.svg")


def test_the_period_chart_tells_periods_and_of_one_hoop_which_release_leads_to_which_gait(tmp_path):
    spec = "[scene]\nrunway = 20.0\n[design]\n{}\n[gait]\nsettle = 200\n"
    path = sweep(
        tmp_path,
        spec.format(
            "slope = { from = 0.1, to = 0.4, count = 24 }\nmass_ratio = { from = 1, to = 9, count = 20 }\n"
            "offset_ratio = 0.5"
        ))
    done = draw("period_chart.py", path, "-o", tmp_path / "periods")
    assert done.returncode == 0, done.stderr
    words = [w for w in texts(tmp_path / "periods.svg") if w.endswith("%")]
    with h5py.File(path) as m:
        period = m["gait_period"][:]
    assert f"period 1: {100 * (period == 1).mean():.3g} %" in words
    assert f"the jumps end: {100 * (period == 0).mean():.3g} %" in words
    hoop = ("slope = 0.4057\nmass_ratio = 11.29\noffset_ratio = 0.4428\n"
            "release_angle = { from = \"0 deg\", to = \"360 deg\", count = 25 }\n"
            "release_spin = { from = -1, to = 1, count = 15 }")
    done = draw("period_chart.py", sweep(tmp_path, spec.format(hoop), name="basins.h5"), "-x",
                "release_angle", "-o", tmp_path / "basins")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "basins.svg")
    for gait in ("0.328 diameters", "0.735 diameters", "0.992 diameters, period 2"):
        assert any(word.startswith(gait + ":") for word in words), gait
    refused = draw("period_chart.py", sweep(tmp_path, CHART, name="plain.h5"), "-o", tmp_path / "no")
    assert refused.returncode == 2 and "gait" in refused.stderr and len(refused.stderr.splitlines()) == 1


def test_a_trace_without_a_jump_is_drawn_too(tmp_path):
    leapmap("hop", "--slope", "1deg", "--mass-ratio", "0.1", "--trace", tmp_path / "trace.h5")
    done = draw("trace_chart.py", tmp_path / "trace.h5", "-o", tmp_path / "figure")
    assert done.returncode == 0, done.stderr
    assert not any(w.startswith("jump") for w in texts(tmp_path / "figure.svg"))


@pytest.mark.parametrize("script", ["design_chart.py", "trace_chart.py", "status_chart.py", "cut_chart.py"])
def test_other_files_are_refused_with_one_line(script, tmp_path):
    (tmp_path / "words.h5").write_text("words")
    for path in (tmp_path / "words.h5", tmp_path / "nowhere.h5"):
        done = draw(script, path, "-o", tmp_path / "x")
        assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    assert draw(script, "--help").returncode == 0


def test_a_map_without_the_axes_of_a_chart_is_refused_with_one_line(tmp_path):
    path = sweep(tmp_path, '[design]\nslope = { values = [0.3, 0.4] }\n')
    done = draw("design_chart.py", path, "-o", tmp_path / "x")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "mass_ratio" in done.stderr


def test_adequacy_compares_two_maps_panel_by_panel_and_refuses_others(tmp_path):
    axes = ('slope = { from = "5 deg", to = "45 deg", count = 12 }\n'
            'mass_ratio = { from = 0.2, to = 10, count = 11, scale = "log" }\n')
    rigid = sweep(tmp_path, f"[design]\n{axes}[numerics]\naudit = 0\n", name="rigid.h5")
    slipping = sweep(
        tmp_path,
        f'[scene]\nfriction = "coulomb"\nmu_static = {{ values = [0.2, 1.5] }}\n[design]\n{axes}[numerics]\n'
        'audit = 0\n',
        name="slipping.h5")
    done = draw("adequacy_chart.py", rigid, slipping, "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    found = " ".join(texts(tmp_path / "chart.svg"))
    assert "μ = 0.2" in found and "μ = 1.5" in found and "height within 5 %" in found
    assert "mass ratio" in found
    swapped = draw("adequacy_chart.py", slipping, rigid, "-o", tmp_path / "no")
    assert swapped.returncode == 2 and swapped.stderr.count("\n") == 1 and "comes first" in swapped.stderr
    other = sweep(tmp_path, f"[design]\n{axes.replace('45 deg', '40 deg')}[numerics]\naudit = 0\n",
                  name="other.h5")
    refused = draw("adequacy_chart.py", other, slipping, "-o", tmp_path / "no")
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1 and "slope" in refused.stderr


def test_the_experiment_chart_marks_what_was_measured(tmp_path):
    path = sweep(
        tmp_path, '[scene]\nfriction = "coulomb"\nmu_static = { from = 0.3, to = 0.5, count = 21 }\n'
        '[design]\nrelease_angle = { from = "178 deg", to = "210 deg", count = 33 }\n[numerics]\naudit = 0\n')
    done = draw("experiment_chart.py", path, "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    found = " ".join(texts(tmp_path / "chart.svg"))
    assert "apex 0.129 s" in found and "release angle" in found and "small hops" in found


@pytest.mark.slow
def test_a_list_of_designs_is_drawn_a_dot_each_over_a_parameter_that_varies(tmp_path):
    (tmp_path / "designs.csv").write_text("slope,mass_ratio\n" +
                                          "".join(f"{5 + i} deg,{0.05 * 1.2**i}\n" for i in range(25)))
    path = sweep(tmp_path, '[design]\npoints = "designs.csv"\n')
    done = draw("list_chart.py", path, "-o", tmp_path / "list")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "list.svg")
    for word in ("slope [degrees]", "first lift-off is the jump", "first lift-off below the threshold"):
        assert word in words, word
    with h5py.File(path) as m:
        jumps, spurious = m["status"][()] == 1, m["spurious_first_jump"][()] == 1
    assert f"no jump within the rolling limit: {(~jumps).sum()}" in words and 0 < jumps.sum() < 25
    svg = ElementTree.parse(tmp_path / "list.svg")
    dots = [use for use in svg.iter("{http://www.w3.org/2000/svg}use") if "#e08214" in use.get("style", "")]
    assert len(dots) == 3 * (jumps & spurious).sum() + 1, "three panels, and the legend's"
    rows = (tmp_path / "designs.csv").read_text().splitlines()
    (tmp_path / "designs.csv").write_text("label," + rows[0] + "\n" +
                                          "".join(f'"$hoop, {i}",{row}\n' for i, row in enumerate(rows[1:])))
    named = sweep(tmp_path, '[design]\npoints = "designs.csv"\n', name="named.h5")
    for along in ("design", "slope"):
        done = draw("list_chart.py", named, "-x", along, "-o", tmp_path / "named")
        found = texts(tmp_path / "named.svg")
        assert done.returncode == 0 and "$hoop, 24" in found, (done.stderr, along)
        assert {"design": "designs of the list", "slope": "slope [degrees]"}[along] in found
        assert "no slip" in " ".join(found) and "L/R = 1" in " ".join(found)
    over_number = draw("list_chart.py", path, "-x", "design", "--fields", "jump_height", "-o",
                       tmp_path / "number")
    assert over_number.returncode == 0 and "number in the list, from 0" in texts(tmp_path / "number.svg")
    wrong = draw("list_chart.py", path, "-x", "gravity", "-o", tmp_path / "wrong")
    assert wrong.returncode == 2 and "allowed: design, " in wrong.stderr
    grid = draw("list_chart.py", sweep(tmp_path, CHART, name="grid.h5"), "-o", tmp_path / "grid")
    assert grid.returncode == 2 and "is no list of designs" in grid.stderr


@pytest.fixture(scope="module")
def with_cliffs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("cliffs")
    path = sweep(
        folder,
        CHART.replace("values = [0.7, 1.0]", "values = [1.0]").replace("offset_ratio = { values = [1.0] }",
                                                                       "offset_ratio = 1.0"))
    done = leapmap("boundaries", path, "-o", folder / "map.cliffs.h5")
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.parametrize(
    "script, words",
    [pytest.param("design_chart.py", [
        "discontinuity: a lift-off crosses the jump threshold", "discontinuity: a lift-off appears (fold)"
    ], marks=pytest.mark.slow),
     ("status_chart.py", ["discontinuity: a lift-off crosses the jump threshold"]),
     ("phase_diagram.py", [
         "jumps on the 1st lift-off", "jumps on the 2nd lift-off", "1st", "2nd", "no jump", "the paper's hoop"
     ])])
def test_charts_draw_the_cliffs_beside_a_map_as_curves_named_in_the_legend(with_cliffs, tmp_path, script,
                                                                           words):
    done = draw(script, with_cliffs / "map.h5", "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    svg = next(line for line in done.stdout.split() if line.endswith(".svg"))
    told = texts(svg)
    for word in words:
        assert word in told, word
    without = draw(script, with_cliffs / "map.h5", "--cliffs", "none", "-o", tmp_path / "plain")
    assert without.returncode == 0, without.stderr
    plain = texts(next(line for line in without.stdout.split() if line.endswith(".svg")))
    assert not any(word.startswith("cliff") for word in plain)


def test_pixels_beside_a_cliff_are_of_the_side_they_are_on(with_cliffs, monkeypatch):
    monkeypatch.syspath_prepend(str(TOP / "analysis"))
    import cliffs
    import planes
    from read_map import read_map
    m = read_map(str(with_cliffs / "map.h5"))
    grid = planes.Planes(m)
    panel = cliffs.Panel(grid, (), cliffs.read_cliffs(m, None))
    ours = panel.code(grid.cut(np.where(m.code("status", "jumped"), m.fields["candidates"], 0))[0])
    slopes, ratios = np.radians(panel.centres("slope")), panel.centres("mass_ratio")
    rng = np.random.default_rng(3)
    rows, columns = rng.integers(0, len(ratios), 400), rng.integers(0, len(slopes), 400)
    designs = with_cliffs / "pixels.csv"
    designs.write_text("slope,mass_ratio\n" +
                       "".join(f"{slopes[c]!r},{ratios[r]!r}\n" for r, c in zip(rows, columns)))
    sweep(with_cliffs, '[design]\npoints = "pixels.csv"\n[numerics]\naudit = 0\n', name="pixels.h5")
    with h5py.File(with_cliffs / "pixels.h5") as f:
        truth = np.where(f["status"][()] == 1, f["candidates"][()], 0)
    right = (ours[rows, columns] == truth).mean()
    # Bands narrower than a cell of this coarse grid are not seen; cells alone are right for 93 % or fewer.
    assert right > 0.95, right


def test_cliffs_of_another_map_are_refused(with_cliffs, tmp_path):
    other = sweep(tmp_path, CHART)
    done = draw("design_chart.py", other, "--cliffs", with_cliffs / "map.cliffs.h5", "-o", tmp_path / "no")
    assert done.returncode == 2 and "holds other designs" in done.stderr and done.stderr.count("\n") == 1


MADE = """
[design]
slope = { from = "15 deg", to = "27 deg", count = 25 }
mass_ratio = { from = 2, to = 6, count = 21 }
[scatter]
slope = { normal = "1 deg" }
mass_ratio = { uniform = "5 %" }
samples = 512
[goal]
jump_height = { at_least = 0.8 }
[numerics]
audit = 0
"""


def test_what_is_proved_of_cells_is_drawn_with_its_shares(tmp_path):
    spec = tmp_path / "s.toml"
    spec.write_text("""
[design]
slope = { from = "9 deg", to = "11 deg", count = 9 }
mass_ratio = { from = 0.40, to = 0.46, count = 7 }
[numerics]
audit = 0
""", encoding="utf-8")
    assert leapmap("prove", spec, "-o", tmp_path / "p.h5").returncode == 0
    with h5py.File(tmp_path / "p.h5") as m:
        crossed = 100 * (m["proof"][()] == 2).mean()
    assert 0 < crossed < 50, "a discontinuity runs through this chart"
    done = draw("proof_chart.py", tmp_path / "p.h5", "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    text = " ".join((tmp_path / "chart.svg").read_text(encoding="utf-8").split())
    assert f"crossed by a discontinuity: {crossed:.3g} %" in text
    both = draw("design_chart.py", tmp_path / "p.h5", "-o", tmp_path / "all")
    assert both.returncode == 0 and (tmp_path / "all_proof.svg").exists(), both.stderr
    (tmp_path / "plain.toml").write_text(spec.read_text(encoding="utf-8"), encoding="utf-8")
    assert leapmap("sweep", spec, "-o", tmp_path / "plain.h5").returncode == 0
    refused = draw("proof_chart.py", tmp_path / "plain.h5", "-o", tmp_path / "no")
    assert refused.returncode != 0 and "holds no proofs" in refused.stderr


def test_the_yield_chart_has_isolines_cliffs_and_where_to_sit(tmp_path):
    path = sweep(tmp_path, MADE)
    assert leapmap("boundaries", path, "-o", tmp_path / "map.cliffs.h5").returncode == 0
    done = draw("yield_chart.py", path, "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    told = texts(tmp_path / "chart.svg")
    for words in ("yield: jump height at least 0.8", "nominal jump height", "50 %", "90 %", "99 %",
                  "discontinuity: a lift-off crosses the jump threshold", "the paper's hoop"):
        assert words in told, words
    with h5py.File(path) as f:
        safe = np.where(f["yield"][()] - 2 * f["yield_error"][()] >= 0.99, f["jump_height"][()], 0).max()
    assert any(
        word.startswith(f"highest nominal jump with a yield of 99 %: {safe:.3g} diameters at slope")
        for word in told)
    assert any("slope σ = 1°" in word and "mass ratio mₚ/m ± 5 %" in word for word in told)


def test_the_yield_chart_wants_a_yield_over_two_axes(charts, tmp_path):
    refused = draw("yield_chart.py", charts / "map.h5", "-o", tmp_path / "no")
    assert refused.returncode == 2 and "has no yield" in refused.stderr and refused.stderr.count("\n") == 1


@pytest.mark.parametrize("friction", ["sticking", pytest.param("coulomb", marks=pytest.mark.slow)])
def test_the_scatter_chart_shows_goals_quantiles_and_importance(friction, tmp_path):
    (tmp_path / "one.toml").write_text(MADE[MADE.index("[scatter]"):])
    told = leapmap("hop", tmp_path / "one.toml", "--scatter", "--json", "--friction", friction)
    (tmp_path / "one.json").write_text(told.stdout)
    done = scripted("scatter_chart.py", tmp_path / "one.json")  # in every format
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "one_scatter.svg")
    made = json.loads(told.stdout)["scatter"]
    assert "goal: at least 0.8" in words
    assert f"median {made['quantities']['jump_height']['q50']['value']:.4g}" in words
    assert "of reaching every goal" in words and "of the height of those that jump" in words
    assert any(f"{100 * made['yield']['value']:.1f}" in word and "reach every goal" in word for word in words)


def test_the_scatter_chart_refuses_what_is_no_scatter(tmp_path):
    (tmp_path / "hop.json").write_text(leapmap("hop", "--json").stdout)
    (tmp_path / "text.json").write_text("{")
    for name in ("hop.json", "text.json", "nowhere.json"):
        done = draw("scatter_chart.py", tmp_path / name)
        assert done.returncode == 2 and name in done.stderr and done.stderr.count("\n") == 1, done.stderr


QUESTION = """
[design]
slope = { from = "5 deg", to = "20 deg" }
mass_ratio = { from = 0.1, to = 10, scale = "log" }
[goal]
maximize = ["jump_height"]
minimize = ["mass_ratio"]
"""


def test_a_front_has_its_gaps_its_cloud_and_three_designs_called_out(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", f"{os.environ['LEAPMAP_BUILD']}/python")
    (tmp_path / "q.toml").write_text(QUESTION)
    assert leapmap("design", tmp_path / "q.toml", "--most", 400, "--sample", 16384, "-o",
                   tmp_path / "best.h5").returncode == 0
    before = (tmp_path / "best.h5").read_bytes()
    done = draw("front_chart.py", tmp_path / "best.h5", "--question", tmp_path / "q.toml", "-o",
                tmp_path / "front")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "best.h5").read_bytes() == before and "400 designs" in " ".join(
        texts(tmp_path / "front.svg")), "the file's front is drawn, not another one"
    alone = draw("front_chart.py", tmp_path / "best.h5", "-o", tmp_path / "alone")
    assert alone.returncode == 0, alone.stderr
    assert "designs by chance" not in texts(tmp_path / "alone.svg")
    words = texts(tmp_path / "front.svg")
    for word in ("mass ratio mₚ/m", "jump height [hoop diameters]", "designs by chance", "1", "2", "3"):
        assert word in words, word
    svg = (tmp_path / "front.svg").read_text()
    lines = [
        len(d.split("L")) for d in re.findall(
            r'<path d="(M[^"]*)"[^>]*style="fill: none; stroke: #[0-9a-f]{6}; stroke-width: 1.4', svg)
    ]
    assert sum(n > 20 for n in lines) >= 2, "the front is cut at its cliffs"
    (tmp_path / "one.toml").write_text(QUESTION.replace('minimize = ["mass_ratio"]', ""))
    refused = draw("front_chart.py", tmp_path / "one.toml", "-o", tmp_path / "x")
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1 and "two" in refused.stderr
    (tmp_path / "bad.toml").write_text(QUESTION.replace("jump_height", "jump_hight"))
    refused = draw("front_chart.py", tmp_path / "bad.toml", "-o", tmp_path / "x")
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1 and "jump_hight" in refused.stderr
    other = QUESTION.replace('minimize = ["mass_ratio"]', 'minimize = ["jump_time"]')
    (tmp_path / "other.toml").write_text(other)
    refused = draw("front_chart.py", tmp_path / "best.h5", "--question", tmp_path / "other.toml", "-o",
                   tmp_path / "x")
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1 and "best.h5 answers" in refused.stderr
    (tmp_path / "other.toml").write_text(QUESTION.replace("to = 10,", "to = 3,"))
    refused = draw("front_chart.py", tmp_path / "best.h5", "--question", tmp_path / "other.toml", "-o",
                   tmp_path / "x")
    assert refused.returncode == 2 and "best.h5 answers" in refused.stderr, "other bounds"
    refused = draw("front_chart.py", sweep(tmp_path), "-o", tmp_path / "x")
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1 and "Pareto front" in refused.stderr


@pytest.mark.slow
def test_the_front_of_a_spec_is_searched_for(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", f"{os.environ['LEAPMAP_BUILD']}/python")
    (tmp_path / "q.toml").write_text(QUESTION)
    done = draw("front_chart.py", tmp_path / "q.toml", "-o", tmp_path / "front")
    assert done.returncode == 0, done.stderr
    assert "designs by chance" in texts(tmp_path / "front.svg")


@pytest.mark.parametrize(
    "models",
    [["no slip"], pytest.param(["no slip", "Coulomb friction"], marks=pytest.mark.slow)])
def test_a_fit_of_events_is_a_bar_each(models, tmp_path):
    flags = ["--model", "sticking"] if models == ["no slip"] else []
    assert leapmap("fit", TOP / "sweeps/paper_events.csv", "--csv", tmp_path / "fit.csv",
                   *flags).returncode == 0
    done = draw("fit_chart.py", tmp_path / "fit.csv", "-o", tmp_path / "fit")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "fit.svg")
    for word in ("apex_time 0.129", "jump_height 1", *models):
        assert word in words, word
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    refused = draw("fit_chart.py", tmp_path / "other.csv", "-o", tmp_path / "x")
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1 and "other.csv" in refused.stderr


def test_a_chart_over_a_weight_is_in_grams_and_millimetres(monkeypatch, tmp_path):
    """Isolines and colours too, whose numbers are those of the map times its diameter."""
    monkeypatch.setenv("PYTHONPATH", f"{os.environ['LEAPMAP_BUILD']}/python")
    spec = (TOP / "sweeps" / "drawing.toml").read_text().replace(
        'mass = "85 g"', 'mass = { from = "40 g", to = "160 g", count = 30 }')
    made = sweep(tmp_path, "[design]\nslope = { from = 0.3, to = 0.6, count = 30 }\n" + spec)
    chart = draw("design_chart.py", made, "--units", "mm ms", "-o", tmp_path / "chart")
    assert chart.returncode == 0, chart.stderr
    words = texts(tmp_path / "chart_jump_height.svg")
    assert "mass of slug [g]" in words and "jump height [mm]" in words and "R = 60 mm" in " ".join(words)
    with h5py.File(made) as m:
        heights = 120 * m["jump_height"][:]
    numbers = [float(word) for word in words if re.fullmatch(r"\d+", word)]
    assert max(numbers) > 40 and np.nanmin(heights) < 50 < np.nanmax(heights) and 50.0 in numbers
    assert "time from release to the jump [ms]" in texts(tmp_path / "chart_jump_time.svg")
    panel = draw("design_chart.py", made, "--units", "N", "-o", tmp_path / "chart")
    assert panel.returncode != 0 and "--units N: fits no quantity" in panel.stderr
