#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the design charts of a map: jump height, time and agility over two axes, one panel for each value of
the others.

Isolines are labelled. Hatched: first lift-off below the threshold. Lines: discontinuities, if leapmap
boundaries has found them; without them, one cell for each design. Other colours: no jump, by the reason. A
star marks the paper's hoop. Agility is the jump's height over the time from release to its apex; the colour
bar marks published jumpers. Agility needs jump_height, jump_time and apex_time. spurious_first_jump,
jump_angle and status are drawn if the map has them, and what leapmap prove has proved of its cells."""
import sys

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, Normalize, PowerNorm

import cliffs
import looks
import planes
import style
from read_map import NotAMap, read_map
from style import plt


def without_cliffs(plane, course):
    """The plane with gaps where the jump takes another course."""
    gaps = np.zeros(plane.shape, dtype=bool)
    for axis in (0, 1):
        jumps = looks.cliffs(course, axis)
        before, after = [slice(None)] * 2, [slice(None)] * 2
        before[axis], after[axis] = slice(None, -1), slice(1, None)
        gaps[tuple(before)] |= jumps
        gaps[tuple(after)] |= jumps
    return np.where(gaps, np.nan, plane)


def scale_of(look, levels, values):
    """The colours, their scale, and the levels of the isolines."""
    if look.log:
        low = np.nanpercentile(values[values > 0], 1) if (values > 0).any() else levels[0]
        levels = levels[levels >= low] if (levels >= low).sum() > 2 else levels
        most = np.nanmax(values)
        norm = LogNorm(levels[0], max(most, 1.01 * levels[0]))
        levels = levels[levels <= most] if (levels <= most).sum() > 2 else levels
    elif look.exponent == 1.0:
        norm = Normalize(levels[0], levels[-1])
    else:  # a power has no colour below its least value
        norm = PowerNorm(look.exponent, min(levels[0], np.nanmin(values)), levels[-1])
    # A quarter at the dark end is left out: hatching must show on every colour.
    ends = (0.0, 0.75) if look.colours.endswith("_r") else (0.25, 1.0)
    return ListedColormap(plt.get_cmap(look.colours)(np.linspace(*ends, 256))), norm, levels


def draw_panel(axis, crisp, plane, flags, course, told, scale, ink):
    """One panel: what happened where there is no jump, the field, its isolines, and hatching where
    spurious."""
    colours, norm, levels = scale
    grid = crisp.grid
    codes = list(looks.STATUSES)
    background = np.full(plane.shape, np.nan)
    for i, code in enumerate(codes):
        background[told[code]] = i
    if crisp.crisp:
        x, y, cells = (crisp.centres(grid.x), crisp.centres(grid.y), (crisp.edges(grid.x), crisp.edges(
            grid.y)))
        torn = np.where(crisp.torn, np.nan, crisp.field(plane))
        plane, background, flags = crisp.field(plane), crisp.code(background), crisp.code(flags)
    else:
        x, y, cells = grid.values(grid.x), grid.values(grid.y), (grid.edges(grid.x), grid.edges(grid.y))
        torn = without_cliffs(plane, course)
    axis.pcolormesh(*cells, background, shading="flat", norm=BoundaryNorm(
        np.arange(len(codes) + 1) - 0.5, len(codes)),
                    cmap=ListedColormap([looks.STATUSES[c][0] for c in codes]), rasterized=True)
    # Cells or pixels, no filled contours: those would reach across cliffs, and miss a lone design.
    axis.pcolormesh(*cells, np.maximum(plane, norm.vmin), shading="flat", cmap=colours, norm=norm,
                    rasterized=True)
    if not np.isfinite(plane).any():
        return
    present = [v for v in levels if np.isfinite(torn).any() and np.nanmin(torn) < v < np.nanmax(torn)]
    if present:
        lines = axis.contour(x, y, np.ma.masked_invalid(torn), levels=present, colors=ink, linewidths=0.8)
        style.halo(axis.clabel(lines, fmt=lambda v: f"{v:g}", fontsize=7),
                   "white" if ink == "black" else "#303030")
    hatched = np.ma.masked_where(~np.isfinite(plane), (flags == 1) * 1.0)
    if hatched.max() > 0:
        corners = (x, y)
        if not crisp.crisp:  # every cell by its four corners, so that the hatching ends where cells do
            corners = [np.repeat(edges, 2)[1:-1] for edges in cells]
            hatched = hatched.repeat(2, axis=0).repeat(2, axis=1)
        axis.contourf(*corners, hatched, levels=[0.5, 1.5], colors="none", hatches=["///"])
        if hatched.min() == 0 and not crisp.crisp:
            axis.contour(*corners, hatched, levels=[0.5], colors=style.EDGE, linewidths=0.7)


def chart(grid, name, panels_of, drawing=None):
    """One figure of one quantity. panels_of: cliffs.Panel of each panel. drawing: looks.in_drawing."""
    m, look = grid.map, looks.LOOKS[name]
    values = looks.quantity(m, name)
    panels = grid.cut(values)
    if not any(np.isfinite(p).any() for p in panels):
        raise NotAMap(f"{m.path}: no design in it jumps, so there is no {name} to draw")
    scale = scale_of(look, looks.levels_of(look, values), values)
    # What a map was not asked to store is not drawn: hatching, gaps of isolines at cliffs, reasons why there
    # is no jump.
    flags, courses = (grid.cut(array) if array is not None else [np.zeros(p.shape) for p in panels]
                      for array in (m.fields.get("spurious_first_jump"), looks.course(m)))
    told = grid.told()
    figure, axes = grid.figure()
    starred, kinds = False, set()
    for i, axis in enumerate(axes):
        draw_panel(axis, panels_of[i], panels[i], flags[i], courses[i], {c: t[i] for c, t in told.items()},
                   scale, look.ink)
        kinds |= panels_of[i].draw(axis)
        if place := grid.paper(grid.panels[i]):
            starred = True
            style.draw_star(axis, place, look.star)
    colours, norm, levels = scale
    # A bar of its own scale, whatever the panels hold.
    bar = figure.colorbar(ScalarMappable(norm,
                                         colours), ax=axes, extend="max" if look.exponent != 1.0 else "both",
                          label=look.title, ticks=levels, shrink=0.9, pad=0.015)
    bar.ax.set_yticks(levels, [f"{v:g}" for v in levels])
    bar.ax.minorticks_off()
    if drawing:
        unit, factor = drawing
        bar.set_label(f"{look.label} [{look.unit}] (in {unit})")
        bar.ax.set_yticks(levels, [f"{v:g} ({v * factor:.4g})" for v in levels])
    if look.log or look.exponent != 1.0:
        bar.ax.set_title(looks.scale_words(look), fontsize=7)
    if name == "agility":
        beyond = [f"{jumper} {agility:g}" for jumper, agility in looks.JUMPERS.items() if agility > norm.vmax]
        if beyond:  # the scale is of the map; what is beyond it is told
            bar.ax.annotate("beyond:\n" + "\n".join(beyond), (0.5, 0.0), xycoords="axes fraction",
                            xytext=(0, -18), textcoords="offset points", ha="center", va="top", fontsize=7,
                            color=style.MARK, annotation_clip=False)
        for jumper, agility in looks.JUMPERS.items():
            if agility > norm.vmax:
                continue
            bar.ax.axhline(agility, color=style.MARK, linewidth=1.5)
            bar.ax.annotate(f"{jumper} {agility:g}", (0.0, agility), xycoords=("axes fraction", "data"),
                            xytext=(-3, 0), textcoords="offset points", ha="right", va="center", fontsize=7,
                            color=style.MARK, annotation_clip=False)
    handles = []
    if any((f == 1).any() for f in flags):
        handles.append(
            style.swatch("white", "first lift-off below the threshold", edgecolor=style.EDGE, hatch="///"))
    for code, (colour, words) in looks.STATUSES.items():
        if any(t.any() for t in told[code]):
            handles.append(style.swatch(colour, words))
    handles += cliffs.handles(kinds)
    if starred:
        handles.append(style.star_handle(look.star))
    if name == "agility":
        drawn = any(agility <= norm.vmax for agility in looks.JUMPERS.values())
        handles.append(
            plt.Line2D([], [], color=style.MARK, linestyle="-" if drawn else "none",
                       label=f"published jumpers ({looks.JUMPERS_SOURCE})"))
    style.legend_above(figure, handles)
    return figure


def main():
    p = style.parser(__doc__, "a map over two axes or more, for example maps/slope_mass_ratio_offset.h5", "")
    planes.add_options(p)
    cliffs.add_options(p)
    planes.add_units(p)
    arguments = p.parse_args()
    m = planes.in_units(read_map(arguments.source), arguments.units)
    drawn = [name for name in (*planes.FIELDS, "gait_height") if looks.quantity(m, name) is not None]
    if not drawn:
        raise NotAMap(f"{m.path}: has no jump_height or jump_time; a design chart wants one of them")
    grid = planes.Planes(m, arguments.x, arguments.y, arguments.at)
    if not m.whole:
        print(
            f"{m.path}: INCOMPLETE, {m.computed().mean():.0%} of its designs are computed; the others are "
            "left white",
            file=sys.stderr)
    curves = cliffs.read_cliffs(m, arguments.cliffs)
    panels_of = [cliffs.Panel(grid, panel, curves) for panel in grid.panels]
    try:  # without the module a chart shows the map's own units alone
        units_in_own = style.leapmap_module()._core.units_in_own
    except OSError:
        units_in_own = None
    for name in drawn:
        beside = units_in_own and not arguments.units
        drawing = looks.in_drawing(m, name, units_in_own) if beside else None
        style.save(chart(grid, name, panels_of, drawing), f"{style.stem(arguments.output)}_{name}")
    if "proof" in m.fields:
        from proof_chart import chart as proved  # which draws with what is above
        style.save(proved(grid, curves), f"{style.stem(arguments.output)}_proof")


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
