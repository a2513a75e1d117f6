#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw a list of designs: quantities over a parameter, one dot for each design.

Filled: the first lift-off is the jump. Hollow: it is spurious. Designs that do not jump are at the bottom, by
the reason. Needs a map of a spec with design.points."""
import numpy as np

import looks
import planes
import style
from read_map import NotAMap, read_map
from style import plt

MOST_LABELS = 40  # more names would hide each other


def values_along(m, name):
    """What the designs are drawn over, as shown, and its label: a parameter of the list, or their number in
    it."""
    if name == "design":
        return m.dims[
            "design"], "designs of the list" if m.labels is not None else "number in the list, from 0"
    if name not in m.fields or looks.parameter(name) == (name, name, ""):
        raise NotAMap(f"{m.path}: -x {name}: is no parameter of this list; allowed: "
                      f"{', '.join(['design', *looks.listed(m)])}")
    return looks.as_shown(name, m.fields[name]), planes.axis_label(name)


def chart(m, along, fields):
    if "design" not in m.dims:
        raise NotAMap(f"{m.path}: is no list of designs but a grid; design_chart.py and cut_chart.py draw it")
    along = "design" if along == "label" else along or next(
        (n for n in looks.listed(m) if len(np.unique(m.fields[n])) > 1), "design")
    x, label = values_along(m, along)
    drawn = {
        f: values
        for f in fields
        if (values := looks.quantity(m, f)) is not None and np.isfinite(values).any()
    }
    if not drawn:
        raise NotAMap(f"{m.path}: has none of {', '.join(fields)} to draw; it has {', '.join(m.fields)}")
    spurious = m.fields["spurious_first_jump"] == 1 if "spurious_first_jump" in m.fields else np.zeros(
        len(x), bool)
    reasons = {code: m.code("status", code) for code in looks.STATUSES} if "status" in m.fields else {}

    figure, axes = plt.subplots(len(drawn), 1, sharex=True, squeeze=False,
                                figsize=(6.6, 2.5 * len(drawn) + 1.4), layout="constrained")
    for axis, (field, values) in zip(axes[:, 0], drawn.items()):
        axis.plot(x[~spurious], values[~spurious], "o", markersize=4, color="#1b7837")
        axis.plot(x[spurious], values[spurious], "o", markersize=4, markerfacecolor="none", color="#e08214")
        for code, there in reasons.items():
            axis.plot(x[there], np.full(there.sum(), 0.02), "x", markersize=4, color=looks.STATUSES[code][0],
                      transform=axis.get_xaxis_transform(), in_layout=False)
        axis.set_ylabel(planes.field_label(field))
        axis.grid(alpha=0.25)
        if m.labels is not None and len(x) <= MOST_LABELS and along != "design" and axis is axes[0, 0]:
            for named, *place in zip(m.labels, x, values):
                if np.isfinite(place[1]):
                    axis.annotate(named, place, parse_math=False, xytext=(4, 4), textcoords="offset points",
                                  fontsize=7, annotation_clip=False)
            axis.margins(x=0.12, y=0.12)
    if m.labels is not None and len(x) <= MOST_LABELS and along == "design":
        axes[-1, 0].set_xticks(x, m.labels, parse_math=False, rotation=35, ha="right")
    if along != "design" and looks.is_log(np.unique(x)):
        style.log_scale(axes[-1, 0].xaxis)
    axes[-1, 0].set_xlabel(f"{label}\n{style.wrapped(looks.words_of(m, looks.fixed_numbers(m)), figure)}")
    marker = lambda sign, colour, words, fill="full": plt.Line2D([], [], linestyle="", marker=sign, color=
                                                                 colour, fillstyle=fill, label=words)
    handles = [
        marker("o", "#1b7837", "first lift-off is the jump"),
        marker("o", "#e08214", "first lift-off below the threshold", "none")
    ]
    handles += [
        marker("x", looks.STATUSES[code][0], f"{looks.STATUSES[code][1]}: {there.sum()}")
        for code, there in reasons.items()
        if there.any()
    ]
    style.legend_above(figure, handles)
    return figure


def main():
    p = style.parser(__doc__, "a map of a list of designs", "_list")
    p.add_argument(
        "-x", metavar="PARAMETER", help=
        "what is drawn to the right; design: the designs in their order, by name if they have names "
        "(default: the first parameter that varies)"
    )
    planes.add_fields(p)
    planes.add_units(p)
    arguments = p.parse_args()
    fields = planes.fields_of(arguments)
    m = planes.in_units(read_map(arguments.source), arguments.units)
    style.save(chart(m, arguments.x, fields), arguments.output)


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
