#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells of the last run of tests/run.sh which tests took longest, or which tier has what, as the table in tests/README.md."""
import argparse
import re
import xml.etree.ElementTree as ElementTree
from collections import Counter, defaultdict
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
README = TOP / "tests" / "README.md"
BEGIN, END = "<!-- tiers: made by sh tests/run.sh --all -->\n", "<!-- end of tiers -->\n"
# What the second tier has beside ctest's tests: what the first tier has of it.
STAGES = {
    "all C++ tests with ASan and UBSan (`tests/sanitized.sh`)": "`.ci/run` does so for map, support, sweep, rolling and coulomb",
    "every instruction set, each solving the reference tables; old processors by qemu": "this machine's best set",
    "libFuzzer on specs and maps, ten minutes (`tests/fuzz/run.sh`)": "`cli.test_hostile_files`: flipped bits, cut and strange files",
    "all planted errors (`tests/mutation/mutate.py`)": "`mutation.twin`: one of them, and the solvers as they are",
    "every call and allocation fails, of every command (`tests/faults/run.sh`)": "`cli.test_faults`: some of them",
}


def finished(build, tier):
    """Of each test of a tier that ran: its name, its label and its seconds."""
    for case in ElementTree.parse(build / f"{tier}.xml").iter("testcase"):
        label = case.find("properties/property[@name='cmake_labels']")
        yield case.get("name"), label.get("value") if label is not None else "", float(case.get("time"))


def folder_of(name, labels):
    """The folder whose code a test tries."""
    if "." in name and name.split(".")[0] in ("cli", "python", "analysis", "mutation"):
        return name.split(".")[0]
    return labels.split(";")[0] or "others"


def table(build):
    """Rows: a folder, how many tests of the first tier, how long they took; then what the second tier has."""
    counts, seconds = Counter(), defaultdict(float)
    for name, labels, took in finished(build, "first_tier"):
        counts[folder_of(name, labels)] += 1
        seconds[folder_of(name, labels)] += took
    lines = ["| first tier: folder | tests of ctest | seconds, two at a time |", "|---|---|---|"]
    lines += [f"| `{folder}` | {counts[folder]} | {seconds[folder]:.0f} |" for folder in sorted(counts)]
    lines += ["", "| second tier | seconds | its twin in the first |", "|---|---|---|"]
    for name, _, took in finished(build, "second_tier"):
        twin = name.removeprefix("slow.")
        lines.append(f"| `{name}` | {took:.0f} | {f'`{twin}`' if '.test_' in twin else 'the same test, smaller'} |")
    lines += [f"| {stage} | | {twin} |" for stage, twin in STAGES.items()]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, default=TOP / "build" / "release", help="the build that the tests ran on")
    parser.add_argument("--slowest", type=int, metavar="N", help="print the N slowest tests of the first tier")
    parser.add_argument("--write", action="store_true", help="put the table into tests/README.md; default: print it")
    arguments = parser.parse_args()
    if arguments.slowest:
        tests = sorted(finished(arguments.build, "first_tier"), key=lambda test: -test[2])
        print(*(f"{took:6.1f} s  {name}" for name, _, took in tests[:arguments.slowest]), sep="\n")
        return
    made = table(arguments.build)
    if not arguments.write:
        print(made, end="")
        return
    text = README.read_text()
    README.write_text(re.sub(re.escape(BEGIN) + ".*" + re.escape(END), lambda _: BEGIN + made + END, text, flags=re.DOTALL))


if __name__ == "__main__":
    main()
