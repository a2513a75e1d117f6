# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw charts of maps, traces and tables, and make the page to explore a map.

    python3 -m leapmap.charts design MAP.h5 -o chart
    python3 -m leapmap.charts CHART --help
"""
import os
import runpy
import sys

from leapmap._analysis import FOLDER

CHARTS = {
    name: name + "_chart.py"
    for name in ("adequacy", "cut", "design", "experiment", "fit", "front", "gait", "jump", "list", "period",
                 "precision", "proof", "scatter", "stability", "status", "trace", "yield")
}
CHARTS |= {
    "explorer": "explorer", "phases": "phase_diagram.py", "scatter_convergence": "scatter_convergence.py"
}


def main():
    words = sys.argv[1:]
    if not words or words[0] in ("-h", "--help"):
        print(__doc__.strip(), "\n\nCHART is one of: ", ", ".join(CHARTS), sep="")
        return 0 if words else 2
    if words[0] not in CHARTS:
        print(f"leapmap.charts: {words[0]!r} is not a chart; allowed: {', '.join(CHARTS)}", file=sys.stderr)
        return 2
    script = os.path.join(FOLDER, CHARTS[words[0]])
    sys.argv = [script, *words[1:]]
    sys.path.insert(0, FOLDER)
    runpy.run_path(script, run_name="__main__")
    return 0


if __name__ == "__main__":
    sys.exit(main())
