# SPDX-License-Identifier: GPL-3.0-or-later
"""What no compiler tells of the sources as a whole."""
import importlib.util
import json
import os
import re
from pathlib import Path

from support.program import TOP, finished

TYPE = re.compile(r"^(?:class|struct|enum class|union) (\w+)(?: final)?(?: : .*)? \{")
NAMESPACE = re.compile(r"^(?:inline )?namespace ?([\w:]*) ?\{")


def types_of(text):
    """Types that other files can see, by their whole names; clang-format keeps namespaces and what is in them
    at the margin."""
    open_ones = []
    for line in text.splitlines():
        if begun := NAMESPACE.match(line):
            open_ones.append(begun[1])
        elif line.startswith("}  // namespace"):
            open_ones.pop()
        elif (found := TYPE.match(line)) and "" not in open_ones:
            yield "::".join([*open_ones, found[1]])


def test_no_two_types_of_a_namespace_share_a_name():
    """The linker keeps one destructor of both, and calls it on either."""
    files = {}
    for path in sorted((TOP / "src").rglob("*.[ch]pp")):
        for name in types_of(path.read_text()):
            files.setdefault(name, []).append(str(path.relative_to(TOP)))
    assert len(files) > 100  # they are found
    assert {name: where for name, where in files.items() if len(where) > 1} == {}


def test_includes_point_to_rooms_above_their_own():
    rooms = re.findall(r"^\| `(\w+)` \|", (TOP / "src/README.md").read_text(), re.M)
    assert sorted(rooms) == sorted(p.name for p in (TOP / "src").iterdir() if p.is_dir())
    wrong, includes = [], 0
    for path in (TOP / "src").rglob("*.[ch]pp"):
        room = path.relative_to(TOP / "src").parts[0]
        for header, target in re.findall(r'^#include "((\w+)/[^"]+)"', path.read_text(), re.M):
            includes += 1
            if target != room and rooms.index(target) > rooms.index(room):
                wrong.append(f"{path.relative_to(TOP)} includes {header}")
    assert includes > 1000 and wrong == []


def test_lines_have_at_most_110_columns():
    ours = [TOP / folder for folder in ("analysis", "docs", "src", "sweeps", "tests")]
    files = [*TOP.glob("CMakeLists.txt"), *TOP.glob("cmake/*.cmake"), *TOP.glob("src/**/*.cmake"),
             *TOP.glob("tests/**/CMakeLists.txt"),
             TOP / "analysis/explorer"]
    for kind in ("[ch]pp", "py", "js"):
        files += [path for folder in ours for path in folder.rglob(f"*.{kind}")]
    long = [
        f"{path}:{number}" for path in files for number, line in enumerate(path.read_text().splitlines(), 1)
        if len(line) > 110
    ]
    assert len(files) > 300 and long == []


def test_every_error_that_is_planted_has_its_place():
    """The errors themselves are planted in the second tier, which takes a quarter of an hour."""
    spec = importlib.util.spec_from_file_location("mutate", TOP / "tests/mutation/mutate.py")
    mutate = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(mutate)
    places = {
        name: mutate.header_of(TOP / "src", file).read_text().count(old)
        for name, (file, old, _) in mutate.MUTATIONS.items()
    }
    assert len(places) > 40 and {name: count for name, count in places.items() if count != 1} == {}


def test_ctest_runs_every_test_in_cpp_once():
    build = Path(os.environ["LEAPMAP_BUILD"])
    ours, suite = [], ""
    for line in finished(build / "tests/leapmap-tests", "--gtest_list_tests").stdout.splitlines()[1:]:
        if line.startswith("  "):
            ours.append(suite + line.split("#")[0].strip())
        else:
            suite = line.split("#")[0].strip()
    told = json.loads(finished("ctest", "--test-dir", build, "--show-only=json-v1").stdout)
    theirs = [t["command"][1].removeprefix("--gtest_filter=") for t in told["tests"]
              if t.get("command", [""])[0].endswith("leapmap-tests") and not t["name"].startswith("slow.")]
    assert sorted(theirs) == sorted(ours)
