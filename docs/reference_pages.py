#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the pages of the reference that follow from leapmap's tables and help: reference_pages.py FOLDER."""
import re
import subprocess
import sys
from pathlib import Path

import leapmap
from leapmap import _core
from leapmap.charts import CHARTS

TOP = Path(__file__).resolve().parents[1]
PUBLIC = (
    "solve",
    "gradient",
    "trace",
    "gaits",
    "sweep",
    "load",
    "scatter",
    "design",
    "fit",
    "read_film",
    "phase_letters",
    "instruction_set",
    "instruction_sets",
    "use_instruction_set",
)
CLASSES = ("Hoop", "Weight", "Outcomes", "Motion", "Status", "Estimate", "Found", "DesignProblem", "Fit",
           "FittedParameter")
HEADERS = (
    ("Designs and scenes", ("body", "design", "scene", "units")),
    ("Solving", ("outcome", "solve", "gradient", "motion", "trace", "gait")),
    ("Sweeps and maps", ("spec", "sweep", "audit", "join", "map")),
    (
        "Discontinuities, tolerances, searches, fits",
        ("boundaries", "estimate", "scatter", "prove", "worst_case", "find_designs", "film", "fit"),
    ),
    ("Errors and versions", ("errors", "version")),
)


def sentence(text):
    return text[0].upper() + text[1:]


def escaped(text):
    return text.replace("|", "\\|").replace("_", "\\_").replace("*", "\\*")


def table(head, rows):
    return (
        "\n".join(
            [
                "| " + " | ".join(head) + " |",
                "|" + "---|" * len(head),
                *("| " + " | ".join(row) + " |" for row in rows),
            ]
        )
        + "\n"
    )


def parameters():
    rows = [
        (
            f"`{row['name']}`",
            escaped(sentence(row["meaning"])),
            row["unit"] if row["unit"] != "1" else "",
            escaped(row["allowed"]),
            "`mu_static`" if row["default"] != row["default"] else f"{row['default']:.6g}",
        )
        for row in _core.parameters()
    ]
    return (
        "# Parameters\n\nOne design is a value of each of these. All take an axis in a spec but those of the "
        "scene\n"
        "(`rest_speed`, `runway`, `hop_height`, `clear_height`, `radius`, `gravity`, `mass`), which are the "
        "same for all designs. "
        "Angles are\n"
        'in radians, or written `"30 deg"`.\n\n' + table(
            ("name", "meaning", "unit", "allowed", "default"), rows))


def fields():
    rows = []
    for row in _core.fields():
        only = f"; {row['friction']} only" if row["friction"] else ""
        codes = (
            "; " + ", ".join(f"{code}: {name}" for code, name in enumerate(row["codes"]))
            if row["codes"]
            else ""
        )
        rows.append(
            (
                f"`{row['name']}`",
                escaped(sentence(row["meaning"]) + only + codes),
                row["unit"] if row["unit"] != "1" else "",
                row["type"],
            )
        )
    statuses = table(
        ("code", "status", "meaning"),
        [(str(int(status)), f"`{status.name}`", STATUSES[status.name]) for status in leapmap.Status],
    )
    return (
        "# Fields and statuses\n\nThe outcome of a design. A quantity that does not apply is NaN, and "
        "`status` says why.\n"
        "Times are in seconds. A pure number has "
        "no unit\nhere; its meaning names what it is measured in.\n\n" + table(
            ("name", "meaning", "unit", "type"), rows) +
        "\nWith `scene.jumps` there are also `jump_height_2`, `jump_time_2` and so on; with "
        "`output.gradients`\n"
        "derivatives such as `jump_height_by_slope`; with `[scatter]` `yield`, `cut_off`, `unsolved` and "
        "statistics\n"
        "such as `jump_height_q05`. See\n"
        "[](file_format.md).\n\n## Statuses\n\n" + statuses)


STATUSES = {
    "not_computed": "Not solved yet, in an incomplete map.",
    "jumped": "It jumps.",
    "no_jump": "It reaches the rolling limit first.",
    "stalled": "It is trapped: it rocks between two turning points, or rests in an equilibrium.",
    "airborne_at_release": "The normal force is negative at the release.",
    "indeterminate": "The equations of rigid bodies have no solution or two: Painlevé's paradox, or a motor "
                     "that "
    "alone would lift the hoop.",
    "failed": "The method could not solve it.",
}
SECTIONS = {
    "scene": "Contact model, definition of a jump, size.",
    "design": "A number, or an axis: a dimension of the map, in the order of the spec.",
    "numerics": "Method and cross-check.",
    "gait": "Any key of this section switches on the search for gaits.",
    "output": "What the map stores. What is not stored is not computed.",
    "scatter": 'Tolerances of manufactured hoops: `PARAMETER = { normal = "1 deg" }` (standard deviation) or '
    '`{ uniform = "2 %" }` (half width).',
    "goal": "`FIELD = { at_least = 0.8 }`, `{ at_most = 0.6 }`, both, or `{ is = 0 }`.",
}


def spec():
    text = (
        "# The spec\n\nA spec is a TOML file. Every key has a default, the paper's hoop; an unknown key is "
        "an error.\n"
        "On the command line\n"
        "`--set KEY=VALUE` overrides a key.\n\n## Axes\n\n" + table(
            ("written", "meaning"),
            [
                ('`slope = 0.4`, `slope = "20 deg"`', "one value"),
                ('`slope = { from = "2 deg", to = "50 deg", count = 241 }`', "equal distances"),
                ('`mass_ratio = { from = 0.1, to = 20, count = 256, scale = "log" }`', "equal ratios"),
                ("`slope = { from = 0.1, to = 0.5, step = 0.1 }`", "a whole number of steps"),
                ("`offset_ratio = { values = [0.6, 0.8, 1.0] }`", "a list"),
                (
                    '`slope = { from = "2 deg", to = "20 deg" }`',
                    "bounds of a free parameter, for `leapmap design` and `fit`",
                ),
            ],
        ) +
        '\nA list of designs instead of axes: `points = "designs.csv"`, a file whose header names '
        'parameters, one\n'
        "design in a row. A column `label` names them. Parameters that it leaves out come from the spec. "
        "Numbers are in\n"
        "the parameter's unit (angles in rad); `30deg` is allowed too:\n"
        "\n```text\nlabel,slope,mass_ratio\nprototype,22.9deg,2.44\nlight,0.35,1.8\n```\n")
    for section, about in SECTIONS.items():
        rows = [
            (
                f"`{row['key']}`" + (" \\*" if row["axis"] else ""),
                escaped(sentence(row["meaning"])),
                row["unit"] if row["unit"] != "1" else "",
                escaped(row["allowed"]),
                escaped(row["default"]),
            )
            for row in _core.spec_keys()
            if row["section"] == section and not row["one_of_many"]
        ]
        text += f"\n## [{section}]\n\n{about}\n\n" + table(
            ("key", "meaning", "unit", "allowed", "default"), rows
        )
    specs = [
        (f"`{path.relative_to(TOP)}`", escaped(first_comment(path)))
        for path in sorted((*(TOP / "sweeps").glob("*.toml"), *(TOP / "sweeps/questions").glob("*.toml")))
    ]
    return (
        text
        + "\nKeys marked \\* take an axis.\n\n## Specs that come with leapmap\n\n"
        + table(("file", "about"), specs)
    )


def first_comment(path):
    return next(
        line.removeprefix("# ")
        for line in path.read_text().splitlines()
        if line.startswith("# ") and "SPDX" not in line
    )


def help_of(*words):
    return subprocess.run(["leapmap", *words, "--help"], check=True, capture_output=True, text=True).stdout


def command_line():
    top = help_of()
    commands = re.findall(r"^  ([a-z]+) ", top.split("Commands:\n")[1].split("\n\n")[0], re.M)
    return (
        "# Command line\n\n```text\n"
        + top
        + "```\n"
        + "".join(f"\n## leapmap {name}\n\n```text\n{help_of(name)}```\n" for name in commands)
    )


def charts():
    text = (
        "# Charts\n\n`python3 -m leapmap.charts NAME FILE` draws a chart as PNG, SVG and PDF. From a clone "
        "the scripts run\n"
        "by themselves, `analysis/design_chart.py MAP`. `-o` names the output without its ending; `-x` and "
        "`-y` choose\n"
        "axes; `--at AXIS=VALUE` fixes others.\n")
    for name, script in sorted(CHARTS.items()):
        about = re.search(r'"""(.*?)"""', (TOP / "analysis" / script).read_text(), re.S)[1]
        text += (
            f"\n## {name}\n\n"
            + re.sub(
                r"(?m)^    (.*\n?)+",
                lambda m: "```text\n" + re.sub(r"(?m)^    ", "", m[0]).rstrip() + "\n```\n",
                about.strip(),
            )
            + "\n"
        )
    return text


def python():
    text = "# Python\n\n```{eval-rst}\n.. currentmodule:: leapmap\n"
    text += "".join(f"\n.. autofunction:: leapmap.{name}\n" for name in PUBLIC)
    return text + "".join(f"\n.. autoclass:: leapmap.{name}\n   :members:\n" for name in CLASSES) + "```\n"


def cpp():
    text = "# C++\n\n`#include <leapmap/leapmap.hpp>` includes all of these headers.\n"
    for title, headers in HEADERS:
        text += f"\n## {title}\n"
        for header in headers:
            text += f"\n### leapmap/{header}.hpp\n\n```{{eval-rst}}\n.. doxygenfile:: {header}.hpp\n"
            text += (
                "   :sections: briefdescription detaileddescription innerclass enum func var define\n```\n"
            )
    return text


def main():
    folder = Path(sys.argv[1])
    missing = (
        {path.stem for path in (TOP / "src/leapmap").glob("*.hpp")}
        - {name for _, names in HEADERS for name in names}
        - {"leapmap"}
    )
    missing |= set(leapmap.__all__) - set(PUBLIC) - set(CLASSES)
    if missing:
        sys.exit(f"reference_pages.py: not in the reference: {', '.join(sorted(missing))}")
    for page in (parameters, fields, spec, command_line, charts, python, cpp):
        (folder / f"{page.__name__}.md").write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
