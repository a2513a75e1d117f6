# SPDX-License-Identifier: GPL-3.0-or-later
"""The charts, drawn from small maps and read back from their SVG: what they must contain, not merely that they exist."""
import xml.etree.ElementTree as ElementTree

import pytest
from support.program import TOP, finished, leapmap, sweep

CHART = """
[design]
slope = { from = "2 deg", to = "50 deg", count = 60 }
mass_ratio = { from = 0.1, to = 20, count = 60, scale = "log" }
offset_ratio = { values = [0.7, 1.0] }
[numerics]
tolerance = 1e-6
"""


def draw(script, *arguments):
    return finished("/usr/bin/python3", TOP / "analysis" / script, *arguments)


def texts(svg):
    return [t.text or "" for t in ElementTree.parse(svg).iter("{http://www.w3.org/2000/svg}text")]


@pytest.fixture(scope="module")
def charts(tmp_path_factory):
    folder = tmp_path_factory.mktemp("charts")
    done = draw("design_chart.py", sweep(folder, CHART), "-o", folder / "chart")
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [f"{folder}/chart_{f}.{e}" for f in ("jump_height", "jump_time") for e in ("png", "svg")]
    return folder


@pytest.mark.parametrize("field,label,level", [("jump_height", "jump height [hoop diameters]", "0.75"),
                                               ("jump_time", "time from release to the jump [s]", "0.4")])
def test_the_design_chart_has_units_panels_levels_and_marks(field, label, level, charts):
    words = texts(charts / f"chart_{field}.svg")
    for word in ("slope [degrees]", label, "L/R = 0.7", "L/R = 1", "first lift-off is spurious", "no jump on the runway",
                 "the paper's hoop"):
        assert word in words, word
    assert any(w.startswith("mass ratio") for w in words)
    assert words.count(level) >= 2, "an isoline's label, besides the colour bar's"
    assert "40" in words and "10" in words
    svg = (charts / f"chart_{field}.svg").read_text()
    assert "<pattern" in svg, "spurious designs are hatched"
    assert (charts / f"chart_{field}.png").read_bytes().startswith(b"\x89PNG")


def test_designs_without_a_jump_are_told_apart_and_the_star_needs_its_panel(tmp_path):
    spec = CHART.replace("offset_ratio = { values = [0.7, 1.0] }", 'release_angle = { values = ["30 deg", "190 deg"] }')
    done = draw("design_chart.py", sweep(tmp_path, spec), "-o", tmp_path / "chart.png")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "chart_jump_height.svg")
    assert "stalled" in words and "no jump on the runway" in words and "release angle = 30°" in words
    assert "the paper's hoop" not in words, "no panel has its release"
    assert any("L/R = 1" in w and "runway 5 turns" in w for w in words), "what is fixed is told"


@pytest.mark.parametrize("design,word", [("slope = { values = [0.01, 0.02] }\nmass_ratio = { values = [0.1, 0.2] }", "jumps"),
                                         ("slope = { values = [0.4] }\nmass_ratio = { values = [1, 2] }", "at least two")])
def test_what_cannot_be_drawn_is_refused_with_one_line(design, word, tmp_path):
    done = draw("design_chart.py", sweep(tmp_path, f"[design]\n{design}\n"), "-o", tmp_path / "x")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and word in done.stderr, done.stderr


def test_the_trace_chart_marks_both_candidates(tmp_path):
    leapmap("hop", TOP / "sweeps/paper_figures.toml", "--trace", tmp_path / "trace.h5")
    done = draw("trace_chart.py", tmp_path / "trace.h5", "-o", tmp_path / "figure")
    assert done.returncode == 0, done.stderr
    words = texts(tmp_path / "figure.svg")
    for word in ("angle φ [degrees]", "spin [rad/s]", "normal force [weights]", "friction [weights]", "height y [mm]",
                 "time since release [s]", "candidate 0.1700 s", "jump 0.3200 s", "flies 0.0074 diameters", "flies 0.997 diameters"):
        assert word in words, word


def test_a_trace_without_a_jump_is_drawn_too(tmp_path):
    leapmap("hop", "--slope", "1deg", "--mass-ratio", "0.1", "--trace", tmp_path / "trace.h5")
    done = draw("trace_chart.py", tmp_path / "trace.h5", "-o", tmp_path / "figure")
    assert done.returncode == 0, done.stderr
    assert not any(w.startswith("jump") for w in texts(tmp_path / "figure.svg"))


@pytest.mark.parametrize("script", ["design_chart.py", "trace_chart.py"])
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
    axes = 'slope = { from = "5 deg", to = "45 deg", count = 12 }\nmass_ratio = { from = 0.2, to = 10, count = 11, scale = "log" }\n'
    rigid = sweep(tmp_path, f"[design]\n{axes}[numerics]\naudit = 0\n", name="rigid.h5")
    slipping = sweep(tmp_path, f'[scene]\nfriction = "coulomb"\nmu_static = {{ values = [0.2, 1.5] }}\n[design]\n{axes}[numerics]\naudit = 0\n',
                     name="slipping.h5")
    done = draw("adequacy_chart.py", rigid, slipping, "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    found = " ".join(texts(tmp_path / "chart.svg"))
    assert "μ = 0.2" in found and "μ = 1.5" in found and "height within 5 %" in found and "mass ratio" in found
    swapped = draw("adequacy_chart.py", slipping, rigid, "-o", tmp_path / "no")
    assert swapped.returncode == 2 and swapped.stderr.count("\n") == 1 and "comes first" in swapped.stderr
    other = sweep(tmp_path, f"[design]\n{axes.replace('45 deg', '40 deg')}[numerics]\naudit = 0\n", name="other.h5")
    refused = draw("adequacy_chart.py", other, slipping, "-o", tmp_path / "no")
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1 and "slope" in refused.stderr


def test_the_experiment_chart_marks_what_was_measured(tmp_path):
    path = sweep(tmp_path, '[scene]\nfriction = "coulomb"\nmu_static = { from = 0.3, to = 0.5, count = 21 }\n'
                           '[design]\nrelease_angle = { from = "178 deg", to = "210 deg", count = 33 }\n[numerics]\naudit = 0\n')
    done = draw("experiment_chart.py", path, "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    found = " ".join(texts(tmp_path / "chart.svg"))
    assert "apex 0.129 s" in found and "release angle" in found and "small hops" in found
