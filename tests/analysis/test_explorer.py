# SPDX-License-Identifier: GPL-3.0-or-later
"""The explorer's page in a real browser, Debian's chromium without a window: what it shows is the map's and
leapmap's own."""
import json
import math
import os
import re
import shlex
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select
from support.browser import agrees, numbers, opened, told_by_leapmap, waited
from support.program import PROGRAM, TOP, finished, leapmap, scripted, sweep

MODULE = Path(os.environ["LEAPMAP_BUILD"]) / "leapmap.wasm"
ARTEFACTS = Path(os.environ["LEAPMAP_BUILD"]) / "artefacts"

SPEC = """
[design]
slope = { from = "2 deg", to = "50 deg", count = 49 }
mass_ratio = { from = 0.1, to = 20, count = 40, scale = "log" }
offset_ratio = { values = [0.6, 1.0] }
"""


def explorer(*arguments):
    return scripted("explorer", *arguments, "--module", MODULE)


def made(path):
    done = explorer(path, "-o", path.with_suffix(".html"))
    assert done.returncode == 0, done.stderr
    return path.with_suffix(".html")


@pytest.fixture(scope="module")
def map_file(tmp_path_factory):
    return sweep(tmp_path_factory.mktemp("explorer"), SPEC)


@pytest.fixture
def page(browser, map_file):
    html = map_file.with_suffix(".html")
    if not html.exists():
        made(map_file)
    opened(browser, html)
    return browser


def point(browser, index, click=False):
    """Moves the mouse onto a design's cell, as a hand would."""
    x, y = browser.execute_script("return window.explorer.view.placeOf(arguments[0])", index)
    canvas = browser.find_element("id", "map")
    left, top, width, height = (canvas.rect[k] for k in ("x", "y", "width", "height"))
    chain = ActionChains(browser).move_to_element_with_offset(canvas, round(x - left - width / 2),
                                                              round(y - top - height / 2))
    (chain.click() if click else chain).perform()


def readout(browser):
    return browser.execute_script("return {...document.getElementById('readout').dataset}")


@pytest.mark.parametrize("index", [[20, 30, 1], [3, 2, 1], pytest.param([40, 10, 0], marks=pytest.mark.slow)])
def test_pointing_at_a_design_reads_the_map_s_own_number(index, page, map_file):
    select_layer(page, index[2])
    point(page, index)
    shown = readout(page)
    assert shown["index"] == ",".join(map(str, index))
    with h5py.File(map_file) as file:
        value = file["jump_height"][tuple(index)]
    if np.isnan(value):
        assert shown["value"] == "" and "no jump" in page.find_element("id", "value").text
    else:
        decimals = len(shown["value"].partition(".")[2])
        assert decimals >= 3 and abs(float(shown["value"]) - value) <= 0.5001 * 10.0**-decimals
        assert shown["value"] in page.find_element("id", "value").text


def select_layer(browser, k):
    browser.execute_script(
        "const s = document.querySelector('#sliders input'); s.value = arguments[0]; s.dispatchEvent(new "
        "Event('input'))",
        k)


def test_every_field_of_every_design_on_the_page_is_the_map_s_rounded(page, map_file):
    fields = page.execute_script(
        "return window.explorer.map.fields.map(f => ({name: f.name, step: f.step, values: "
        "[...f.values].map(v => v === v ? v : null)}))"
    )
    assert {"jump_height", "jump_time", "agility", "dip", "candidates"} <= {f["name"] for f in fields}
    with h5py.File(map_file) as file:
        for field in fields:
            if field["name"] == "agility":
                truth = 2 * 0.041 * file["jump_height"][()] / (file["jump_time"][()] + file["apex_time"][()])
            else:
                truth = file[field["name"]][()].astype(float)
            shown = np.array(field["values"], float).reshape(truth.shape)
            assert np.array_equal(np.isnan(shown), np.isnan(truth)), field["name"]
            assert np.nanmax(np.abs(shown - truth)) <= 0.5001 * field["step"], field["name"]
            assert field["step"] <= 2e-4 * np.nanmax(
                np.abs(truth)) or field["name"] == "candidates", field["name"]


@pytest.mark.parametrize("index", [[20, 30, 1], [0, 0, 0], pytest.param([44, 5, 1], marks=pytest.mark.slow)])
def test_a_click_shows_the_hoop_and_its_numbers_are_those_of_leapmap_hop(index, page):
    select_layer(page, index[2])
    point(page, index, click=True)
    told = told_by_leapmap(page)
    assert told["design"]["offset_ratio"] == [0.6, 1.0][index[2]]
    assert agrees(numbers(page), told) >= (9 if told["status"] == "jumped" else 1)


def pixels(browser, canvas):
    return browser.execute_script("const c = document.getElementById(arguments[0]); return c.toDataURL()",
                                  canvas)


@pytest.mark.slow
def test_the_animation_moves_stops_and_can_be_scrubbed(page):
    point(page, [20, 30, 1], click=True)
    # Begun, seen to move and stopped within the page: on a slow machine the motion may be over between two
    # calls from here. A frame adds at most 0.1 s of the clock, a quarter of that to the motion of 0.4 s.
    before, moved, word, stopped, later = page.execute_async_script("""
        const done = arguments[arguments.length - 1], of = (id) => document.getElementById(id);
        const frame = () => new Promise((resume) => requestAnimationFrame(resume));
        const picture = () => of('scene').toDataURL();
        (async () => {
          of('scrub').value = 0; of('scrub').dispatchEvent(new Event('input'));
          const before = picture(), clock = of('clock').textContent;
          of('play').click();
          while (of('clock').textContent === clock) await frame();
          const moved = picture();
          of('play').click();
          const stopped = of('clock').textContent;
          for (let i = 0; i < 5; ++i) await frame();
          done([before, moved, of('play').textContent, stopped, of('clock').textContent]);
        })();""")
    assert moved != before, "the hoop is elsewhere"
    assert "play" in word and later == stopped
    page.execute_script(
        "const s = document.getElementById('scrub'); s.value = s.max; s.dispatchEvent(new Event('input'))")
    last = pixels(page, "scene")
    told = told_by_leapmap(page)
    # The motion ends with the landing of the jump.
    assert float(page.find_element("id", "clock").text.split()[0]) == pytest.approx(
        told["jump_time"] + told["flight_time"], abs=6e-4)
    page.execute_script(
        "const s = document.getElementById('scrub'); s.value = 0; s.dispatchEvent(new Event('input'))")
    assert pixels(page, "scene") != last and page.find_element("id", "clock").text == "0.000 s"


@pytest.mark.slow
def test_the_motion_shown_is_that_of_leapmap_s_trace(page, tmp_path):
    point(page, [20, 30, 1], click=True)
    motion = page.execute_script("""const e = window.explorer, d = {...e.map.fixed};
        e.map.axes.forEach((a, k) => { d[a.name] = a.values[[20, 30, 1][k]]; });
        const m = e.solver.solve(d, false, 1e-10, 1e-3).motion;
        return Object.fromEntries(Object.entries(m).map(([k, v]) => [k, [...v]]))""")
    words = shlex.split(page.find_element("id", "command").text)
    leapmap(*words[1:], "--trace", tmp_path / "trace.h5")
    with h5py.File(tmp_path / "trace.h5") as file:
        for name in ("t", "phi", "spin", "x", "y", "normal_force", "friction", "phase"):
            # As far as roundings of another machine go, on quantities up to 50.
            assert np.allclose(motion[name], file[name][()], rtol=1e-8, atol=1e-9), name


@pytest.mark.slow
def test_one_animation_runs_however_many_designs_were_clicked(motion_wanted, page):
    for i in range(6):
        point(page, [20, 25 + i, 1], click=True)
    drawn = page.execute_async_script("""const done = arguments[0],
          context = CanvasRenderingContext2D.prototype, arc = context.arc;
        let arcs = 0, frames = 0;
        context.arc = function (...a) { ++arcs; return arc.apply(this, a); };
        const count = () => { if (++frames < 20) requestAnimationFrame(count); else { context.arc = arc;
        done(arcs / frames); } };
        requestAnimationFrame(count);""")
    assert 1 <= drawn <= 2.5, "the hoop and its mass are two arcs a picture"


@pytest.mark.slow
def test_a_run_of_a_thousand_turns_is_shown_too(browser, tmp_path):
    path = sweep(
        tmp_path,
        '[scene]\nrunway = 1000\nhop_height = 100\n[design]\nslope = { values = [0.1, 0.2] }\nmass_ratio = { '
        'values = [0.05, 0.1] }\n'
        '[output]\nfields = ["status", "first_jump_height"]\n')
    opened(browser, made(path))
    assert numbers(browser)["status"] == "no_jump"
    motion = browser.execute_script(
        "return [...window.explorer.solver.solve({...window.explorer.map.fixed, slope: 0.1, mass_ratio: "
        "0.05}, false, 1e-10).motion.x]"
    )
    assert 1000 < len(motion) <= 4200 and motion[-1] == pytest.approx(2 * np.pi * 1000 * 0.041, rel=1e-3)


def test_the_readout_goes_back_to_the_design_shown_when_the_pointer_leaves_the_map(page):
    point(page, [20, 30, 1], click=True)
    point(page, [40, 10, 1])
    assert readout(page)["index"] == "40,10,1"
    ActionChains(page).move_to_element(page.find_element("id", "title")).perform()
    assert readout(page)["index"] == "20,30,1"


def test_keys_move_from_design_to_design_and_show_one(page):
    point(page, [20, 30, 1])
    canvas = page.find_element("id", "map")
    page.execute_script("arguments[0].focus()", canvas)
    canvas.send_keys(Keys.ARROW_RIGHT, Keys.ARROW_UP, Keys.ARROW_UP, Keys.ARROW_LEFT, Keys.ARROW_LEFT)
    assert readout(page)["index"] == "19,32,1"
    canvas.send_keys(Keys.SHIFT + Keys.ARROW_RIGHT)
    assert readout(page)["index"] == "29,32,1"
    canvas.send_keys(Keys.ENTER)
    assert agrees(numbers(page), told_by_leapmap(page)) >= 9


@pytest.mark.slow
def test_the_field_the_axes_and_the_layer_can_be_chosen(page, map_file):
    before = pixels(page, "map")
    Select(page.find_element("id", "field")).select_by_visible_text("time from release to the jump [s]")
    assert pixels(page, "map") != before
    point(page, [20, 30, 1])
    with h5py.File(map_file) as file:
        assert float(readout(page)["value"]) == pytest.approx(file["jump_time"][20, 30, 1], abs=6e-5)
    Select(page.find_element("id", "x-axis")).select_by_visible_text("offset ratio L/R")
    assert page.find_element("css selector", "#sliders input").get_attribute("data-axis") == "slope"
    point(page, [20, 5, 0])
    assert readout(page)["index"].endswith(",5,0")


@pytest.mark.slow
def test_radius_and_mass_scale_the_numbers(page):
    point(page, [20, 30, 1], click=True)
    page.execute_script(
        "const m = document.getElementById('mass'); m.value = 28.2; m.dispatchEvent(new Event('change'))")
    before = numbers(page)
    page.execute_script(
        "const r = document.getElementById('radius'); r.value = 164; r.dispatchEvent(new Event('change'))")
    page.execute_script(
        "const m = document.getElementById('mass'); m.value = 56.4; m.dispatchEvent(new Event('change'))")
    after = numbers(page)
    assert float(after["jump_height"]) == pytest.approx(float(before["jump_height"]), rel=1e-9)
    assert float(after["jump_time"]) == pytest.approx(2 * float(before["jump_time"]),
                                                      rel=1e-9), "times grow with the root of the radius"
    assert float(after["agility"]) == pytest.approx(2 * float(before["agility"]), rel=1e-9)
    assert float(after["most_normal_force"]) == pytest.approx(2 * float(before["most_normal_force"]),
                                                              rel=1e-6), "forces with the mass"
    assert told_by_leapmap(page)["scene"]["radius"] == 0.164
    assert agrees(after, told_by_leapmap(page)) >= 9


def test_what_is_no_radius_is_said_so_and_changes_nothing(page):
    point(page, [20, 30, 1], click=True)
    before = numbers(page)
    for wrong in ("0", "-5", ""):
        page.execute_script(
            "const r = document.getElementById('radius'); r.value = arguments[0]; r.dispatchEvent(new "
            "Event('change'))",
            wrong)
        assert "above 0" in page.find_element("id", "message").text and numbers(page) == before
    page.execute_script(
        "const r = document.getElementById('radius'); r.value = 41; r.dispatchEvent(new Event('change'))")
    assert page.find_element("id", "message").text == ""


@pytest.mark.slow
def test_an_address_opens_a_design_at_a_moment_and_says_if_there_is_none(motion_wanted, page, map_file):
    address = map_file.with_suffix(".html").as_uri()
    for place, index, text in (("#design=7,8,0&time=0.1", "7,8,0", ""), ("#design=999,8,0", None,
                                                                         "not on this map")):
        page.get("about:blank")
        page.get(address + place)
        waited(page, lambda b: b.execute_script("return !!window.explorer"))
        assert index in (None, readout(page)["index"]) and text in page.find_element("id", "message").text
        if index:
            assert page.find_element("id", "clock").text == "0.100 s"
            assert "play" in page.find_element("id", "play").text


@pytest.mark.slow
def test_slow_and_swift_hoops_are_sampled_as_a_picture_needs(page):
    for spin in (1e-6, 1.0, 1e4):
        motion = page.execute_script("""const e = window.explorer;
            const m = e.solver.solve({...e.map.fixed, slope: 0, mass_ratio: 0, release_angle: 0,
              release_spin: arguments[0]}, false, 1e-10).motion;
            return {t: [...m.t], phi: [...m.phi]}""", spin)
        assert 390 <= len(motion["t"]) <= 4100 and motion["phi"][-1] == pytest.approx(10 * np.pi, rel=5e-3)


@pytest.mark.slow
def test_the_papers_hoop_can_be_shown_whether_or_not_it_is_on_the_grid(page):
    page.find_element("id", "paper").click()
    assert page.execute_script("return location.hash") == "#paper"
    told = told_by_leapmap(page)
    assert told["jump_height"] == pytest.approx(0.98280096607, abs=1e-10)
    assert agrees(numbers(page), told) >= 9


def test_a_map_with_friction_shows_sliding(browser, tmp_path):
    path = sweep(
        tmp_path,
        '[scene]\nfriction = "coulomb"\nmu_static = { values = [0.2, 0.5] }\nrestitution = 0.3\n[design]\n'
        'slope = { from = "10 deg", to = "40 deg", count = 13 }\nmass_ratio = { from = 1, to = 10, count = '
        '12 }\n[numerics]\naudit = 0\n'
    )
    opened(browser, made(path))
    with h5py.File(path) as file:
        jumped = np.argwhere(file["status"][()] == 1)
        order = [d[0].name.lstrip("/") for d in file["status"].dims]
    index = [int(i) for i in jumped[len(jumped) // 2]]
    select_layer(browser, index[order.index("mu_static")])
    point(browser, index, click=True)
    told = told_by_leapmap(browser)
    assert told["scene"]["friction"] == "coulomb" and "S" in told["phase_sequence"]
    assert agrees(numbers(browser), told) >= 10


def test_the_page_fits_a_phone_and_a_screenshot_is_kept(page):
    ARTEFACTS.mkdir(exist_ok=True)
    point(page, [20, 30, 1], click=True)
    time.sleep(0.5)
    assert page.save_screenshot(str(ARTEFACTS / "explorer.png"))
    try:
        page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                             {"width": 360, "height": 800, "deviceScaleFactor": 2, "mobile": True})
        time.sleep(0.5)
        # Chromium's window is 500 px wide at least; what counts is that nothing is wider than it.
        assert page.execute_script("return document.documentElement.scrollWidth <= 360")
        assert page.execute_script(
            "return document.getElementById('map').getBoundingClientRect().bottom < "
            "document.getElementById('scene').getBoundingClientRect().top"
        )
        page.save_screenshot(str(ARTEFACTS / "explorer_phone.png"))
        page.execute_script("window.scrollTo(0, 0)")
        point(page, [10, 35, 1], click=True)
        # A tap on the map brings the hoop, which is further down, into sight.
        waited(page, lambda b: 0 <= b.execute_script(
            "return document.getElementById('scene').getBoundingClientRect().top") < 800)
        page.execute_script("window.scrollTo(0, 0)")
    finally:
        page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


@pytest.mark.parametrize(
    "slopes, most_bytes",
    [(25, 1_300_000), pytest.param(241, 3_000_000, marks=pytest.mark.slow)])
def test_the_page_needs_no_network_and_stays_below_three_megabytes(slopes, most_bytes, tmp_path):
    path = sweep(tmp_path, f"""[design]
slope = {{ from = "2 deg", to = "50 deg", count = {slopes} }}
mass_ratio = {{ from = 0.1, to = 20, count = 256, scale = "log" }}
offset_ratio = {{ values = [0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0] }}
[numerics]
audit = 0
""")
    html = made(path)
    assert html.stat().st_size < most_bytes
    # Names of XML's that d3 has; nothing is fetched by them.
    text = re.sub(r"http://www\.w3\.org/(1999/xhtml|2000/svg|1999/xlink|XML/1998/namespace|2000/xmlns/)", "",
                  html.read_text())
    assert "http://" not in text and "https://" not in text and "default-src 'none'" in text


HOSTILE = "</script><script>window.pwned = 1</script><img src=x onerror='window.pwned = 1'>%%SCRIPT%%<!--"


def test_a_hostile_map_is_data_and_nothing_else(browser, map_file, tmp_path):
    path = tmp_path / f"{HOSTILE.replace('/', '')[:60]}.h5"
    path.write_bytes(map_file.read_bytes())
    with h5py.File(path, "a") as file:
        for name in ("title", "program_version", "git_revision", "host"):
            file.attrs[name] = HOSTILE
        file["status"].attrs["flag_meanings"] = " ".join(f"{HOSTILE.replace(' ', '')}{i}" for i in range(7))
    opened(browser, made(path))
    assert browser.execute_script("return window.pwned === undefined")
    assert browser.find_element("id", "title").text == HOSTILE
    point(browser, [3, 2, 1], click=True)
    assert browser.execute_script("return window.pwned === undefined && document.images.length === 0")


def broken(path, tmp_path, change):
    copy = tmp_path / "broken.h5"
    copy.write_bytes(path.read_bytes())
    with h5py.File(copy, "a") as file:
        change(file)
    return copy


def with_value(name, value):
    def change(file):
        file[name][(3,) * file[name].ndim if file[name].ndim == 1 else (3, 2, 1)] = value
    return change


def with_dataset(name, value):
    def change(file):
        del file[name]
        file[name] = value
    return change


def with_attribute(name, value, of="/"):
    def change(file):
        if value is None:
            del file[of].attrs[name]
        else:
            file[of].attrs[name] = value
    return change


def with_spec(old, new):
    def change(file):
        assert old in file.attrs["spec"]
        file.attrs["spec"] = file.attrs["spec"].replace(old, new)
    return change


BROKEN = {
    "an axis with a NaN": with_value("slope", np.nan),
    "an axis with an infinity": with_value("slope", np.inf),
    "an axis with the same value twice": lambda file: file["slope"].__setitem__(3, file["slope"][4]),
    "a field of another shape": with_dataset("jump_time", np.zeros(7)),
    "a field of texts": with_dataset("jump_height", ["high"] * 3),
    "a field beyond all bounds": with_value("jump_height", 1e308),
    "no spec": with_attribute("spec", None),
    "a spec that is no text": with_attribute("spec", 5),
    "a spec of bytes": with_attribute("spec", np.bytes_(b"radius = 1")),
    "no radius": with_spec("radius", "diameter"),
    "a radius below zero": with_spec("radius = ", "radius = -"),
    "a gravity of zero": with_spec("gravity = 9.81", "gravity = 0.0"),
    "a runway that is none": with_spec("runway = 5.0", "runway = nan"),
    "codes without a meaning": with_attribute("flag_meanings", 5, "status"),
    "codes with texts for values": with_attribute("flag_values", "0 1 2 3 4 5 6", "status"),
    "codes beyond all bounds": with_attribute("flag_values",
                                              np.arange(7) * 50_000_000, "status"),
    "tiles that are no number": with_attribute("tiles_done", "x"),
    "no version": with_attribute("version", None),
}


# One reader serves all scripts: the explorer meets every kind, the others some.
KINDS = [("explorer", kind) for kind in BROKEN
         ] + [(script, kind)
              for script in ("design_chart.py", "status_chart.py", "cut_chart.py")
              for kind in ("an axis with an infinity", "a field of texts", "a spec of bytes")]


@pytest.mark.slow
def test_of_hoops_as_made_the_yield_is_a_field_and_twenty_ghosts_jump_along(browser, tmp_path):
    spec = """
[design]
slope = { from = "15 deg", to = "27 deg", count = 25 }
mass_ratio = { from = 2, to = 6, count = 21 }
[scatter]
slope = { normal = "1 deg" }
offset_ratio = { normal = 0.05 }
samples = 128
[goal]
jump_height = { at_least = 0.8 }
status = { is = "jumped" }
spurious_first_jump = { is = 1 }
[output]
fields = ["jump_height"]
"""
    path = sweep(tmp_path, spec)
    opened(browser, made(path))
    fields = browser.execute_script(
        "return window.explorer.map.fields.map(f => ({name: f.name, made: f.made, values: [...f.values]}))")
    yields = next(f for f in fields if f["name"] == "yield")
    with h5py.File(path) as f:
        assert yields["made"]
        assert np.allclose(np.reshape(yields["values"], (25, 21)), f["yield"][()], atol=1e-4)
        where = tuple(int(i) for i in np.argwhere(np.abs(f["yield"][()] - 0.5) < 0.2)[0])
        share = f["yield"][()][where]
    point(browser, where, click=True)
    before = pixels(browser, "scene")
    browser.execute_script(
        "const s = document.getElementById('scrub'); s.value = s.max / 2; s.dispatchEvent(new Event('input'))"
    )
    alone = pixels(browser, "scene")
    browser.find_element("id", "ghosts").click()
    waited(browser, lambda b: "reach every goal" in b.find_element("id", "ghosts-told").text)
    assert pixels(browser, "scene") != alone != before
    told = browser.find_element("id", "ghosts-told").text
    jump, reach = int(told.split(" of ")[0].split()[-1]), int(told.split(", ")[1].split()[0])
    assert jump == 20 and abs(reach / 20 - share) < 4 * math.sqrt(0.25 / 20), told
    browser.find_element("id", "ghosts").click()
    waited(browser, lambda b: pixels(b, "scene") == alone)
    assert browser.find_element("id", "ghosts-told").text == ""


@pytest.mark.slow
def test_a_map_of_hoops_as_drawn_has_no_ghosts(page):
    assert not page.find_element("id", "ghosts-label").is_displayed()


@pytest.mark.slow  # its twin is of the charts, by the same rule
def test_pixels_beside_a_cliff_are_of_the_side_they_are_on(browser, tmp_path):
    spec = SPEC.replace("offset_ratio = { values = [0.6, 1.0] }", "offset_ratio = 1.0")
    path = sweep(tmp_path, spec)
    right = {}
    for crisp in (False, True):
        if crisp:
            assert leapmap("boundaries", path, "-o", tmp_path / "map.cliffs.h5").returncode == 0
        opened(browser, made(path))
        shown = browser.execute_script("return window.explorer.view.shown()")
        slopes, ratios = np.radians(shown["x"]), np.array(shown["y"])
        rng = np.random.default_rng(3)
        rows, columns = rng.integers(0, len(ratios), 1000), rng.integers(0, len(slopes), 1000)
        (tmp_path / "pixels.csv").write_text("slope,mass_ratio\n" + "".join(f"{slopes[c]!r},{ratios[r]!r}\n"
                                                                            for r, c in zip(rows, columns)))
        sweep(tmp_path, '[design]\npoints = "pixels.csv"\n[numerics]\naudit = 0\n', "--overwrite",
              name="pixels.h5")
        codes = []
        for name in ("map.h5", "pixels.h5"):
            with h5py.File(tmp_path / name) as f:
                codes.append(np.where(f["status"][()] == 1, f["spurious_first_jump"][()], 9).ravel())
        design = np.array(shown["design"]).reshape(len(ratios), len(slopes))[rows, columns]
        right[crisp] = (codes[0][design] == codes[1]).mean()
    # Bands narrower than a cell are not seen, and so some pixels stay wrong.
    assert right[True] > 0.985 and 1 - right[True] < 0.5 * (1 - right[False]), right


@pytest.mark.parametrize("script,kind", [*KINDS, ("status_chart.py", "codes without a meaning")])
def test_a_broken_map_is_refused_with_one_line_that_names_it(script, kind, map_file, tmp_path):
    path = broken(map_file, tmp_path, BROKEN[kind])
    done = scripted(script, path, "-o", tmp_path / "x.html")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and str(path) in done.stderr, done.stderr
    assert not (tmp_path / "x.html").exists()


def test_files_that_are_no_grids_are_refused_with_one_line_that_says_what_to_do(map_file, tmp_path):
    (tmp_path / "words.h5").write_text("words")
    one_axis = sweep(tmp_path, "[design]\nslope = { from = 0.1, to = 0.2, count = 20001 }\n")
    for path, word in ((tmp_path / "words.h5", "HDF5"), (tmp_path / "nowhere.h5", "does not exist"),
                       (one_axis, "two axes or more")):
        done = explorer(path, "-o", tmp_path / "x.html")
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and word in done.stderr, done.stderr
    done = scripted("explorer", map_file, "-o", tmp_path / "x.html", "--module", tmp_path / "no.wasm")
    assert done.returncode == 2 and "leapmap-wasm" in done.stderr, done.stderr
    only_status = sweep(tmp_path, SPEC + '[output]\nfields = ["status"]\n', name="status.h5")
    done = explorer(only_status, "-o", tmp_path / "x.html")
    assert done.returncode == 2, done.stderr
    assert "output.fields" in done.stderr, done.stderr
    assert "jump_height" in done.stderr, done.stderr
    small = explorer(map_file, "-o", tmp_path / "x.html", "--most", "0.1")
    assert small.returncode == 2 and "--most" in small.stderr
    size = 0.97e-6 * made(map_file).stat().st_size
    fewer = explorer(map_file, "-o", tmp_path / "x.html", "--most", size)
    assert fewer.returncode == 0 and "left out" in fewer.stderr
    assert (tmp_path / "x.html").stat().st_size < 1e6 * size


def test_a_list_of_designs_is_a_dot_each_that_can_be_pointed_at_and_clicked(browser, tmp_path):
    (tmp_path /
     "designs.csv").write_text('label,slope,mass_ratio\n"thick, <b>",0.4,3\nlight,23 deg,1\nflat,1 deg,0.1\n')
    path = sweep(tmp_path, '[design]\npoints = "designs.csv"\n')
    opened(browser, made(path))
    with h5py.File(path) as m:
        heights = m["jump_height"][()]
    assert not browser.find_element("id", "y-axis").is_displayed()
    assert [option.text for option in Select(browser.find_element("id", "x-axis")).options][:3] == [
        "slope", "mass ratio mₚ/m", "number in the list, from 0"]
    for number, place in ((0, "thick, <b>: slope 22.92°, mₚ/m 3"), (1, "light: slope 23°, mₚ/m 1")):
        point(browser, [number], click=True)
        assert browser.find_element("id", "place").text.startswith(place)
        assert float(readout(browser)["value"]) == pytest.approx(heights[number], abs=1e-4)
        agrees(numbers(browser), told_by_leapmap(browser))
    assert np.isnan(heights[2])
    point(browser, [2])
    assert "no jump" in browser.find_element("id", "value").text
    Select(browser.find_element("id", "x-axis")).select_by_visible_text("mass ratio mₚ/m")
    point(browser, [0], click=True)
    assert readout(browser)["index"] == "0"


@pytest.mark.slow  # its twin is of a list
def test_a_front_stands_as_it_was_asked_for_and_each_of_its_designs_jumps(browser, tmp_path):
    (tmp_path / "q.toml").write_text(
        '[design]\nslope = { from = "5 deg", to = "20 deg" }\nmass_ratio = { from = 0.5, to = 10, scale = '
        '"log" }\n'
        '[goal]\nmaximize = ["jump_height"]\nminimize = ["jump_time"]\n')
    path = tmp_path / "front.h5"
    assert leapmap("design", tmp_path / "q.toml", "--sample", "20000", "-o", path).returncode == 0
    opened(browser, made(path))
    with h5py.File(path) as m:
        heights, times = m["jump_height"][()], m["jump_time"][()]
    chosen = lambda name: Select(browser.find_element("id", name)).first_selected_option.text
    assert chosen("x-axis").startswith("time from release to the jump")
    assert chosen("field").startswith("jump height")
    places = browser.execute_script(
        "return window.explorer.map.axes[0].values.map((_, i) => window.explorer.view.placeOf([i]))")
    x, y = np.array(places).T
    assert np.corrcoef(x, times)[0, 1] > 0.9999 and np.corrcoef(
        -y, heights)[0, 1] > 0.9999, "the second objective to the right, the first up"
    for number in (0, len(heights) // 2, len(heights) - 1):
        point(browser, [number], click=True)
        assert float(readout(browser)["value"]) == pytest.approx(heights[number], abs=1e-4)
        agrees(numbers(browser), told_by_leapmap(browser))


@pytest.mark.slow
@pytest.mark.parametrize("friction", ["", pytest.param('[scene]\nfriction = "coulomb"\nmu_static = 0.9\n',
                                                       marks=pytest.mark.slow)])
def test_driven_hoops_and_those_that_turn_round_move_as_leapmap_tells(browser, tmp_path, friction):
    path = sweep(
        tmp_path, friction +
        '[design]\nslope = { values = ["-10 deg", "15 deg"] }\ndrive_torque = { values = [0.0, 0.75] }\n'
        'release_spin = { values = [-0.8, 0.0] }\nrelease_angle = "170 deg"\n')
    opened(browser, made(path))
    backwards = 0
    for index in ([0, 0, 0], [0, 1, 1], [1, 0, 0], [1, 1, 0]):
        browser.execute_script("window.explorer.view.view.index = arguments[0]; window.explorer.view.pick()",
                               index)
        agrees(numbers(browser), told_by_leapmap(browser))
        backwards += told_by_leapmap(browser)["design"]["release_spin"] < 0
        assert browser.find_element("id", "message").text == ""
    assert backwards == 3


@pytest.mark.slow  # its twin is of a list
def test_a_grid_over_one_axis_is_dots_too(browser, tmp_path):
    path = sweep(tmp_path, "[design]\nslope = { from = 0.2, to = 0.8, count = 25 }\n")
    opened(browser, made(path))
    point(browser, [12], click=True)
    assert browser.find_element("id", "place").text == "slope 28.65°"
    agrees(numbers(browser), told_by_leapmap(browser))


def test_a_damaged_page_says_so(browser, map_file, tmp_path):
    text = made(map_file).read_text()
    start = text.index('"data": "') + 9
    (tmp_path / "cut.html").write_text(text[:start] + "eJwDAAAAAAE=" + text[text.index('"', start):])
    browser.get((tmp_path / "cut.html").as_uri())
    waited(browser, lambda b: b.find_element("id", "message").text != "")
    assert "cannot be shown" in browser.find_element("id", "message").text


@pytest.mark.slow
def test_an_unfinished_map_says_how_much_of_it_is_there(browser, map_file, tmp_path):
    path = tmp_path / "stopped.h5"
    path.write_bytes(map_file.read_bytes())
    with h5py.File(path, "a") as file:
        file.attrs["tiles_done"] = 0
    opened(browser, made(path))
    assert "INCOMPLETE" in browser.find_element("id", "subtitle").text


@pytest.mark.slow
def test_a_hoop_goes_on_jumping_as_leapmap_hop_tells(page):
    index = page.execute_script("""const { map, solver } = window.explorer,
          axes = map.axes.map((a) => a.values);
        for (let i = 0; i < axes[0].length; i += 3) for (let j = 0; j < axes[1].length; j += 3) {
          const design = {...map.fixed, slope: axes[0][i], mass_ratio: axes[1][j], offset_ratio: axes[2][1]};
          if (solver.solve(design, false, 1e-10, 0, { jumps: 4 }).outcome.jumps >= 3) return [i, j, 1];
        }""")
    select_layer(page, 1)
    point(page, index, click=True)
    page.execute_script(
        "const j = document.getElementById('jumps'); j.value = 4; j.dispatchEvent(new Event('change'))")
    try:
        told = told_by_leapmap(page)
        words = page.find_element("id", "command").text.split()
        assert words[words.index("--jumps") + 1] == "4"
        heights = [told["jump_height"], *(told[f"jump_height_{k}"] for k in range(2, told["jumps"] + 1))]
        assert told["jumps"] >= 2
        shown = page.find_element("css selector", "tr[data-name='jumps'] td").text
        made, listed = shown.split(": ")
        assert made == f"{told['jumps']} of 4"
        assert [float(w.removesuffix(" mm")) for w in listed.split(", ")] == pytest.approx(
            [82 * h for h in heights], rel=6e-4)
        landed, end = page.execute_script("""const { solver, map } = window.explorer,
              story = solver.solve({...map.fixed, ...arguments[0]}, false, 1e-10, 0, { jumps: 4 });
            const { time, flight_time, is_jump } = story.liftOffs, k = is_jump.lastIndexOf(1);
            return [time[k] + flight_time[k], story.motion.t.at(-1)]""", told["design"])
        # the motion goes on to the last landing
        assert end >= landed - 1e-9 > told["jump_time"] + told["flight_time"]
    finally:
        page.execute_script(
            "const j = document.getElementById('jumps'); j.value = 0; j.dispatchEvent(new Event('change'))")
        assert "whole number" in page.find_element("id", "message").text
        page.execute_script(
            "const j = document.getElementById('jumps'); j.value = 1; j.dispatchEvent(new Event('change'))")
    assert page.find_element("id", "message").text == ""
    assert "--jumps" not in page.find_element("id", "command").text


@pytest.mark.slow
def test_bifurcations_are_of_the_jumps_that_leapmap_hop_tells(page):
    """Three jumps after the second of some hoops, with and without slip."""
    compared = 0
    for slips in (False, True):
        heights = page.execute_script("""const s = window.explorer.solver;
            return Array.from(s.bifurcate({...s.defaults, mass_ratio: 3, offset_ratio: 0.6, mu_static: 0.7,
              runway: 30}, arguments[0], 1e-10,
              { parameter: "slope", from: 0.1, to: 0.4, count: 7, settle: 2, keep: 3 }), String)""", slips)
        for i in range(7):
            told = json.loads(
                finished(PROGRAM, "hop", "--slope", str(0.1 + 0.05 * i), "--mass-ratio", 3, "--offset-ratio",
                         0.6, "--jumps", 5, "--set", "runway=150", "--json",
                         *(["--set", "friction=coulomb", "--mu-static", 0.7] if slips else [])).stdout)
            for k in range(3):
                expected, found = told[f"jump_height_{3 + k}"], float(heights[3 * i + k])
                assert (expected is None) == math.isnan(found), (slips, i, k)
                if expected is not None:
                    # slopes are one rounding apart, and errors grow
                    assert found == pytest.approx(expected, rel=1e-7)
                    compared += 1
    assert compared >= 20


@pytest.mark.slow  # its twin is of the jumps, above
def test_the_bifurcation_picture_is_drawn_once_it_is_opened(page):
    picture = page.find_element("id", "gaits-picture")
    assert picture.get_attribute("data-hoops") is None, "nothing is computed before anybody asks"
    page.execute_script("document.getElementById('gaits').open = true")
    waited(page, lambda b: picture.get_attribute("data-hoops") == "512")
    lively = int(picture.get_attribute("data-lively"))
    assert 50 < lively < 512 and f"{lively} of 512" in page.find_element("id", "gaits-told").text
    Select(page.find_element("id", "gaits-over")).select_by_value("offset_ratio")
    waited(page, lambda b: picture.get_attribute("data-hoops") == "512" and picture.
                                  get_attribute("data-lively") != str(lively))
    ActionChains(page).move_to_element_with_offset(picture, 0, 0).click().perform()
    assert "L/R" in page.find_element("id", "hop-title").text or "offset" in page.find_element(
        "id", "hop-title").text.lower()
    page.execute_script(
        "const f = document.getElementById('gaits-from'); f.value = -3; f.dispatchEvent(new Event('change'))")
    assert "between" in page.find_element("id", "gaits-told").text
    page.execute_script("document.getElementById('gaits').open = false")


@pytest.mark.slow  # its twin types hoops, in test_page_parts.py
def test_the_solver_on_the_page_is_as_good_as_the_program_on_random_designs(page):
    """A hundred designs with and without slip, through the page's WebAssembly and through leapmap hop."""
    random = np.random.default_rng(7)
    for k in range(100):
        slips = k % 2 == 1
        design = {
            "slope": random.uniform(0.1, 0.8), "mass_ratio": random.uniform(0.3, 10),
            "offset_ratio": random.uniform(0.3, 1), "release_angle": random.uniform(2.6, 4.4),
            "mu_static": random.uniform(0.1, 1.0), "restitution": random.uniform(0, 0.5)
        }
        outcome = page.execute_script("""const s = window.explorer.solver;
            const o = s.solve({...s.defaults, ...arguments[0]}, arguments[1], 1e-10, 0).outcome;
            return Object.fromEntries(Object.entries(o).map(([k, v]) => [k, String(v)]))""", design, slips)
        flags = [
            w for name, value in design.items() if slips or name not in ("mu_static", "restitution")
            for w in (f"--{name.replace('_', '-')}", repr(float(value)))
        ]
        told = json.loads(
            finished(PROGRAM, "hop", *flags, "--json",
                     *(["--set", "friction=coulomb"] if slips else [])).stdout)
        assert outcome["status"] == told["status"], design
        assert agrees(outcome, told) >= 10


@pytest.mark.slow
@pytest.mark.parametrize("key, values", [("hoop.slug.mass", ("40 g", "160 g")),
                                         ("hoop.diameter", ("100 mm", "180 mm"))])
def test_a_design_of_a_map_over_the_hoop_jumps_as_leapmap_tells(key, values, browser, tmp_path):
    spec = TOP / "sweeps" / "drawing.toml"
    low, high = values
    done = leapmap("sweep", spec, "--set", 'slope={from="15 deg",to="40 deg",count=6}', f"--{key}",
                   f'{{from="{low}",to="{high}",count=7}}', "-o", tmp_path / "m.h5", "--quiet")
    assert done.returncode == 0, done.stderr
    assert explorer(tmp_path / "m.h5", "-o", tmp_path / "m.html").returncode == 0
    opened(browser, tmp_path / "m.html")
    browser.execute_script("const { view, pick } = window.explorer.view; view.index = [4, 5]; pick()")
    shown = numbers(browser)
    with h5py.File(tmp_path / "m.h5") as m:
        names = list(m["jump_height"].dims[k][0].name.strip("/") for k in range(2))
        at = dict(zip(names, (m[names[0]][4], m[names[1]][5])))
        own = {name: m[name][4, 5] for name in ("jump_height", "jump_time")}
    told = json.loads(
        leapmap("hop", spec, "--slope", at["slope"], "--set", f"{key}={at[key]!r}", "--json").stdout)
    for name in own:
        assert float(shown[name]) == pytest.approx(told[name], rel=1e-9) == pytest.approx(own[name], rel=1e-9)
    assert float(browser.find_element("id", "mass").get_attribute("value")) == pytest.approx(
        1000 * told["scene"]["mass"], rel=1e-9)
    assert float(browser.find_element("id", "radius").get_attribute("value")) == pytest.approx(
        1000 * told["scene"]["radius"], rel=1e-9)


@pytest.mark.slow
def test_tolerances_of_a_drawing_go_with_it(browser, tmp_path):
    """A hoop of other numbers has its yield; one of another drawing, which lacks what scatters, has none."""
    path = sweep(
        tmp_path, """
[design]
slope = { from = "25 deg", to = "35 deg", count = 3 }
[hoop]
diameter = "120 mm"
mass = "61 g"
[[hoop.weight]]
name = "slug"
mass = "85 g"
at = "47 mm"
[tolerances]
hoop.slug.mass = { normal = "4 g" }
samples = 64
[goal]
jump_height = { at_least = 0.56 }
""")
    done = scripted("explorer", path, "--module", MODULE, "-o", tmp_path / "page.html")
    assert done.returncode == 0, done.stderr
    opened(browser, tmp_path / "page.html")
    give = lambda where, value: browser.execute_script(
        """const field = document.querySelector(arguments[0]);
        field.value = arguments[1];
        field.dispatchEvent(new Event("change"))""", where, value)
    browser.execute_script("""document.getElementById('drawing').open = true;
        const { view, pick } = window.explorer.view; view.index = [1]; pick()""")
    browser.find_element("id", "ghosts").click()
    waited(browser, lambda b: "reach every" in b.find_element("id", "ghosts-told").text)
    reach = lambda: int(browser.find_element("id", "ghosts-told").text.split("jump, ")[1].split()[0])
    counted = lambda b: "reach every" in b.find_element("id", "ghosts-told").text
    assert 0 < reach() < 20, "each has a slug of its own"
    give("#hoop-inputs input[data-parameter=offset_ratio]", "0.7")  # a hoop of no drawing that is known
    assert "this hoop's drawing lacks hoop.slug.mass" in browser.find_element("id", "ghosts-told").text
    browser.execute_script("const { view, pick } = window.explorer.view; view.index = [1]; pick()")
    give("[data-drawn='ring.mass']", "62")
    waited(browser, counted)
    assert 0 < reach() < 20
    assert "mass" in browser.find_element("id", "drawing-spec").get_property("textContent")
