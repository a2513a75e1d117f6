#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells of the last run of tests/run.sh which tests took longest, or which tier has what, as the table in
tests/README.md."""
import argparse
import json
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
README = TOP / "tests" / "README.md"
BEGIN, END = "<!-- tiers: made by sh tests/run.sh --all -->\n", "<!-- end of tiers -->\n"
# Twins of other names.
TWINS = {
    "cli.test_slurm": "`cli.test_shards`: by GNU parallel",
    "analysis.test_firefox": "`analysis.test_live`: in chromium",
    "cli.test_stability": "`cli.test_stability`: without programs of others",
    "mutation": "`mutation.none`: the solvers as they are"
}
# What the second tier has beside ctest's tests: what the first tier has of it.
STAGES = {
    "all C++ tests with ASan and UBSan (`tests/sanitized.sh`)": "before a change to files, films or lanes: "
    "`sh tests/sanitized.sh map film`",
    "every instruction set, each solving the reference tables; old processors by qemu": "this machine's "
                                                                                        "best set",
    "libFuzzer on specs and maps, ten minutes (`tests/fuzz/run.sh`)": "`cli.test_hostile_files`: flipped "
    "bits, cut and strange files",
    "every call fails, and allocations do (`tests/faults/run.sh`)": "`cli.test_faults`: some of them",
}


def listed(build):
    """Of each test of ctest: its name and its label."""
    told = json.loads(
        subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, capture_output=True, text=True,
                       check=True).stdout)
    for test in told["tests"]:
        labels = [p["value"] for p in test.get("properties", ()) if p["name"] == "LABELS"]
        yield test["name"], labels[0][0] if labels else ""


def seconds(build, tier):
    """Of each test of a tier that ran: how long it took."""
    try:
        return {
            case.get("name"): float(case.get("time"))
            for case in ElementTree.parse(build / f"{tier}.xml").iter("testcase")
        }
    except FileNotFoundError:
        return {}


def table(build):
    """Rows: a folder, how many tests of the first tier it has and how long they took; then what the second
    tier has."""
    tests = list(listed(build))
    first, second = seconds(build, "first_tier"), seconds(build, "second_tier")
    lines = ["| first tier: folder | tests of ctest | seconds of them, one by one |", "|---|---|---|"]
    for folder in sorted({label for _, label in tests} - {"slow"}):
        names = [name for name, label in tests if label == folder]
        lines.append(f"| `{folder}` | {len(names)} | {sum(first.get(name, 0.0) for name in names):.0f} |")
    lines += ["", "| second tier | seconds | its twin in the first |", "|---|---|---|"]
    for name, label in tests:
        twin = name.removeprefix("slow.")
        if label == "slow":
            known = f"{second[name]:.0f}" if name in second else ""
            lines.append(
                f"| `{name}` | {known} | "
                f"{TWINS.get(twin) or (f'`{twin}`' if '.test_' in twin else 'the same test, smaller')} |"
            )
    lines += [f"| {stage} | | {twin} |" for stage, twin in STAGES.items()]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, default=TOP / "build" / "release",
                        help="the build that the tests ran on")
    parser.add_argument("--slowest", type=int, metavar="N",
                        help="print the N slowest tests of the first tier")
    parser.add_argument("--write", action="store_true",
                        help="put the table into tests/README.md; default: print it")
    arguments = parser.parse_args()
    if arguments.slowest:
        tests = sorted(seconds(arguments.build, "first_tier").items(), key=lambda test: -test[1])
        if not tests:
            sys.exit(f"{arguments.build}: has no first_tier.xml; run sh tests/run.sh")
        print(*(f"{took:6.1f} s  {name}" for name, took in tests[:arguments.slowest]), sep="\n")
        return
    made = table(arguments.build)
    if not arguments.write:
        print(made, end="")
        return
    text = README.read_text()
    README.write_text(
        re.sub(re.escape(BEGIN) + ".*" + re.escape(END), lambda _: BEGIN + made + END, text, flags=re.DOTALL))


if __name__ == "__main__":
    main()
