#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page that computes, in Debian's chromium without a window, beside leapmap itself in the same run.

Medians of repeats: from a slider's event to the coarse and to the whole picture of 200 x 150 designs, designs
a second of both, and frames a second while a hoop jumps. Needs LEAPMAP_BUILD with leapmap.wasm and the Python
module."""
import os
import statistics
import subprocess
import sys
import tempfile
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

BUILD = os.environ.get("LEAPMAP_BUILD", "build/release")
sys.path.insert(0, os.path.join(BUILD, "python"))
import numpy as np  # noqa: E402

import leapmap  # noqa: E402

EXPLORER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "analysis", "explorer")
DRAG = """const done = arguments[arguments.length - 1], map = document.getElementById('map'),
      begun = performance.now(), before = map.dataset.generation;
const slider = document.querySelector("#live-sliders input[type=range][data-parameter=offset_ratio]");
let coarse = 0;
slider.value = arguments[0];
slider.dispatchEvent(new Event('input'));
requestAnimationFrame(function look() {
  const passed = performance.now() - begun, drawn = map.dataset.generation !== before;
  if (drawn && !coarse) coarse = passed;
  if (drawn && map.dataset.whole === 'true') done([coarse, passed, window.explorer.timing.full]);
  else requestAnimationFrame(look);
});"""
FRAMES = """const done = arguments[arguments.length - 1], begun = performance.now();
let frames = 0;
document.getElementById('scrub').value = 0;
if (!document.getElementById('play').textContent.includes('pause')) document.getElementById('play').click();
requestAnimationFrame(function count() { ++frames;
if (performance.now() - begun > 1500) done(frames / (performance.now() - begun) * 1000);
else requestAnimationFrame(count); });"""


def browser(profile):
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for switch in ("--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run",
                   "--disable-dev-shm-usage", "--window-size=1400,1000", f"--user-data-dir={profile}"):
        options.add_argument(switch)
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def native(friction):
    """Designs a second of leapmap itself on all cores, of the page's own grid."""
    slope, mass = np.linspace(np.radians(2), np.radians(50), 200)[:, None], np.linspace(0.1, 12, 150)
    runs = []
    for offset in np.linspace(0.5, 0.95, 7):
        begun = time.perf_counter()
        leapmap.solve(slope=slope, mass_ratio=mass, offset_ratio=offset, **friction)
        runs.append(slope.size * mass.size / (time.perf_counter() - begun))
    return statistics.median(runs)


def main():
    with tempfile.TemporaryDirectory() as folder:
        page = os.path.join(folder, "leapmap.html")
        subprocess.run(
            [EXPLORER, "--module", os.path.join(BUILD, "leapmap.wasm"), "-o", page], check=True,
            stdout=subprocess.DEVNULL)
        b = browser(os.path.join(folder, "profile"))
        try:
            b.get(f"file://{page}")
            for model, words, friction in (("sticking", "never slips", {}), ("coulomb", "Coulomb", {
                    "friction": "coulomb"
            })):
                time.sleep(2)
                b.execute_script(
                    "const s = document.getElementById('live-model'); s.value = arguments[0]; "
                    "s.dispatchEvent(new Event('change'))",
                    model)
                time.sleep(6)
                b.execute_script(
                    "if (document.getElementById('play').textContent.includes('pause')) "
                    "document.getElementById('play').click()"
                )
                runs = []
                for value in (0.9, 0.7, 0.5, 0.8, 0.6, 0.65, 0.75, 0.85, 0.95):
                    runs.append(b.execute_async_script(DRAG, value))
                    time.sleep(1.0 if model == "sticking" else 2.5)
                coarse, whole, solved = (statistics.median(run[k] for run in runs) for k in range(3))
                there = native(friction)
                print(
                    f"{words}: slider to coarse picture {coarse:.0f} ms, to the whole {whole:.0f} ms; page "
                    f"{30000 / solved * 1000:,.0f} designs/s, "
                    f"leapmap {there:,.0f} designs/s, {there * solved / 30000 / 1000:.1f} times the page")
            b.execute_script(
                "const s = document.getElementById('live-model'); s.value = 'sticking'; s.dispatchEvent(new "
                "Event('change'))"
            )
            time.sleep(3)
            print(
                f"a hoop at play: {statistics.median(b.execute_async_script(FRAMES) for _ in range(3)):.0f} "
                "frames a second"
            )
        finally:
            b.quit()


if __name__ == "__main__":
    main()
