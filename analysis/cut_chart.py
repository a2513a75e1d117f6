#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw cuts through a map: quantities along one axis, one line for each of several values of a second axis.

Solid lines: the first lift-off is the jump. Dashed lines: it is spurious. Gaps: no jump, or a discontinuity.
Axes that are neither drawn nor fixed by --at stay at the value nearest to the paper's hoop, or in the middle.
"""
import numpy as np

import looks
import planes
import style
from read_map import NotAMap, read_map
from style import plt

MOST_LINES = 6
# Told apart by everybody, and on white (Okabe and Ito).
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9")


def axes_of(m, along, by, fixed):
    """The axis drawn to the right, and the one of which each line has a value: as asked, or the best."""
    free = [n for n in m.dims if n not in fixed]
    if "design" in m.dims:
        raise NotAMap(f"{m.path}: is a list of designs, which has no axis to cut along")
    along = along or next((n for n in ("slope", *free) if n in free and len(m.dims[n]) > 1), None)
    if along not in free or len(m.dims[along]) < 2:
        raise NotAMap(f"{m.path}: has no axis {along or 'of two values or more'} to cut along; it has "
                      f"{', '.join(m.dims)}")
    others = [n for n in free if n != along]
    if by is not None and by == along:
        raise NotAMap(f"{m.path}: --along and --by are both {by}")
    if by is not None and by not in others:
        raise NotAMap(f"{m.path}: has no other axis {by}; it has {', '.join(others) or 'none'}")
    return along, by or next((n for n in ("mass_ratio", *others) if n in others), None)


def picked_values(m, by, wanted):
    """The places along `by` of which lines are drawn."""
    if not by:
        if wanted:
            raise NotAMap(f"{m.path}: --values: there is no second axis to have them")
        return [0]
    if wanted:
        places = [planes.fixed_at(m, [f"{by}={value}"], "--values")[by] for value in wanted.split(",")]
        return list(dict.fromkeys(places))
    n, ranked = len(m.dims[by]), np.argsort(m.dims[by])
    return [int(ranked[i]) for i in np.unique(np.linspace(0, n - 1, min(n, MOST_LINES)).round().astype(int))]


def draw_line(axis, x, y, flags, course, colour):
    """One line, torn where the course of events changes, dashed where the first lift-off is spurious."""
    torn = looks.cliffs(course, 0) if course is not None else np.zeros(0, bool)
    y = np.insert(y, np.flatnonzero(torn) + 1, np.nan)
    x = np.insert(x, np.flatnonzero(torn) + 1, np.nan)
    flags = np.insert(flags, np.flatnonzero(torn) + 1, 255)
    for spurious, line_style, width in ((False, "-", 2.0), (True, (0, (3, 1.2)), 1.1)):
        part = np.where((flags == 1) == spurious, y, np.nan)
        axis.plot(x, part, color=colour, linewidth=width, linestyle=line_style)
        here = np.isfinite(np.concatenate([[np.nan], part, [np.nan]]))
        alone = here[1:-1] & ~here[:-2] & ~here[2:]  # a line through one design is none
        axis.plot(x[alone], part[alone], ".", color=colour, markersize=3)


def chart(m, along, by, wanted, at, fields):
    fixed = planes.fixed_at(m, at)
    along, by = axes_of(m, along, by, fixed)
    middle = {n: np.argsort(v)[len(v) // 2] for n, v in m.dims.items()}
    paper = {n: np.argmin(np.abs(v - looks.PAPER[n])) for n, v in m.dims.items() if n in looks.PAPER}
    index = {n: int(place) for n, place in (middle | paper).items()} | fixed
    found = {f: looks.quantity(m, f) for f in fields}
    drawn = {f: values for f, values in found.items() if values is not None and np.isfinite(values).any()}
    if not drawn:
        raise NotAMap(f"{m.path}: has none of {', '.join(fields)} to draw; it has {', '.join(m.fields)}")

    names = list(m.dims)
    order = np.argsort(m.dims[along])
    x = looks.as_shown(along, m.dims[along][order])

    def line(array, k):
        here = dict(index)
        if by:
            here[by] = k
        return array[tuple(slice(None) if n == along else here[n] for n in names)][order]

    picked = picked_values(m, by, wanted)
    figure, axes = plt.subplots(len(drawn), 1, sharex=True, squeeze=False,
                                figsize=(6.6, 2.5 * len(drawn) + 1.4), layout="constrained")
    colours = [COLOURS[i % len(COLOURS)] for i in range(len(picked))]
    course = looks.course(m)
    for axis, (field, values) in zip(axes[:, 0], drawn.items()):
        for colour, k in zip(colours, picked):
            spurious = m.fields.get("spurious_first_jump")
            axis.plot([], [], color=colour,
                      label=looks.titled(by, m.dims[by][k]) if by else "first lift-off is the jump")
            draw_line(axis, x, line(values, k).astype(float),
                      line(spurious, k) if spurious is not None else np.zeros(len(x)),
                      line(course, k) if course is not None else None, colour)
        axis.set_ylabel(planes.field_label(field))
        axis.grid(alpha=0.25)
        if looks.is_log(x):
            style.log_scale(axis.xaxis)
    others = {n: m.dims[n][index[n]] for n in names if n not in (along, by)}
    words = looks.words_of(m, looks.fixed_numbers(m) | others)
    axes[-1, 0].set_xlabel(f"{planes.axis_label(along)}\n{style.wrapped(words, figure)}")
    handles = axes[0, 0].get_legend_handles_labels()[0]
    handles.append(plt.Line2D([], [], color="#404040", linestyle=(0, (3, 1.2)),
                              label="dashed: first lift-off below the threshold"))
    style.legend_above(figure, handles)
    return figure


def main():
    p = style.parser(__doc__, "a map, for example maps/slope_mass_ratio_offset.h5", "_cut")
    p.add_argument("--along", metavar="AXIS",
                   help="the axis drawn to the right (default: slope, or the map's first)")
    p.add_argument("--by", metavar="AXIS",
                   help="the axis that lines are drawn for (default: mass_ratio, or the map's next)")
    p.add_argument("--values", metavar="V,V,...",
                   help="of that axis, those nearest to these (default: six, spread over it)")
    planes.add_at(p)
    planes.add_fields(p)
    planes.add_units(p)
    arguments = p.parse_args()
    fields = planes.fields_of(arguments)
    m = planes.in_units(read_map(arguments.source), arguments.units)
    style.save(chart(m, arguments.along, arguments.by, arguments.values, arguments.at, fields),
               arguments.output)


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
