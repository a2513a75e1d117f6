# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pages say works: their Python blocks run, the README's commands run, every flag they name is one."""
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from support.program import PROGRAM, TOP, leapmap

PAGES = ["README.md", "sweeps/README.md", "analysis/README.md", "tests/README.md", "src/README.md", "src/python/README.md"]
BUILD = Path(os.environ["LEAPMAP_BUILD"])
ENVIRONMENT = dict(os.environ, PATH=f"{Path(PROGRAM).parent}:{os.environ['PATH']}", PYTHONPATH=str(BUILD / "python"), MPLBACKEND="Agg")


def text_of(page):
    return (TOP / page).read_text(encoding="utf-8")


def blocks():
    for page in PAGES:
        for i, code in enumerate(re.findall(r"```python\n(.*?)```", text_of(page), re.S)):
            yield pytest.param(code, id=f"{page}:{i}")
    section = text_of("README.md").split("## From Python")[1].split("\n## ")[0]
    yield pytest.param("\n".join(line[4:] for line in section.splitlines() if line.startswith("    ")), id="README.md")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where commands of the pages run: the tree's folders, and maps/ of its own with the first command's map, smaller."""
    place = tmp_path_factory.mktemp("pages")
    for name in ("sweeps", "analysis"):
        (place / name).symlink_to(TOP / name)
    (place / "maps").mkdir()
    done = leapmap("sweep", TOP / "sweeps/slope_mass_ratio_offset.toml", "-o", place / "maps/slope_mass_ratio_offset.h5", "--quiet",
                   "--set", 'slope={from="2 deg",to="50 deg",count=13}', "--set", "mass_ratio={from=0.1,to=20,count=12}")
    assert done.returncode == 0, done.stderr
    return place


@pytest.mark.parametrize("code", blocks())
def test_python_blocks_run(code, folder):
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, env=ENVIRONMENT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr


LONG = ("leapmap sweep sweeps/made_hoops.toml", "leapmap design sweeps/questions/height_against_mass.toml", "leapmap fit")


@pytest.mark.parametrize("long", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["quick", "long"])
def test_the_readmes_commands_run(long, folder):
    lines = [line.split("#")[0].strip() for line in text_of("README.md").splitlines() if line.startswith("    ")]
    commands = [line for line in lines if line.startswith(("leapmap ", "/usr/bin/python3 -m leapmap")) and line.startswith(LONG) == long]
    assert len(commands) >= (3 if long else 6)
    for command in commands:
        done = subprocess.run(shlex.split(command), cwd=folder, env=ENVIRONMENT, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, f"{command}: {done.stderr}"
    assert long or list((folder / "maps").glob("*.png"))


def test_every_flag_and_command_on_the_pages_is_one():
    helps, looked_at = {}, 0
    for page in PAGES:
        for line in re.findall(r"^    (leapmap .*)$", text_of(page), re.M):
            for part in line.split("#")[0].split("&&"):
                words = part.split()
                if not words or words[0] != "leapmap" or words[1].startswith("-") or words[1] == "COMMAND":
                    continue
                if words[1] not in helps:
                    done = leapmap(words[1], "--help")
                    assert done.returncode == 0, part
                    helps[words[1]] = done.stdout
                for flag in re.findall(r"(?<=\s)(--[a-z][a-z-]*)", part):
                    assert re.search(rf"(?<![\w-]){flag}(?![\w-])", helps[words[1]]), f"{page}: {part}"
                    looked_at += 1
    assert looked_at > 10


def test_links_and_pictures_of_the_pages_are_there():
    for page in PAGES:
        for target in re.findall(r"\]\(([^)#]+)\)", text_of(page)):
            assert (TOP / page).parent.joinpath(target).exists(), f"{page}: {target}"


def test_the_readme_is_short():
    assert len(text_of("README.md").splitlines()) <= 150
