# SPDX-License-Identifier: GPL-3.0-or-later
"""Common style of all charts: fonts, colours, and how a figure is saved."""
import argparse
import contextlib
import io
import os
import re
import sys
import tempfile
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import LogFormatter

EDGE = "#303030"  # outlines and hatching
MARK = "#d62728"  # the paper's hoop
plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 9, "axes.labelsize": 9, "legend.fontsize": 8, "figure.dpi": 100,
    "savefig.dpi": 120, "hatch.linewidth": 0.4, "hatch.color": EDGE,
    "svg.hashsalt": "leapmap",
    "svg.fonttype": "none", "pdf.fonttype": 42,
    "figure.autolayout": False, "figure.constrained_layout.use": False,  # save() asks for none
})


def leapmap_module():
    """The module leapmap, for charts that solve."""
    try:
        import leapmap
    except ImportError as error:
        raise OSError(
            f"needs leapmap's Python module ({error}); allowed: with PYTHONPATH=build/release/python"
        ) from None
    return leapmap


class _Parser(argparse.ArgumentParser):
    suffix = None

    def parse_args(self, *arguments, **more):
        parsed = super().parse_args(*arguments, **more)
        if parsed.output is None and self.suffix is not None:
            parsed.output = os.path.splitext(parsed.source.removesuffix(".part"))[0] + self.suffix
        return parsed


def _filled(text):
    """A script's description in lines of at most 80 columns; examples, which are indented, stay as they
    are."""
    blocks = re.split(r"\n\s*\n", text.strip())
    return "\n\n".join(block if block.startswith("    ") else textwrap.fill(block, 79) for block in blocks)


def parser(description, source, suffix,
           output="file name without ending; PNG, SVG and PDF are written (default: FILE's name{})",
           needs_source=True):
    """The command line every chart shares. suffix: what the default output adds to FILE's name, or None;
    output: what -o means."""
    p = _Parser(description=_filled(description), formatter_class=argparse.RawDescriptionHelpFormatter)
    p.suffix = suffix
    p.add_argument("source", metavar="FILE", help=source, nargs=None if needs_source else "?")
    p.add_argument("-o", "--output", help=output.format(f" with {suffix}" if suffix else ""))
    return p


def halo(texts, colour):
    """Texts on a patch of that colour, so that they can be read on any ground. No path effects: these make
    SVG's texts outlines."""
    for text in texts:
        text.set_bbox({"facecolor": colour, "alpha": 0.55, "edgecolor": "none", "pad": 0.4})


def stem(output):
    """A file name without its ending, should the user have given one."""
    return output.removesuffix(".png").removesuffix(".svg").removesuffix(".pdf")


def replace_file(path, content):
    """Writes bytes to a file, in a folder made if need be. An older file, also one behind a link, is replaced
    once the new one is on disk; whatever fails before that leaves it as it was. Raises OSError."""
    path = os.path.realpath(path)
    if os.path.exists(path) and not os.path.isfile(path):
        raise OSError(f"{path}: is a folder, a device or a pipe; allowed: a file's name")
    folder = os.path.dirname(path)
    os.makedirs(folder, exist_ok=True)
    umask = os.umask(0)
    os.umask(umask)
    mode = os.stat(path).st_mode & 0o7777 if os.path.exists(path) else 0o666 & ~umask
    descriptor, unfinished = tempfile.mkstemp(dir=folder, prefix=os.path.basename(path)[:100] + ".",
                                              suffix=".part")
    try:
        with open(descriptor, "wb", buffering=0) as file:
            os.fchmod(descriptor, mode)
            rest = memoryview(content)
            while rest:
                written = file.write(rest)
                if not written:  # a buffered file would try again indefinitely
                    raise OSError(f"{path}: nothing can be written")
                rest = rest[written:]
            os.fsync(file.fileno())
        with open(unfinished, "rb") as file:
            if file.read() != content:
                raise OSError(f"{path}: what was written cannot be read again")
        os.replace(unfinished, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(unfinished)
        raise


# What every chart is written as, with what would differ from one day to the next.
FORMATS = {"png": None, "svg": {"Date": None}, "pdf": {"CreationDate": None}}


def save(figure, output):
    """Writes PNG, SVG and PDF, the same bytes for the same map, and says where they are."""
    output = stem(output)
    for ending, metadata in FORMATS.items():
        drawn = io.BytesIO()
        figure.savefig(drawn, format=ending, metadata=metadata)
        figure.set_layout_engine(None)  # it is laid out once; any engine, even "none", draws it once more
        replace_file(f"{output}.{ending}", drawn.getvalue())
        print(f"{output}.{ending}")
    plt.close(figure)


def log_scale(axis):
    """Makes an x or y axis logarithmic, its numbers written out; within two decades also some between powers
    of ten."""
    getattr(axis.axes, f"set_{axis.axis_name}scale")("log")
    axis.set_major_formatter(lambda v, _: f"{v:g}")
    axis.set_minor_formatter(LogFormatter(minor_thresholds=(2, 0.4)))


def draw_star(axis, place, colour=MARK):
    """The paper's hoop."""
    axis.plot(*place, "*", color=colour, markersize=13, markeredgecolor="white", zorder=5)


def star_handle(colour=MARK):
    return plt.Line2D([], [], marker="*", color="none", markerfacecolor=colour, markeredgecolor="white",
                      markersize=12, label="the paper's hoop")


def swatch(colour, words, **more):
    """An entry of a legend for cells of a colour."""
    return plt.Rectangle((0, 0), 1, 1,
                         **{"facecolor": colour, "edgecolor": "#808080", "label": words, **more})


def wrapped(words, figure, size=9):
    """Words joined by commas in lines that fit a figure's width; size: the font's."""
    most = int(72 * figure.get_figwidth() / (0.56 * size))
    lines = [""]
    for word in words:
        if lines[-1] and len(lines[-1]) + len(word) + 3 > most:
            lines.append("")
        lines[-1] += (",  " if lines[-1] else "") + word
    return "\n".join(lines)


def legend_above(figure, handles):
    """A legend over all panels, in rows that fit the figure's width."""
    if not handles:
        return
    # Some 5.5 points a letter of 8 points, and the handle beside.
    longest = max(len(h.get_label()) for h in handles)
    columns = max(1, min(len(handles), int(72 * figure.get_figwidth() / (4.6 * longest + 40))))
    rows = -(-len(handles) // columns)
    figure.legend(handles=handles, loc="upper center", ncols=columns, frameon=False)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - (0.12 + 0.2 * rows) / figure.get_figheight()))


def run(main, *errors):
    """Runs a chart's main; the errors named end it with one line and status 2, a lack of memory with status
    1."""
    try:
        main()
        sys.stdout.flush()
    except errors as error:
        status, text = 2, str(error)
    except MemoryError:
        status, text = 1, "out of memory"
    else:
        return
    # no text gives a terminal orders
    text = "".join(c if c.isprintable() else f"\\x{ord(c):02x}" for c in text)
    with contextlib.suppress(OSError, AttributeError):  # a stream that is full, or closed
        print(f"{os.path.basename(sys.argv[0])}: {text}", file=sys.stderr, flush=True)
    os._exit(status)  # and not by HDF5's handler at exit, which crashes on a file that it could not close
