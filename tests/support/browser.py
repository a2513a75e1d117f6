# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of pages share."""
import json
import shlex

import pytest
from selenium.webdriver.support.ui import WebDriverWait

from support.program import leapmap


def waited(browser, condition, seconds=60):
    """Waits until the condition holds. By itself Selenium looks every half second only."""
    return WebDriverWait(browser, seconds, poll_frequency=0.05).until(condition)


def opened(browser, page):
    browser.get(page.as_uri())
    waited(browser, lambda b: b.execute_script(
        "return !!window.explorer || !document.getElementById('message').hidden"), 20)
    assert browser.find_element("id", "message").text == ""
    complaints = [m for m in browser.get_log("browser") if m["level"] in ("SEVERE", "WARNING")]
    assert not complaints, complaints


def agrees(page_numbers, told):
    """The page's numbers against leapmap hop --json's: the same solver, compiled by another compiler for
    another machine."""
    compared = 0
    for name, text in page_numbers.items():
        if name not in told:
            continue
        compared += 1
        if isinstance(told[name], str):
            assert text == told[name], name
        elif told[name] is None:
            assert text == "NaN", name
        else:
            # Roundings differ: this machine contracts a*b + c and has wider lanes. Times are good to the
            # tolerance, 1e-10.
            assert float(text) == pytest.approx(told[name], rel=1e-9, abs=1e-11), name
    return compared


def numbers(browser):
    """The table of the hoop shown, as numbers."""
    return browser.execute_script(
        "return Object.fromEntries([...document.querySelectorAll('#numbers tr')].map(r => [r.dataset.name, "
        "r.dataset.value]))"
    )


def told_by_leapmap(browser):
    """What the command that the page shows tells."""
    words = shlex.split(browser.find_element("id", "command").text)
    assert words[:2] == ["leapmap", "hop"]
    return json.loads(leapmap(*words[1:], "--json").stdout)


def settled(browser, seconds=60, what="whole"):
    """Waits for a live map: all of it, or its "cliffs" too."""
    waited(browser, lambda b: b.execute_script(
        "return document.getElementById('map').dataset[arguments[0]]", what) == "true", seconds)
