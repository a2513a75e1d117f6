# SPDX-License-Identifier: GPL-3.0-or-later
"""One look for all charts: fonts, colours, and how a figure is saved."""
import argparse
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

NO_JUMP = "#d9d9d9"  # grey: the model gives no jump
EDGE = "#303030"  # outlines and hatching
MARK = "#d62728"  # the paper's hoop
plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 9, "axes.labelsize": 9, "legend.fontsize": 8, "figure.dpi": 100,
    "savefig.dpi": 120, "hatch.linewidth": 0.4, "hatch.color": EDGE,
    "svg.hashsalt": "leapmap",
    "svg.fonttype": "none",
})


def parser(description, source, default_output):
    """The command line every chart shares."""
    p = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("source", metavar="FILE", help=source)
    p.add_argument("-o", "--output", default=default_output,
                   help="file name without ending; PNG and SVG are written (default: %(default)s)")
    return p


def stem(output):
    """A file name without its ending, should the user have given one."""
    return output.removesuffix(".png").removesuffix(".svg")


def save(figure, output):
    """Writes PNG and SVG and says where they are."""
    output = stem(output)
    folder = os.path.dirname(output)
    if folder:
        os.makedirs(folder, exist_ok=True)
    for ending, metadata in (("png", None), ("svg", {"Date": None})):
        path = f"{output}.{ending}"
        figure.savefig(path, metadata=metadata)
        print(path)
    plt.close(figure)


def run(main, *errors):
    """Runs a chart's main; the errors named end it with one line and status 2."""
    try:
        main()
    except errors as error:
        print(f"{os.path.basename(sys.argv[0])}: {error}", file=sys.stderr)
        sys.exit(2)
