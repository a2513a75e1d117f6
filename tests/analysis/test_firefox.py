# SPDX-License-Identifier: GPL-3.0-or-later
"""The page in the other browser: it opens, computes, and tells the numbers of leapmap hop."""
import os
import shlex
import shutil
import time
from pathlib import Path

import json
import numpy as np
import pytest
from support.browser import agrees
from support.firefox import Firefox
from support.program import leapmap, scripted, sweep
from support.typed_hoops import random_hoop, told_of_typed, type_hoop

MODULE = Path(os.environ["LEAPMAP_BUILD"]) / "leapmap.wasm"
pytestmark = pytest.mark.slow  # its twins are those in chromium


@pytest.fixture(scope="module")
def firefox(tmp_path_factory):
    if not shutil.which("firefox-esr"):
        pytest.skip("firefox-esr is not installed")
    browser = Firefox(tmp_path_factory.mktemp("firefox"))
    yield browser
    browser.quit()


def wait(browser, condition, seconds=90):
    end = time.monotonic() + seconds
    while not browser.execute_script(f"return {condition}"):
        assert time.monotonic() < end, condition
        time.sleep(0.1)


def shown(browser):
    """The numbers of the hoop that the page shows, and what leapmap tells of it."""
    numbers = browser.execute_script(
        "return Object.fromEntries([...document.querySelectorAll('#numbers tr')].map(r => [r.dataset.name, "
        "r.dataset.value]))"
    )
    words = shlex.split(browser.execute_script("return document.getElementById('command').textContent"))
    return numbers, json.loads(leapmap(*words[1:], "--json").stdout)


@pytest.mark.parametrize("friction", ["sticking", "coulomb"])
def test_the_page_that_computes_tells_what_leapmap_tells(friction, firefox, tmp_path):
    assert scripted("explorer", "--module", MODULE, "-o", tmp_path / "live.html").returncode == 0
    firefox.get("about:blank")
    firefox.get((tmp_path / "live.html").as_uri() + f"#live&friction={friction}&slope=0.45&mass_ratio=3.5")
    wait(firefox, "!!window.explorer && document.getElementById('map').dataset.whole === 'true'")
    assert firefox.execute_script("return document.getElementById('message').textContent") == ""
    numbers, told = shown(firefox)
    assert agrees(numbers, told) >= 9


def test_a_map_opens_and_a_design_of_it_jumps(firefox, tmp_path):
    page = scripted("explorer", sweep(tmp_path), "--module", MODULE, "-o", tmp_path / "map.html")
    assert page.returncode == 0, page.stderr
    firefox.get((tmp_path / "map.html").as_uri())
    wait(firefox, "!!window.explorer")
    assert firefox.execute_script("return document.getElementById('message').textContent") == ""
    numbers, told = shown(firefox)
    assert agrees(numbers, told) >= 9


@pytest.mark.parametrize(("friction", "count"), [(False, 120), (True, 80)])
def test_every_number_of_random_hoops_typed_in_is_that_of_leapmap_hop(friction, count, firefox, tmp_path):
    assert scripted("explorer", "--module", MODULE, "-o", tmp_path / "live.html").returncode == 0
    model = "coulomb" if friction else "sticking"
    firefox.get("about:blank")
    firefox.get((tmp_path / "live.html").as_uri() + f"#live&friction={model}")
    wait(firefox, "!!window.explorer && document.getElementById('map').dataset.whole === 'true'")
    random, jumped = np.random.default_rng(29), 0
    for _ in range(count):
        hoop = random_hoop(random, friction)
        type_hoop(firefox, hoop)
        jumped += told_of_typed(firefox, hoop)["status"] == "jumped"
    assert jumped >= 0.4 * count
