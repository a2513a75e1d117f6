#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run what pages show: commands, Python, C++ and specs; compare the output that they print.

    docs/run_blocks.py PAGE ...             check pages; exit status 1 if a block fails docs/run_blocks.py
    PAGE ... --update    write the output of their commands into the pages docs/run_blocks.py PAGE ...
    --pictures  run all of their blocks; replace the pictures that they draw and show

Blocks of a page run in order, in a folder of its own with the folders sweeps and analysis and an empty maps.

    ```console    lines after "$ " are commands of bash; then their output, in which "..." matches anything
    ```python     runs as a script; with ">>>" as a doctest
    ```cpp        compiles; without main() as the body of a function
    ```toml       is a spec that leapmap reads

A comment before a block changes that: <!-- slow --> second tier of tests; <!-- not run: REASON -->;
<!-- file: NAME --> the block is written to that file, for the commands that follow.
LEAPMAP_BUILD names the build tree; default: build/release.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
BUILD = Path(os.environ.get("LEAPMAP_BUILD", TOP / "build/release")).resolve()
SECONDS = 600  # the longest block of the second tier takes a few minutes


@dataclass
class Block:
    """A fenced block of a page."""

    kind: str
    text: str
    line: int  # of its first line in the page
    mark: str  # the comment before it

    @property
    def slow(self):
        return self.mark == "slow"

    @property
    def runs(self):
        return not self.mark.startswith("not run")


class Failed(Exception):
    """A block does not do what the page shows."""


def blocks(page):
    lines, found, mark = page.read_text(encoding="utf-8").splitlines(), [], ""
    i = 0
    while i < len(lines):
        if comment := re.fullmatch(r"<!-- (.*) -->", lines[i].strip()):
            mark = comment[1]
        elif fence := re.fullmatch(r"(\s*)(`{3,})([^`]*)", lines[i]):
            end = next(k for k in range(i + 1, len(lines)) if lines[k].strip() == fence[2])
            indent = len(fence[1])
            found.append(
                Block(
                    fence[3].strip(),
                    "\n".join(line[indent:] for line in lines[i + 1 : end]) + "\n",
                    i + 2,
                    mark,
                )
            )
            i, mark = end, ""
        elif lines[i].strip():
            mark = ""
        i += 1
    return found


def commands(text):
    """(command, expected output) of a console block."""
    found = []
    continues = False
    for line in text.splitlines():
        if continues:
            found[-1][0] += "\n" + line
        elif line.startswith("$ "):
            found.append([line[2:], ""])
        elif found:
            found[-1][1] += line + "\n"
        continues = (continues or line.startswith("$ ")) and line.endswith("\\")
    return found


ROUNDING = re.compile(r"\d(?:\.\d+)?e-1[3-9]")


def pattern(expected):
    """What matches an output: "..." anything, runs of blanks alike, and differences of some roundings, which
    are others on other processors, alike too."""
    word_of = lambda word: ROUNDING.pattern.join(re.escape(text) for text in ROUNDING.split(word))
    parts = [r"\s+".join(word_of(word) for word in part.split()) for part in expected.split("...")]
    return re.compile(r"\s*" + r"\s*.*?\s*".join(parts) + r"\s*\Z", re.S)


def environment():
    return dict(
        os.environ,
        PATH=f"{BUILD}:{os.environ['PATH']}",
        PYTHONPATH=str(BUILD / "python"),
        MPLBACKEND="Agg",
        COLUMNS="80",
    )


def run(command, folder):
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=SECONDS,
        check=False,
    )
    if done.returncode != 0:
        raise Failed(f"$ {command}\nends with status {done.returncode}:\n{done.stdout}")
    return done.stdout


def run_console(block, folder, outputs, compare=True):
    for command, expected in commands(block.text):
        got = run(command, folder)
        outputs.append((command, got))
        if compare and expected and not pattern(expected).match(got):
            raise Failed(f"$ {command}\nprints\n{got}\nand not\n{expected}")


def run_python(block, folder, before):
    if ">>>" in block.text:
        code = (
            "import doctest, sys\n"
            f"example = doctest.DocTestParser().get_doctest({block.text!r}, {{}}, 'page', 'page', 0)\n"
            "flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE\n"
            "sys.exit(doctest.DocTestRunner(optionflags=flags).run(example).failed)"
        )
    else:
        code = before + block.text
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=SECONDS,
        check=False,
    )
    if done.returncode != 0:
        raise Failed(f"{block.text}\nends with\n{done.stdout}{done.stderr}")


def run_cpp(block):
    code = block.text
    if "main(" not in code:
        includes = "".join(line + "\n" for line in code.splitlines() if line.startswith("#include"))
        code = (
            includes
            + "void example() {\n"
            + "".join(line + "\n" for line in code.splitlines() if not line.startswith("#include"))
            + "}\n"
        )
    done = subprocess.run(
        ["g++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wno-unused", f"-I{TOP / 'src'}", "-x", "c++", "-"],
        input=code,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise Failed(f"{code}\ndoes not compile:\n{done.stderr}")


def replace_pictures(page, folder):
    """Copies each picture that the page shows from the folder in which its blocks drew one of that name."""
    for link in re.findall(r"!\[[^\]]*\]\(([^)]*)\)", page.read_text(encoding="utf-8")):
        shown = (page.parent / link).resolve()
        drawn = folder / "maps" / shown.name
        if drawn.exists():
            shutil.copyfile(drawn, shown)
        print(f"{shown.relative_to(TOP)}: {'replaced' if drawn.exists() else 'not drawn by this page'}")


def run_page(page, slow=False, compare=True, pictures=False):
    """Runs the blocks of a page, those of the second tier only if slow; returns the outputs of its
    commands."""
    outputs, before = [], ""
    with tempfile.TemporaryDirectory(prefix="leapmap-page-") as name:
        folder = Path(name)
        for part in ("sweeps", "analysis", "tests"):
            (folder / part).symlink_to(TOP / part)
        (folder / "maps").mkdir()
        for block in blocks(page):
            if not block.runs:
                continue
            if block.mark.startswith("file: "):
                (folder / block.mark.removeprefix("file: ")).write_text(block.text, encoding="utf-8")
                continue
            if block.slow and not slow:
                continue
            try:
                if block.kind == "console":
                    run_console(block, folder, outputs, compare)
                elif block.kind == "python":
                    run_python(block, folder, before)
                    before += "" if ">>>" in block.text else block.text
                elif block.kind == "cpp":
                    run_cpp(block)
                elif block.kind == "toml":
                    (folder / "block.toml").write_text(block.text, encoding="utf-8")
                    run("leapmap sweep block.toml -o block.h5 --dry-run", folder)
            except Failed as error:
                raise Failed(f"{page.relative_to(TOP)}:{block.line}: {error}") from None
        if pictures:
            replace_pictures(page, folder)
    return outputs


def updated(page):
    """The page with the outputs that its commands print."""
    text = page.read_text(encoding="utf-8")
    for command, got in run_page(page, slow=True, compare=False):
        start = text.index("$ " + command + "\n") + len(command) + 3
        end = min(k for k in (text.find("\n$ ", start - 1), text.find("\n```", start - 1)) if k >= 0) + 1
        if text[start:end].strip():
            text = text[:start] + re.sub(r"[ \t]+\n", "\n", got.rstrip("\n") + "\n") + text[end:]
    return text


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("pages", nargs="+", type=Path)
    parser.add_argument("--update", action="store_true", help="write the output of commands that show any")
    parser.add_argument("--slow", action="store_true", help="run blocks of the second tier too")
    parser.add_argument("--pictures", action="store_true", help="with --slow's blocks; replace the pictures")
    arguments = parser.parse_args()
    status = 0
    for page in arguments.pages:
        try:
            if arguments.update:
                page.write_text(updated(page.resolve()), encoding="utf-8")
            else:
                run_page(page.resolve(), arguments.slow or arguments.pictures, pictures=arguments.pictures)
        except Failed as error:
            print(error, file=sys.stderr)
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main())
