#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the yield of manufactured hoops over two axes of a map of a sweep with [scatter] and [goal].

The yield has isolines at 50, 90 and 99 %, and the discontinuities of nominal hoops if leapmap boundaries has
found them. Beside it: the nominal height, and the 5 % quantile of the height of manufactured hoops, in the
same colours. A cross marks the highest nominal jump whose yield, less two of its errors, is 99 %, or else the
best yield; a triangle the highest nominal jump of all. Needs yield; draws jump_height and jump_height_q05 if
the map has them."""
import numpy as np
from matplotlib.colors import Normalize, PowerNorm

import cliffs
import looks
import planes
import style
from read_map import NotAMap
from style import plt

YIELDS = (0.5, 0.9, 0.99)
HEIGHTS = ("jump_height", "jump_height_q05")


def draw(axis, grid, plane, panel_curves, colours, norm, levels, form, curves):
    """A quantity over the plane, smooth but across panel_curves; its isolines; and the curves."""
    crisp = cliffs.Panel(grid, grid.panels[0], panel_curves)
    field = crisp.field(plane)
    axis.set_facecolor(looks.STATUSES["no_jump"][0])
    drawn = axis.pcolormesh(crisp.edges(grid.x), crisp.edges(grid.y), field, cmap=colours, norm=norm,
                            shading="flat", rasterized=True)
    torn = np.where(crisp.torn, np.nan, field)
    present = [v for v in levels if np.isfinite(torn).any() and np.nanmin(torn) < v < np.nanmax(torn)]
    if present:
        lines = axis.contour(crisp.centres(grid.x), crisp.centres(grid.y), np.ma.masked_invalid(torn),
                             levels=present, colors="white",
                             linewidths=[2.0 if v == YIELDS[-1] else 1.0 for v in present])
        axis.clabel(lines, fmt=form, fontsize=7)
    return drawn, cliffs.Panel(grid, grid.panels[0], curves).draw(axis)


def best(grid, plane):
    """Where a plane is highest, in the middle of all such places."""
    rows, columns = np.nonzero(plane >= np.nanmax(plane))
    middle = np.argmin((rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2)
    return grid.values(grid.x)[columns[middle]], grid.values(grid.y)[rows[middle]]


def at(grid, place):
    def told(name, value):
        _, symbol, unit = looks.parameter(name)
        return f"{symbol} {value:.3g}{'' if unit == '°' else ' '}{unit}".rstrip()
    return "at " + ", ".join(told(name, value) for name, value in zip((grid.x, grid.y), place))


def height(value):
    """A height with its unit as drawn."""
    return f"{value:.3g} {looks.LOOKS['jump_height'].unit}".replace("hoop diameters", "diameters")


def marks_of(grid, yields, heights):
    """The designs to point out: (symbol, colour, words, place). heights: nominal; None: not stored."""
    m = grid.map
    # Two errors on the safe side.
    surely = yields - (2 * grid.cut(m.fields["yield_error"])[0] if "yield_error" in m.fields else 0)
    if heights is None or not (surely >= YIELDS[-1]).any():
        place = best(grid, yields)
        words = f"best yield, {100 * np.nanmax(yields):.1f} % {at(grid, place)}"
    else:
        safe = np.where(surely >= YIELDS[-1], heights, np.nan)
        place = best(grid, safe)
        words = (f"highest nominal jump with a yield of 99 %: {height(np.nanmax(safe))} "
                 f"{at(grid, place)}")
    marks = [("P", "#d62728", words, place)]
    if heights is not None:
        place = best(grid, heights)
        share = yields[np.unravel_index(np.nanargmax(heights), heights.shape)]
        words = (f"highest nominal jump: {height(np.nanmax(heights))} {at(grid, place)}, yield "
                 f"{100 * share:.0f} %")
        marks.append(("^", "#ff7f0e", words, place))
    return marks


def chart(grid, curves):
    m = grid.map
    if "yield" not in m.fields:
        raise NotAMap(f"{m.path}: has no yield; allowed: a map of a sweep with [scatter] and [goal]")
    if len(grid.panels) > 1:
        raise NotAMap(
            f"{m.path}: has more than two axes; fix the others, for example by --at {grid.others[0]}="
            f"{looks.shown(grid.others[0], m.dims[grid.others[0]][0])}")
    shown = [name for name in HEIGHTS if name in m.fields]
    figure, axes = plt.subplots(1, 1 + len(shown), squeeze=False, sharex=True, sharey=True,
                                layout="constrained", figsize=(4.0 * (1 + len(shown)) + 0.6, 4.9))
    axes = axes[0]
    for scale, name in (("x", grid.x), ("y", grid.y)):
        if looks.is_log(grid.values(name)):
            style.log_scale(getattr(axes[0], f"{scale}axis"))
    yields = grid.cut(m.fields["yield"])[0]
    drawn, kinds = draw(axes[0], grid, yields, [], "cividis", Normalize(0, 1), YIELDS,
                        lambda v: f"{100 * v:g} %", curves)
    axes[0].set_title("yield: " + ",\n".join(looks.goal_words(m)))
    figure.colorbar(drawn, ax=axes[0], pad=0.02, ticks=[0, 0.25, *YIELDS[:2], 1])
    look = looks.LOOKS["jump_height"]
    planes_of = {name: grid.cut(np.asarray(m.fields[name], float))[0] for name in shown}
    if shown:
        norm = PowerNorm(look.exponent, 0.0, np.nanmax(list(planes_of.values())))
        for axis, name in zip(axes[1:], shown):
            own = curves if name == "jump_height" else []
            drawn, _ = draw(axis, grid, planes_of[name], own, look.colours, norm,
                            looks.levels_of(look, planes_of[name]), lambda v: f"{v:g}", curves)
            axis.set_title("nominal jump height" if name == "jump_height" else
                           "5 % quantile of the jump height\nof manufactured hoops that jump")
        figure.colorbar(drawn, ax=list(axes[1:]), label=look.title)
    marks = marks_of(grid, yields, planes_of.get("jump_height"))
    handles = []
    for symbol, colour, words, place in marks:
        for axis in axes:
            axis.plot(*place, symbol, color=colour, markersize=9, markeredgecolor="white", zorder=6)
        handles.append(plt.Line2D([], [], marker=symbol, color="none", markerfacecolor=colour,
                                  markeredgecolor="white", markersize=9, label=words))
    if place := grid.paper(grid.panels[0]):
        for axis in axes:
            style.draw_star(axis, place)
        handles.append(style.star_handle())
    words = [looks.made_words(m)[0], *grid.caption()]
    figure.supxlabel(f"{planes.axis_label(grid.x)}\n{style.wrapped(words, figure)}", fontsize=9)
    figure.supylabel(planes.axis_label(grid.y), fontsize=9)
    style.legend_above(figure, handles + cliffs.handles(kinds))
    for _, _, words, _ in marks:
        print(words)
    return figure


if __name__ == "__main__":
    style.run(lambda: cliffs.run(__doc__, "maps/made_hoops.h5", "_yield", chart, units=True), NotAMap,
              OSError)
