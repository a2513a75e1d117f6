# SPDX-License-Identifier: GPL-3.0-or-later
"""What no compiler tells of the sources as a whole."""
import re

from support.program import TOP

TYPE = re.compile(r"^(?:class|struct|enum class|union) (\w+)(?: final)?(?: : .*)? \{")
NAMESPACE = re.compile(r"^(?:inline )?namespace ?([\w:]*) ?\{")


def types_of(text):
    """Types that other files can see, by their whole names; clang-format keeps namespaces and what is in them at the margin."""
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
