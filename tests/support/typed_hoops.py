# SPDX-License-Identifier: GPL-3.0-or-later
"""Random hoops typed into a page, and what leapmap hop tells of them."""
import json
import math
import shlex

import pytest

from support.browser import agrees
from support.program import leapmap

ANGLES = ("slope", "release_angle")


def random_hoop(random, friction):
    hoop = {
        "slope": random.uniform(0.05, 0.85), "mass_ratio": random.uniform(0.2, 15),
        "offset_ratio": random.uniform(0.1, 1), "inertia_factor": random.uniform(0.5, 1),
        "release_angle": random.uniform(0, 2 * math.pi),
        "release_spin": random.choice([0, random.uniform(-2, 3)]),
        "drive_torque": random.choice([0, random.uniform(0, 0.2)]), "runway": random.uniform(2, 9),
        "hop_height": random.uniform(0, 0.1), "gravity": random.uniform(1.5, 25)
    }
    if friction:
        hoop |= {
            "mu_static": random.uniform(0.1, 1.2), "mu_kinetic": random.uniform(0.05, 0.1),
            "restitution": random.uniform(0, 0.6), "rest_speed": random.uniform(1e-4, 0.05)
        }
    return hoop


def type_hoop(browser, hoop):
    browser.execute_script(
        """for (const [name, text] of Object.entries(arguments[0])) {
        const input = document.querySelector(`#hoop-inputs input[data-parameter=${name}]`);
        input.value = text; input.dispatchEvent(new Event('change')); }""",
        {name: repr(math.degrees(v) if name in ANGLES else float(v)) for name, v in hoop.items()})


def told_of_typed(browser, hoop):
    """What leapmap hop tells of the hoop that the page shows, which has to be the one that was typed, each
    number the same."""
    message, text, shown = browser.execute_script("""
        const textOf = (id) => document.getElementById(id).textContent;
        return [textOf('message'), textOf('command'), Object.fromEntries(
          [...document.querySelectorAll('#numbers tr')].map((r) => [r.dataset.name, r.dataset.value]))]""")
    assert message == ""
    words = shlex.split(text)
    assert words[:2] == ["leapmap", "hop"]
    told = json.loads(leapmap(*words[1:], "--json").stdout)
    parts = [word.partition("=") for word in words]
    settings = {name: float(value) for name, _, value in parts if name in hoop}
    for name, value in hoop.items():
        here = settings[name] if name in settings else told["design"][name]
        assert here == pytest.approx(value, rel=1e-14, abs=1e-300), name
    assert agrees(shown, told) >= (9 if told["status"] == "jumped" else 1)
    return told
