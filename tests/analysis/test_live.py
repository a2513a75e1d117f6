# SPDX-License-Identifier: GPL-3.0-or-later
"""The live map in a real browser: every number is leapmap's own, whatever one turns."""
import json
import math
import os
from pathlib import Path

import h5py
import numpy as np
import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select
from support.browser import agrees, numbers, opened, settled, told_by_leapmap, waited
from support.program import TOP, leapmap, scripted, sweep

MODULE = Path(os.environ["LEAPMAP_BUILD"]) / "leapmap.wasm"
TOLD = ("jump_height", "jump_time", "first_jump_height", "first_jump_time", "jump_angle", "jump_spin",
        "apex_time", "flight_time", "jump_distance", "candidates")


def page_at(folder, *arguments):
    done = scripted("explorer", *arguments, "--module", MODULE, "-o", folder / "live.html")
    assert done.returncode == 0, done.stderr
    return folder / "live.html"


@pytest.fixture
def live(browser, tmp_path):
    browser.get("about:blank")
    opened(browser, page_at(tmp_path))
    settled(browser)
    return browser


def type_in(browser, name, text):
    """Types a number into a parameter's field, as a person would."""
    field = browser.find_element("css selector", f"#live-sliders input[type=number][data-parameter={name}]")
    browser.execute_script("document.getElementById('map').dataset.whole = 'false'")
    field.clear()
    field.send_keys(text, Keys.TAB)


def designs(browser, cells):
    """The designs of some cells with all that the page tells of them."""
    return browser.execute_script("""const { map } = window.explorer, ny = map.axes[1].values.length;
        return arguments[0].map((k) => ({
          design: {...map.fixed, [map.axes[0].name]: map.axes[0].values[Math.floor(k / ny)],
            [map.axes[1].name]: map.axes[1].values[k % ny]},
          slips: map.slips, status: map.codes.status.meanings[map.codes.status.values[k]],
          told: Object.fromEntries(map.fields.map((f) => [f.name, String(f.values[k])])) }))""", cells)


def told_of(cell, *more):
    """What leapmap hop tells of a cell's design."""
    contact = ("mu_static", "mu_kinetic", "restitution", "rest_speed")
    flags = [
        w for name, v in cell["design"].items() if v is not None and (cell["slips"] or name not in contact)
        for w in ("--set", f"{name}={v!r}")
    ]
    done = leapmap("hop", *flags, *(["--set", "friction=coulomb"] if cell["slips"] else []), *more, "--json")
    assert done.returncode == 0, (cell, done.stderr)
    return json.loads(done.stdout)


def same_first_jump(cell, told):
    assert cell["status"] == told["status"], cell
    numbers = {name: text for name, text in cell["told"].items() if name in TOLD}
    if told["candidates"] == 0:
        numbers.pop("candidates")  # of which the map has a number where hop says none
    assert agrees(numbers, told) >= 9


def compare(browser, random, count):
    """Some cells against leapmap hop. Returns how many of them jump."""
    jumped = 0
    for cell in designs(browser, [int(k) for k in random.integers(0, 30000, count)]):
        told = told_of(cell)
        same_first_jump(cell, told)
        jumped += told["status"] == "jumped"
    return jumped


TYPED = (("offset_ratio", "0.62"), ("release_angle", "155.5"), ("inertia_factor", "0.8"),
         ("hop_height", "0.02"), ("release_spin", "0.4"), ("radius", "0.2"), ("gravity", "1.62"), ("runway",
                                                                                                   "3"))


@pytest.mark.parametrize("count", [5, pytest.param(20, marks=pytest.mark.slow)])
def test_every_number_is_that_of_leapmap_hop_whatever_is_typed(count, live):
    random = np.random.default_rng(5)
    jumped = compare(live, random, 2 * count)
    for name, text in TYPED if count == 20 else TYPED[::4]:
        type_in(live, name, text)
        settled(live)
        assert live.find_element("id", "message").text == ""
        jumped += compare(live, random, count)
    assert jumped >= 2 * count


@pytest.mark.slow  # its twin types hoops with friction, in test_page_parts.py
def test_with_friction_too(live):
    live.execute_script("document.getElementById('map').dataset.whole = 'false'")
    Select(live.find_element("id", "live-model")).select_by_value("coulomb")
    settled(live, 200)
    type_in(live, "mu_static", "0.55")
    settled(live, 200)
    assert compare(live, np.random.default_rng(6), 40) >= 8
    assert "friction=coulomb" in live.execute_script("return location.hash")
    assert "mu_static=0.55" in live.execute_script("return location.hash")
    assert "friction=coulomb" in live.find_element("id", "command").text


def test_a_coarse_map_is_there_long_before_the_whole_one(live):
    ratios = []
    for value in ("0.9", "0.7", "0.8"):
        type_in(live, "offset_ratio", value)
        settled(live)
        timing = live.execute_script("return window.explorer.timing")
        assert timing["designs"] == 30000
        ratios.append(timing["coarse"] / timing["full"])
    assert np.median(ratios) < 0.5


@pytest.mark.slow
def test_what_is_dragged_past_is_not_what_stays(live):
    live.execute_script(
        """const offset = "input[type=range][data-parameter=offset_ratio]";
        const slider = document.querySelector("#live-sliders " + offset);
        document.getElementById('map').dataset.whole = 'false';
        for (let k = 0; k < 40; ++k) { slider.value = 0.3 + 0.01 * k;
        slider.dispatchEvent(new Event('input')); }""")
    settled(live)
    assert live.execute_script("return window.explorer.map.fixed.offset_ratio") == pytest.approx(0.69)
    assert compare(live, np.random.default_rng(7), 12) >= 4


@pytest.mark.slow
def test_axes_can_be_any_two_parameters_with_bounds_of_ones_own(live):
    live.execute_script("document.getElementById('map').dataset.whole = 'false'")
    Select(live.find_element("id", "live-y")).select_by_value("release_angle")
    settled(live)
    assert live.execute_script("return window.explorer.map.axes.map((a) => a.name)") == [
        "slope", "release_angle"
    ]
    assert live.find_elements("css selector", "#live-sliders input[data-parameter=mass_ratio]")
    assert not live.find_elements("css selector", "#live-sliders input[data-parameter=release_angle]")
    compare(live, np.random.default_rng(8), 12)
    low = live.find_element("id", "live-y-from")
    low.clear()
    low.send_keys("500", Keys.TAB)
    assert "below to" in live.find_element("id", "message").text
    assert low.get_attribute("aria-invalid") == "true"
    low.clear()
    live.execute_script("document.getElementById('map').dataset.whole = 'false'")
    low.send_keys("90", Keys.TAB)
    settled(live)
    assert live.find_element("id", "message").text == ""
    assert live.execute_script("return window.explorer.map.axes[1].values[0]") == pytest.approx(
        math.pi / 2, rel=1e-12)


def test_an_address_is_what_was_seen(live, browser, tmp_path):
    type_in(live, "offset_ratio", "0.64")
    settled(live)
    address, height = live.execute_script(
        "return [location.hash, [...window.explorer.map.fields[0].values].map(String)]")
    assert "offset_ratio=0.64" in address
    browser.get("about:blank")
    browser.get(page_at(tmp_path).as_uri() + address)
    settled(browser)
    again = browser.execute_script("return [...window.explorer.map.fields[0].values].map(String)")
    assert height == again


@pytest.mark.slow
def test_goals_dim_what_fails_and_the_best_left_is_shown(live):
    live.execute_script("document.getElementById('filters').open = true")
    live.find_element("id", "goal-add").click()
    bound = live.find_element("css selector", "#goals input")
    bound.clear()
    bound.send_keys("24.6")  # mm, of 82 mm
    live.find_element("id", "goal-real").click()
    height, spurious = (np.array(v, float) for v in live.execute_script(
        "const { map } = window.explorer; return [[...map.fields[0].values].map(String), "
        "[...map.codes.spurious_first_jump.values]]"
    ))
    left = (height >= 0.3) & (spurious == 0)
    waited(live, lambda b: f"{left.sum():,} of 30,000" in b.find_element("id", "goals-told").text)
    assert 0 < left.sum() < 30000
    live.find_element("id", "goal-best").click()
    picked = live.execute_script("return window.explorer.view.view.picked")
    assert height[picked[0] * 150 + picked[1]] == height[left].max()
    assert float(
        live.execute_script(
            "return document.querySelector('#numbers tr[data-name=jump_height]').dataset.value")
    ) == pytest.approx(height[left].max(), rel=1e-9)
    by = Select(live.find_element("id", "goal-by"))

    def shown(how):
        by.select_by_value(how)
        live.find_element("id", "goal-best").click()
        i, j = live.execute_script("return window.explorer.view.view.picked")
        return i, j, height.reshape(200, 150)[i, j]
    assert shown("lowest")[2] == height[left].min()
    assert shown("highest")[2] == height[left].max()
    settled(live, what="cliffs")
    i, j, _ = shown("steadiest")
    torn = live.execute_script("return [...window.explorer.map.codes.cliffs.values]")
    torn = np.array(torn).reshape(200, 150)
    edge = ~left.reshape(200, 150) | (torn > 0)
    edge[1:] |= torn[:-1] & 1 > 0
    edge[:, 1:] |= torn[:, :-1] & 2 > 0
    rows, columns = np.nonzero(edge)
    steps = lambda i, j: np.min(np.abs(rows - i) + np.abs(columns - j))
    inside = np.argwhere(~edge)
    farthest = max(steps(*inside[k]) for k in range(0, len(inside), 7))
    assert steps(i, j) >= max(farthest, 3)
    live.find_element("css selector", "#goals button").click()
    live.find_element("id", "goal-real").click()
    assert live.find_element("id", "goals-told").text == ""


@pytest.mark.slow
def test_cuts_go_through_the_design_pointed_at(live):
    assert live.find_element(
        "id", "cut-x").get_attribute("data-values") is None, "nothing is drawn before anybody asks"
    live.execute_script(
        "document.getElementById('cuts').open = true; const { view } = window.explorer.view; view.index = "
        "[100, 40]; window.explorer.view.point()"
    )
    height = np.array(live.execute_script("return [...window.explorer.map.fields[0].values].map(String)"),
                      float).reshape(200, 150)
    waited(live, lambda b: b.find_element("id", "cut-y").get_attribute("data-values") == str(
        np.isfinite(height[100]).sum()))
    assert live.find_element("id", "cut-x").get_attribute("data-values") == str(
        np.isfinite(height[:, 40]).sum())
    before = live.execute_script("return document.getElementById('cut-x').toDataURL()")
    live.execute_script(
        "const { view } = window.explorer.view; view.index = [100, 80]; window.explorer.view.point()")
    assert live.execute_script("return document.getElementById('cut-x').toDataURL()") != before


@pytest.mark.slow
def test_a_cut_along_a_line_is_of_the_designs_between_its_ends(live):
    live.execute_script("document.getElementById('cuts').open = true")
    picked = live.execute_script("return window.explorer.view.view.picked")
    live.find_element("id", "cut-line-draw").click()
    assert live.find_element("id", "cut-line-hint").is_displayed()
    canvas = live.find_element("id", "map")
    live.execute_script("arguments[0].scrollIntoView({ block: 'center' })", canvas)
    ActionChains(live).move_to_element_with_offset(canvas, -60, 60).click_and_hold().move_by_offset(
        60, -30).move_by_offset(80, -60).release().perform()
    a, b = live.execute_script("return window.explorer.view.view.line")
    assert b[0] > a[0] and b[1] > a[1]
    height = np.array(live.execute_script("return [...window.explorer.map.fields[0].values].map(String)"),
                      float).reshape(200, 150)
    steps = max(b[0] - a[0], b[1] - a[1])
    places = [
        tuple(math.floor(i + (j - i) * k / steps + 0.5) for i, j in zip(a, b)) for k in range(steps + 1)
    ]
    line = live.find_element("id", "cut-line")
    assert line.is_displayed()
    assert line.get_attribute("data-values") == str(np.isfinite([height[place] for place in places]).sum())
    assert live.execute_script("return window.explorer.view.view.picked") == picked  # it was no click


@pytest.mark.slow  # its twin is of one hoop, in test_page_parts.py
def test_up_to_four_designs_are_pinned_and_their_csv_and_commands_are_leapmap_s(live, tmp_path):
    pin = live.find_element("id", "pin")
    for place in ([92, 29], [120, 60], [60, 90], [150, 100], [10, 10]):
        live.execute_script("const { view, pick } = window.explorer.view; view.index = arguments[0]; pick()",
                            place)
        pin.click()
    assert "room for 4" in live.find_element("id", "message").text
    head = live.find_elements("css selector", "#pins-table tr:first-child th")
    assert len(head) == 5
    (tmp_path / "pins.csv"
     ).write_text(live.execute_script("return document.getElementById('pins-csv').dataset.text") + "\n")
    swept = leapmap("sweep", "--points", tmp_path / "pins.csv", "-o", tmp_path / "pins.h5", "--quiet")
    assert swept.returncode == 0, swept.stderr
    commands = live.find_element("id", "pins-commands").text.split("leapmap hop")[1:]
    assert len(commands) == 4
    with h5py.File(tmp_path / "pins.h5") as pinned:
        for command, height in zip(commands, pinned["jump_height"]):
            told = json.loads(leapmap("hop", *command.split(), "--json").stdout)
            assert height == pytest.approx(told["jump_height"], rel=1e-9)
    # The hoops move along: the picture is another without them.
    live.execute_script(
        "document.getElementById('play').click(); const s = document.getElementById('scrub'); s.value = 0.4 "
        "* s.max; s.dispatchEvent(new Event('input'))"
    )
    along = live.execute_script("return document.getElementById('scene').toDataURL()")
    marked = live.execute_script("return document.getElementById('map').toDataURL()")
    live.find_element("id", "pins-along").click()
    waited(live, lambda b: b.execute_script("return document.getElementById('scene').toDataURL()") != along)
    traced = live.execute_script("return document.getElementById('plots').toDataURL()")
    live.find_element("id", "pins-along").click()
    waited(live, lambda b: b.execute_script("return document.getElementById('plots').toDataURL()") != traced)
    live.find_element("css selector", "#pins-table button").click()
    assert len(live.find_elements("css selector", "#pins-table tr:first-child th")) == 4
    assert live.execute_script(
        "return document.getElementById('map').toDataURL()") != marked, "the map marks what is pinned"


@pytest.mark.slow
@pytest.mark.parametrize("friction", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_how_many_jumps_hoops_make_is_a_field_once_more_than_one_is_followed(friction, live):
    option = ("return [...document.getElementById('field').options].find((o) => o.textContent === 'number "
              "of jumps').disabled")
    assert live.execute_script(option)
    if friction:
        Select(live.find_element("id", "live-model")).select_by_value("coulomb")
    live.execute_script(
        "document.getElementById('map').dataset.whole = 'false'; const j = document.getElementById('jumps'); "
        "j.value = 4; j.dispatchEvent(new Event('change'))"
    )
    settled(live, 200)
    assert not live.execute_script(option)
    Select(live.find_element("id", "field")).select_by_visible_text("number of jumps")
    waited(live, lambda b: "jumps=4" in b.execute_script("return location.hash") and
                                  "field=jumps" in b.execute_script("return location.hash"))
    made = []
    for cell in designs(live, [int(k) for k in np.random.default_rng(11).integers(0, 30000, 30)]):
        told = told_of(cell, "--jumps", "4")
        same_first_jump(cell, told)
        assert (cell["told"]["jumps"] == "NaN" and not told["jumps"]) or float(
            cell["told"]["jumps"]) == told["jumps"], cell
        made.append(told["jumps"] or 0)
    assert len(set(made)) >= 3  # none, some, all


def show(browser, field):
    """Chooses the quantity that the map shows."""
    browser.execute_script("""const select = document.getElementById('field');
        select.value = window.explorer.map.fields.findIndex((f) => f.name === arguments[0]);
        select.dispatchEvent(new Event('change'))""", field)


COARSE = [i * 150 + j for i in range(0, 200, 8) for j in range(0, 150, 8)]  # the cells of the first picture


def first_picture(browser, field, seconds=120):
    """Waits for the first picture in which a field has numbers."""
    told = """const f = window.explorer?.map.fields.find((f) => f.name === arguments[1]);
        return document.getElementById('map').dataset.coarse === 'true' && f &&
          arguments[0].some((k) => f.values[k] === f.values[k])"""
    waited(browser, lambda b: b.execute_script(told, COARSE, field), seconds)


@pytest.mark.slow
@pytest.mark.parametrize(
    "friction, settle",
    [("sticking", 200), pytest.param("coulomb", 60, marks=pytest.mark.slow)])
def test_the_gait_that_each_hoop_settles_on_is_a_field_solved_once_one_looks(friction, settle, live,
                                                                             tmp_path):
    assert not live.execute_script(
        "return window.explorer.map.fields.find((f) => f.name === 'gait_period').values.some((v) => v === v)"
    ), "nobody has asked for gaits yet"
    address = (f"#live&x=slope:0.05:0.45&y=mass_ratio:0.3:20&offset_ratio=0.5&runway=20&settle={settle}"
               f"&field=gait_period&friction={friction}")
    live.get("about:blank")
    live.get(page_at(tmp_path).as_uri() + address)
    first_picture(live, "gait_period")
    if friction == "coulomb":  # minutes
        assert "to go" in live.find_element("id", "subtitle").text
    cells = designs(live, COARSE[::20])
    same = settled_on_one = 0
    for cell in cells:
        told, period = told_of(cell, "--set", f"settle={settle}"), float(cell["told"]["gait_period"])
        # What a chaotic hoop comes to after so many jumps hangs on the last digit of the first.
        same += math.isnan(period) if told["gait_period"] in (None, 255) else period == told["gait_period"]
        if period > 0 and period == told["gait_period"]:
            settled_on_one += 1
            for name in ("gait_height", "gait_speed", "gait_energy_lost"):
                assert float(cell["told"][name]) == pytest.approx(told[name], rel=1e-9,
                                                                  abs=1e-11), (name, cell)
            # A derivative, of as many digits as Newton's iteration leaves the orbit.
            assert float(cell["told"]["gait_multiplier"]) == pytest.approx(told["gait_multiplier"], rel=1e-6,
                                                                           abs=1e-8), cell
    assert same >= 0.9 * len(cells) and settled_on_one >= 3, (same, settled_on_one, len(cells))


MADE = ("yield", *(f"{q}_{s}" for q in ("jump_height", "jump_time")
                   for s in ("mean", "sd", "q05", "q50", "q95")))


def told_as_made(cells, folder, *settings):
    """What leapmap sweep tells of hoops made after some cells' designs, by field."""
    scene = ("runway", "hop_height", "clear_height", "rest_speed", "radius", "gravity")
    contact = ("mu_static", "mu_kinetic", "restitution")
    names = [
        n for n in cells[0]["design"]
        if n not in scene and (cells[0]["slips"] or n not in contact) and cells[0]["design"][n] is not None
    ]
    rows = [",".join(names), *(",".join(repr(c["design"][n]) for n in names) for c in cells)]
    (folder / "cells.csv").write_text("\n".join(rows) + "\n")
    (folder / "cells.h5").unlink(missing_ok=True)
    fixed = [
        w for n in scene if cells[0]["slips"] or n != "rest_speed"
        for w in ("--set", f"{n}={cells[0]['design'][n]!r}")
    ]
    fields = "output.fields=[" + ", ".join(f'"{n}"' for n in MADE) + "]"
    done = leapmap("sweep", "--points", folder / "cells.csv", "-o", folder / "cells.h5", "--quiet", *fixed,
                   "--set", fields, *(["--set", "friction=coulomb"] if cells[0]["slips"] else []),
                   *(w for each in settings for w in ("--set", each)))
    assert done.returncode == 0, done.stderr
    with h5py.File(folder / "cells.h5") as made:
        return {name: made[name][...] for name in MADE}


def same_as_made(cells, told):
    """Every field of each cell is what leapmap tells; how many have a yield between none and all."""
    for name in MADE:
        page = np.array([float(cell["told"][name]) for cell in cells])
        # Roundings differ, and with friction times and heights by as little as the tolerance, 1e-10, which
        # may be divided by a small spread.
        np.testing.assert_allclose(page, told[name], rtol=1e-7 if name.endswith("_sd") else 1e-9, atol=1e-9,
                                   err_msg=name)
    return int(np.sum((told["yield"] > 0.02) & (told["yield"] < 0.98)))


@pytest.mark.slow
@pytest.mark.parametrize("friction, samples", [("sticking", 256),
                                               pytest.param("coulomb", 32, marks=pytest.mark.slow)])
def test_the_yield_of_hoops_as_made_is_a_field_by_the_tolerances_and_goals_that_are_set(
        friction, samples, live, tmp_path):
    assert not live.execute_script(
        "return window.explorer.map.fields.find((f) => f.name === 'yield').values.some((v) => v === v)"
    ), "nobody has asked for hoops as made yet"
    # At L/R = 1 half of a law is cut off, so that its inverse is taken at other places than a table would
    # have.
    address = (f"#live&x=slope:0.1:0.8&y=offset_ratio:0.5:1&mass_ratio=4&samples={samples}&field=yield"
               f"&friction={friction}"
               "&made=slope:uniform:0.03&made=offset_ratio:normal:3:percent&made=mass_ratio:normal:4:percent"
               "&goal=jump_height:least:0.4&goal=jump_time:most:0.5&real")
    live.get("about:blank")
    live.get(page_at(tmp_path).as_uri() + address)
    first_picture(live, "yield")
    assert live.find_element("id", "tolerances").get_attribute("open")
    assert len(live.find_elements("css selector", "#spreads li")) == 3
    cells = designs(live, [*COARSE[::20], 192 * 150 + 144, 96 * 150 + 144])
    cells = [cell for cell in cells if cell["told"]["yield"] != "NaN"]
    settings = [
        f"scatter.samples={samples}", "scatter.slope={uniform=0.03}", 'scatter.offset_ratio={normal="3%"}',
        'scatter.mass_ratio={normal="4%"}', "goal.jump_height={at_least=0.4}", "goal.jump_time={at_most=0.5}",
        'goal.spurious_first_jump={is="first_lift_off_is_the_jump"}'
    ]
    assert len(cells) >= 20 and same_as_made(cells, told_as_made(cells, tmp_path, *settings)) >= 3


@pytest.mark.slow  # its twin is above, with goals
def test_without_a_goal_the_yield_counts_hoops_that_jump_and_a_tolerance_changed_changes_it(live, tmp_path):
    live.get("about:blank")
    live.get(page_at(tmp_path).as_uri() + "#live&samples=32&field=yield")
    settled(live)
    spots = [i * 150 + j for i in range(2, 42, 2) for j in (20, 100)]
    usual = [f'scatter.{n}={{normal="1%"}}' for n in ("offset_ratio", "inertia_factor")]
    cells = designs(live, spots)
    same_as_made(
        cells,
        told_as_made(cells, tmp_path, "scatter.samples=32", 'scatter.mass_ratio={normal="1%"}', *usual,
                     'goal.status={is="jumped"}'))
    live.execute_script("""document.getElementById('tolerances').open = true;
          document.getElementById('map').dataset.whole = 'false';
        const [number] = document.querySelectorAll('#spreads input'); number.value = 20;
        number.dispatchEvent(new Event('change'))""")
    settled(live)
    assert "made=mass_ratio:normal:20:percent" in live.execute_script("return location.hash")
    cells = designs(live, spots)
    told = told_as_made(cells, tmp_path, "scatter.samples=32", 'scatter.mass_ratio={normal="20%"}', *usual,
                        'goal.status={is="jumped"}')
    assert same_as_made(cells, told) >= 3
    # A hoop typed in is told as made, too, whenever that is known.
    live.execute_script("""for (const [name, value] of [['slope', 22], ['mass_ratio', 3]]) {
        const input = document.querySelector(`#own [data-parameter=${name}]`); input.value = value;
        input.dispatchEvent(new Event('change')); }""")
    waited(live, lambda b: b.find_element("id", "readout").get_attribute("data-value") not in ("", None))
    own = {**cells[0], "design": {**cells[0]["design"], "slope": math.radians(22), "mass_ratio": 3.0}}
    told = told_as_made([own], tmp_path, "scatter.samples=32", 'scatter.mass_ratio={normal="20%"}', *usual,
                        'goal.status={is="jumped"}')
    assert float(live.find_element("id", "readout").get_attribute("data-value")) == pytest.approx(
        told["yield"][0], rel=1e-9)
    live.find_element("id", "undo").click()  # the hoop
    live.find_element("css selector", "#spreads button").click()
    assert "made=offset_ratio:normal:1:percent" in live.execute_script("return location.hash")


@pytest.mark.slow
def test_a_file_s_map_as_made_tells_a_hoop_of_ones_own_and_goes_live_with_its_tolerances_and_goals(
        browser, tmp_path):
    sweep(
        tmp_path,
        """[design]\nslope = {from = "5 deg", to = "45 deg", count = 9}
mass_ratio = {from = 1, to = 9, count = 5}
[scatter]\nsamples = 64\nseed = 5\nslope = {normal = "2 deg"}\nmass_ratio = {uniform = "8%"}
[goal]\njump_height = {at_least = 0.3}\nspurious_first_jump = {is = "first_lift_off_is_the_jump"}
[output]\nfields = ["jump_height", "status", "yield"]\n""",
        name="made.h5")
    browser.get("about:blank")
    opened(browser, page_at(tmp_path, tmp_path / "made.h5"))
    show(browser, "yield")
    browser.execute_script(
        "const { view, pick } = window.explorer.view; view.index = [4, 2]; pick(); "
        "document.getElementById('own').open = true"
    )
    at = browser.execute_script(
        "const { map } = window.explorer; return [map.fields.find((f) => f.name === 'yield').values[4 * 5 + "
        "2], map.axes[0].values[4], map.axes[1].values[2]]"
    )
    browser.execute_script("""for (const [name, value] of [['mass_ratio', 5.000001], ['mass_ratio',
          arguments[0]]]) {
        const input = document.querySelector(`#own [data-parameter=${name}]`); input.value = value;
        input.dispatchEvent(new Event('change')); }""", at[2])
    waited(browser, lambda b: b.find_element("id", "readout").get_attribute("data-value") not in ("", None))
    # Rounded on the map to a 60,000th of what it holds; the slope typed in has as many digits as are shown.
    assert float(browser.find_element("id", "readout").get_attribute("data-value")) == pytest.approx(
        at[0], abs=1e-4)
    browser.find_element("id", "live-toggle").click()
    waited(browser, lambda b: b.execute_script("return !!window.explorer?.map.live"))
    asked = browser.execute_script(
        "const { map } = window.explorer; return [map.spreads, map.samples, map.seed, map.hoopGoals()]")
    assert asked == [[{
        "name": "slope", "law": "normal", "width": pytest.approx(math.radians(2)), "percent": False
    }, {"name": "mass_ratio", "law": "uniform", "width": 8, "percent": True}], 64, 5,
                     [{"field": "jump_height", "least": 0.3,
                       "most": None}, {"field": "spurious_first_jump", "least": 0, "most": 0},
                      {"field": "status", "least": 1, "most": 1}]]


def gait_of_a_hoop_of_ones_own(browser):
    """Types a hoop in whose gait is shown; it must be the one that the command beside it tells."""
    browser.execute_script("""for (const [name, value] of [['slope', 12], ['mass_ratio', 3]]) {
        const input = document.querySelector(`#own [data-parameter=${name}]`); input.value = value;
        input.dispatchEvent(new Event('change')); }""")
    told = told_by_leapmap(browser)
    assert told["gait_height"] > 0.1
    assert float(browser.find_element("id", "readout").get_attribute("data-value")) == pytest.approx(
        told["gait_height"], rel=1e-9)


@pytest.mark.slow  # a map with tolerances goes live in the first tier
def test_a_file_s_map_tells_gaits_of_a_hoop_of_one_s_own_too_and_goes_live_as_it_settled(browser, tmp_path):
    path = sweep(
        tmp_path,
        """[scene]\nrunway = 20.0\n[design]\nslope = { from = "8 deg", to = "16 deg", count = 9 }
mass_ratio = { from = 2, to = 4, count = 5 }\noffset_ratio = 0.5
[gait]\nsettle = 60\n[output]\nfields = ["jump_height", "status", "gait_height", "gait_period"]\n""")
    html = page_at(tmp_path, path)
    browser.get("about:blank")
    opened(browser, html)
    show(browser, "gait_height")
    gait_of_a_hoop_of_ones_own(browser)
    browser.find_element("id", "live-toggle").click()
    settled(browser)
    assert browser.execute_script("return window.explorer.map.settle") == 60


@pytest.mark.slow  # its twin is of the gait that each hoop settles on
@pytest.mark.parametrize("jumps", [6, 24, 60])
def test_what_takes_many_jumps_is_asked_for_while_one_looks_and_no_longer(jumps, live, tmp_path):
    asked = "return window.explorer.map.asked.settle"
    live.get("about:blank")
    live.get(
        page_at(tmp_path).as_uri() +
        "#live&x=slope:0.05:0.45&y=mass_ratio:0.3:20&offset_ratio=0.5&runway=20&settle=%d&field=gait_height" %
        jumps)
    waited(live, lambda b: b.execute_script("return window.explorer?.map.asked.settle") == jumps)
    settled(live)
    # A hoop of one's own is told the same, by the command that the page shows too.
    if jumps >= 24:  # the hoop takes as many to settle
        gait_of_a_hoop_of_ones_own(live)
    settle = live.find_element("id", "settle")
    assert settle.is_displayed()
    live.execute_script(
        "document.getElementById('map').dataset.whole = 'false'; arguments[0].value = arguments[1]; "
        "arguments[0].dispatchEvent(new Event('change'))",
        settle, jumps + 4)
    settled(live)
    assert live.execute_script(asked) == jumps + 4
    assert f"settle={jumps + 4}" in live.execute_script("return location.hash")
    live.execute_script("document.getElementById('map').dataset.whole = 'false'")
    live.find_element("id", "undo").click()
    settled(live)
    assert live.execute_script(asked) == jumps and settle.get_attribute("value") == str(jumps)
    show(live, "jump_height")
    assert not settle.is_displayed() and live.execute_script(asked) == jumps, "what is there stays"
    show(live, "gait_height")
    assert live.execute_script(
        "return document.getElementById('map').dataset.whole") == "true", "and is not solved again"
    show(live, "jump_height")
    live.execute_script("document.getElementById('map').dataset.whole = 'false'")
    type_in(live, "offset_ratio", "0.6")
    settled(live)
    assert live.execute_script(asked) == 0


@pytest.mark.slow  # its twin is of how many jumps hoops make
def test_how_errors_grow_is_a_field_of_sequences(live):
    live.execute_script(
        "document.getElementById('map').dataset.whole = 'false'; const j = document.getElementById('jumps'); "
        "j.value = 3; j.dispatchEvent(new Event('change'))"
    )
    settled(live)
    show(live, "sequence_condition")
    compared = 0
    first_picture(live, "sequence_condition")
    for cell in designs(live, COARSE[::10]):
        told = told_of(cell, "--jumps", "3")
        if told["sequence_condition"] is None:
            assert cell["told"]["sequence_condition"] == "NaN", cell
            continue
        assert float(cell["told"]["sequence_condition"]) == pytest.approx(told["sequence_condition"],
                                                                          rel=1e-6), cell
        compared += 1
    assert compared >= 3


@pytest.mark.slow
def test_cliffs_move_while_one_drags_and_no_drag_goes_unseen(live):
    """Each picture on the way has curves of its own, and they come however often the slider tells."""
    settled(live, what="cliffs")
    curves = live.execute_async_script("""const done = arguments[0], { map } = window.explorer;
        const canvas = document.getElementById('map'), seen = [], begun = performance.now();
        const offset = 'input[type=range][data-parameter=offset_ratio]';
        const slider = document.querySelector('#live-sliders ' + offset);
        let last = canvas.dataset.generation;
        (function drag() {
          slider.value = 0.9 - 0.3 * (performance.now() - begun) / 4000;
          slider.dispatchEvent(new Event('input'));
          if (canvas.dataset.generation !== last) { last = canvas.dataset.generation;
          if (map.curves.length > 0) seen.push([map.roughCurves, JSON.stringify(map.curves.map(({
            x }) => x.slice(0, 3)))]); }
          if (performance.now() - begun < 4000) requestAnimationFrame(drag); else done(seen);
        })();""")
    assert len(curves) >= 5 and all(rough for rough, _ in curves)  # some fifty on an idle machine
    assert len({text for _, text in curves}) == len(curves)


@pytest.mark.slow
def test_the_animation_goes_frame_by_frame_and_is_saved_as_a_film(live):
    clock = live.find_element("id", "clock")
    live.execute_script(
        "const s = document.getElementById('scrub'); s.value = 0.1; s.dispatchEvent(new Event('input'))")
    live.find_element("id", "step-on").click()
    # at a quarter of the speed
    assert float(clock.text.split()[0]) == pytest.approx(0.1 + 0.25 / 30, abs=6e-4)
    live.find_element("id", "step-back").click()
    live.find_element("id", "step-back").click()
    assert float(clock.text.split()[0]) == pytest.approx(0.1 - 0.25 / 30, abs=6e-4)
    Select(live.find_element("id", "speed")).select_by_value("1")
    live.find_element("id", "film").click()
    waited(live, lambda b: int(b.find_element("id", "film").get_attribute("data-bytes") or 0) > 3000, 240)


@pytest.mark.slow
def test_a_link_to_the_paper_s_hoop_shows_the_hoop_first_on_a_phone(live, tmp_path):
    size = live.get_window_size()
    try:
        live.set_window_size(390, 844)
        live.get("about:blank")
        live.get(page_at(tmp_path).as_uri() + "#live&paper")
        settled(live)
        tops = live.execute_script(
            "return ['hop-part', 'map-part'].map((id) => "
            "document.getElementById(id).getBoundingClientRect().top)"
        )
        assert tops[0] < tops[1] and tops[0] < 400
        assert live.execute_script("return document.documentElement.scrollWidth") <= live.execute_script(
            "return window.innerWidth")
    finally:
        live.set_window_size(size["width"], size["height"])


@pytest.mark.slow
def test_a_file_s_map_goes_live_where_it_is_and_back(browser, tmp_path):
    path = sweep(
        tmp_path,
        "[design]\nslope = { from = \"5 deg\", to = \"40 deg\", count = 20 }\nmass_ratio = { from = 0.5, to "
        "= 10, count = 15 }\noffset_ratio = 0.8\n"
    )
    html = page_at(tmp_path, path)
    browser.get("about:blank")
    opened(browser, html)
    browser.find_element("id", "live-toggle").click()
    settled(browser)
    axes, offset = browser.execute_script(
        "const { map } = window.explorer; return [map.axes.map((a) => [a.name, a.values[0], "
        "a.values.at(-1)]), map.fixed.offset_ratio]"
    )
    assert [axis[0] for axis in axes] == ["slope", "mass_ratio"] and offset == 0.8
    assert axes[0][1:] == pytest.approx([math.radians(5), math.radians(40)])
    assert axes[1][1:] == pytest.approx([0.5, 10])
    compare(browser, np.random.default_rng(9), 10)
    browser.find_element("id", "live-toggle").click()
    waited(browser, lambda b: b.execute_script("return window.explorer && !window.explorer.map.live"))
    assert browser.execute_script("return window.explorer.map.axes[0].values.length") == 20


@pytest.mark.slow
def test_numbers_of_a_drawing_are_axes_and_tolerances_of_a_live_map(browser, tmp_path):
    """Begun from a file's map, whose weight has a name; what follows from the drawing cannot be turned."""
    laws = ('slope={normal="1 deg"}', 'hoop.slug.at={normal="0.5 mm"}', 'hoop.diameter={uniform="1 mm"}',
            'hoop.battery.angle={normal="5 deg"}')
    settings = [w for each in (*(f"tolerances.{law}" for law in laws), "tolerances.samples=32",
                               'drive_torque="-0.004 N m"', 'tolerances.drive_torque={normal="0.002 N m"}',
                               "friction=sticking", "goal.jump_height={at_least=0.2}",
                               'output.fields=["jump_height", "jump_time", "status", "yield"]')
                for w in ("--set", each)]
    spec = TOP / "sweeps" / "drawing.toml"
    axes = ("--set", 'slope={from="15 deg",to="40 deg",count=4}', "--set",
            'hoop.slug.mass={from="40 g",to="160 g",count=5}')
    done = leapmap("sweep", spec, *axes, *settings, "-o", tmp_path / "m.h5", "--quiet")
    assert done.returncode == 0, done.stderr
    browser.get("about:blank")
    opened(browser, page_at(tmp_path, tmp_path / "m.h5"))
    browser.find_element("id", "live-toggle").click()
    waited(browser, lambda b: b.execute_script("return !!window.explorer?.map.live"))
    show(browser, "yield")
    settled(browser, 120)
    assert browser.find_element("id", "message").text == ""
    assert browser.execute_script("""const { map } = window.explorer;
        return [...map.axes.map(({ name }) => name), ...map.spreads.map(({ name }) => name)]""") == [
            "slope", "hoop.slug.mass", "slope", "drive_torque", "hoop.slug.at", "hoop.diameter",
            "hoop.battery.angle"]
    assert not browser.find_elements("css selector", "#live-sliders [data-parameter=mass_ratio]")
    cells = [150 * i + j for i in range(5, 200, 24) for j in (5, 60, 110)]
    told = browser.execute_script("""const { map } = window.explorer, [x, y] = map.axes;
        const of = (name) => map.fields.find((f) => f.name === name).values;
        return arguments[0].map((k) => ({ slope: x.values[Math.floor(k / 150)], mass: y.values[k % 150],
          jump_height: of("jump_height")[k], jump_time: of("jump_time")[k], yield: of("yield")[k] }))""",
                                  cells)
    (tmp_path / "cells.csv").write_text("slope,hoop.slug.mass\n" + "".join(
        f"{cell['slope']!r},{cell['mass']!r}\n" for cell in told))
    done = leapmap("sweep", spec, "--points", tmp_path / "cells.csv", *settings, "-o", tmp_path / "cells.h5",
                   "--quiet")
    assert done.returncode == 0, done.stderr
    with h5py.File(tmp_path / "cells.h5") as m:
        for name in ("jump_height", "jump_time", "yield"):
            page = np.array([np.nan if cell[name] is None else cell[name] for cell in told])
            np.testing.assert_allclose(page, m[name][...], rtol=1e-9, atol=1e-9, err_msg=name)
        assert np.sum((m["yield"][...] > 0.02) & (m["yield"][...] < 0.98)) >= 3
    browser.execute_script("const { view, pick } = window.explorer.view; view.index = [100, 75]; pick()")
    grams = browser.execute_script("return 1000 * window.explorer.map.axes[1].values[75]")
    shown = browser.execute_script("return document.querySelector(\"[data-drawn='slug.mass']\").value")
    assert float(shown) == pytest.approx(grams, rel=1e-9), "the drawing is that of the hoop picked"
    assert told_by_leapmap(browser)["jump_height"] == pytest.approx(
        float(numbers(browser)["jump_height"]), rel=1e-9)
    address = browser.execute_script("return location.hash")
    browser.get("about:blank")
    browser.get(page_at(tmp_path).as_uri() + address)
    settled(browser, 120)
    assert browser.execute_script("return location.hash") == address
    # A ratio is not offered beside numbers of the drawing; without them it is.
    offered = lambda: browser.execute_script(
        "return [...document.getElementById('live-x').options].map(({ value }) => value)")
    assert "hoop.battery.mass" in offered() and "mass_ratio" not in offered()


@pytest.mark.slow
def test_a_wall_is_cleared_where_leapmap_tells(live):
    """In the table and on the map; without a wall no such quantity is offered."""
    offered = lambda: live.execute_script("""
        return [...document.querySelectorAll('#field option')].filter((each) => !each.disabled)
            .map((each) => window.explorer.map.fields[each.value].name)""")
    assert "clears_from" not in offered()
    type_in(live, "clear_height", "0.3")
    settled(live)
    assert "clears_from" in offered()
    show(live, "clears_to")
    settled(live)
    cells = live.execute_script("""
        const { values } = window.explorer.map.fields.find(({ name }) => name === "clears_to");
        return [...values.keys()].filter((k) => Number.isFinite(values[k]))
            .filter((_, i) => i % 999 === 0)""")
    assert len(cells) > 5
    for k in cells[::2]:
        live.execute_script("""const { view, pick } = window.explorer.view;
            view.index = [Math.floor(arguments[0] / 150), arguments[0] % 150]; pick()""", k)
        hop = told_by_leapmap(live)
        on_map = live.execute_script("""return window.explorer.map.fields
            .find(({ name }) => name === "clears_to").values[arguments[0]]""", k)
        assert on_map == pytest.approx(hop["clears_to"], rel=1e-9)
        assert float(numbers(live)["clears_from"]) == pytest.approx(hop["clears_from"], rel=1e-9)
        assert "clears a wall of" in live.find_element("id", "numbers").text
