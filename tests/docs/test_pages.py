# SPDX-License-Identifier: GPL-3.0-or-later
"""What pages show works: commands run and print what is shown, Python runs, C++ compiles, specs are read."""
import re
import subprocess
import sys

import pytest

from support.program import TOP, leapmap, scripted

sys.path.append(str(TOP / "docs"))
import run_blocks

sys.path.insert(0, str(run_blocks.BUILD / "python"))
from leapmap.charts import CHARTS

PAGES = sorted(
    [
        TOP / "README.md",
        TOP / "CONTRIBUTING.md",
        *(TOP / "docs").rglob("*.md"),
        *(p for f in ("src", "sweeps", "analysis", "tests") for p in (TOP / f).glob("*.md")),
    ]
)


def name_of(page):
    return str(page.relative_to(TOP))


def has(page, slow):
    return any(
        block.runs and block.slow == slow and block.kind in ("console", "python", "cpp", "toml")
        for block in run_blocks.blocks(page)
    )


@pytest.mark.parametrize("page", [p for p in PAGES if has(p, slow=False)], ids=name_of)
def test_what_a_page_shows_works(page):
    run_blocks.run_page(page)


@pytest.mark.slow
@pytest.mark.parametrize("page", [p for p in PAGES if has(p, slow=True)], ids=name_of)
def test_what_takes_long_on_a_page_works(page):
    run_blocks.run_page(page, slow=True)


def test_a_block_that_prints_something_else_is_found(tmp_path):
    page = TOP / "docs" / "no_such_page.md"
    block = run_blocks.Block(
        "console", "$ leapmap hop --jumps 2 --runway 20 | grep 'jumps of'\n9 jumps of 2: ...\n", 1, ""
    )
    with pytest.raises(run_blocks.Failed, match="jumps of 2"):
        run_blocks.run_console(block, tmp_path, [])
    run_blocks.run_console(
        run_blocks.Block("console", "$ echo a few words\na ... words\n", 1, ""), tmp_path, []
    )
    agrees = "$ echo within 2.6e-14, 0.5 m\nwithin {}, {} m\n"
    run_blocks.run_console(run_blocks.Block("console", agrees.format("2.5e-14", 0.5), 1, ""), tmp_path, [])
    for difference, length in (("2.6e-12", 0.5), ("2.6e-14", 0.6)):
        with pytest.raises(run_blocks.Failed, match="within 2.6e-14"):
            block = run_blocks.Block("console", agrees.format(difference, length), 1, "")
            run_blocks.run_console(block, tmp_path, [])
    with pytest.raises(run_blocks.Failed, match="does not compile"):
        run_blocks.run_cpp(
            run_blocks.Block(
                "cpp", "#include <leapmap/leapmap.hpp>\nleapmap::Design hoop{.slop = 1};\n", 1, ""
            )
        )
    assert not page.exists()


def test_every_option_on_the_pages_exists():
    helps, seen = {}, 0
    for page in PAGES:
        for block in run_blocks.blocks(page):
            for command, _ in run_blocks.commands(block.text) if block.kind == "console" else ():
                for part in re.split(r"&&|\||;|>", command):
                    words = part.split()
                    if len(words) < 2 or words[0] != "leapmap" or words[1].startswith("-"):
                        continue
                    if words[1] not in helps:
                        helps[words[1]] = leapmap(words[1], "--help").stdout
                    for flag in re.findall(r"(?<=\s)(--[a-z][a-z-]*)", part):
                        assert re.search(
                            rf"(?<![\w-]){flag}(?![\w-])", helps[words[1]]
                        ), f"{name_of(page)}: {part}"
                        seen += 1
    assert seen > 30


def test_links_and_pictures_of_the_pages_exist():
    seen = 0
    for page in PAGES:
        for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
            generated = (
                page.parent / target
                in {
                    TOP / "docs/reference" / f"{name}.md"
                    for name in ("parameters", "fields", "spec", "command_line", "charts", "python", "cpp")
                }
                or (page.parent / target).resolve().parent == TOP / "docs/reference"
            )
            if not target.startswith(("http", "mailto")) and not generated:
                assert (page.parent / target).exists(), f"{name_of(page)}: {target}"
                seen += 1
    assert seen > 50


def test_the_readme_has_at_most_six_hundred_words():
    assert len((TOP / "README.md").read_text(encoding="utf-8").split()) <= 600


@pytest.mark.slow  # in CI docs/build.sh checks them
def test_words_follow_the_rules():
    done = subprocess.run(
        [sys.executable, TOP / "docs/lint_words.py"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout


def test_help_fits_eighty_columns_and_begins_with_examples():
    names = re.findall(
        r"^  ([a-z]+) ", leapmap("--help").stdout.split("Commands:\n")[1].split("\n\n")[0], re.M
    )
    assert len(names) == 13
    for words in ((), *((name,) for name in names)):
        shown = leapmap(*words, "--help").stdout
        assert max(map(len, shown.splitlines())) <= 80, words
        assert shown.index("Examples:") < shown.index("Options:"), words


@pytest.mark.parametrize("script", sorted(set(CHARTS.values())))
def test_the_help_of_charts_fits_eighty_columns(script, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    shown = scripted(script, "--help")
    assert shown.returncode == 0 and max(map(len, shown.stdout.splitlines())) <= 80
