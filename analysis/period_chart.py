#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the period of the gait that follows each release, over two axes, one panel for each value of the
others.

If there are only a few gaits, as for one hoop over its release, each has a colour: the basins of attraction.
Needs a map of a sweep with [gait]: gait_period, and for basins gait_height."""
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap

import cliffs
import style
from read_map import NotAMap

NONE_FOUND = 255
KINDS = [("#d9d9d9", "the jumps end"), ("#2166ac", "period 1"), ("#67a9cf", "period 2"),
         ("#1b7837", "period 3"), ("#7fbf7b", "period 4"), ("#dfc27d", "period 5"),
         ("#f46d43", "longer period"), ("#40004b", "no period found")]
LONGER, LAST = 6, len(KINDS) - 1
MOST_GAITS = 8  # that are told apart by their colours
COLOURS = ("#2166ac", "#f46d43", "#1b7837", "#dfc27d", "#67a9cf", "#b2182b", "#7fbf7b", "#8073ac")


def kinds_of(m):
    """(colour, words) of each kind, and the kind of each design."""
    period = np.asarray(m.fields["gait_period"], int)
    found = (period > 0) & (period != NONE_FOUND)
    gaits = []
    if "gait_height" in m.fields:
        height = np.round(np.asarray(m.fields["gait_height"], float), 6)
        gaits = sorted(set(zip(period[found].tolist(), height[found].tolist())), key=lambda gait: gait[1])
    if not 1 < len(gaits) <= MOST_GAITS:
        return KINDS, np.where(period == NONE_FOUND, LAST, np.minimum(period, LONGER))
    kind = np.where(period == NONE_FOUND, len(gaits) + 1, 0)
    for i, (length, mean) in enumerate(gaits):
        kind[(period == length) & (height == mean)] = i + 1
    told = [(colour, f"{mean:.3f} diameters" + (f", period {length}" if length > 1 else ""))
            for colour, (length, mean) in zip(COLOURS, gaits)]
    return [KINDS[0], *told, KINDS[LAST]], kind


def chart(grid, curves):
    m = grid.map
    if "gait_period" not in m.fields:
        raise NotAMap(f"{m.path}: has no gait_period; allowed: a map of a sweep with [gait]")
    kinds, kind = kinds_of(m)
    panels = grid.cut(kind)
    figure, axes = grid.figure()
    drawn = set()
    for axis, panel, plane in zip(axes, grid.panels, panels):
        crisp = cliffs.Panel(grid, panel, curves)
        axis.pcolormesh(crisp.edges(grid.x), crisp.edges(
            grid.y), crisp.code(plane), shading="flat", rasterized=True, norm=BoundaryNorm(
                np.arange(len(kinds) + 1) - 0.5, len(kinds)), cmap=ListedColormap([c for c, _ in kinds]))
        drawn |= crisp.draw(axis)
    shares = np.bincount(np.concatenate([p.ravel()
                                         for p in panels]), minlength=len(kinds)) / sum(p.size
                                                                                        for p in panels)
    handles = [
        style.swatch(colour, f"{words}: {100 * share:.3g} %")
        for (colour, words), share in zip(kinds, shares)
        if share > 0
    ]
    style.legend_above(figure, handles + cliffs.handles(drawn))
    return figure


if __name__ == "__main__":
    style.run(lambda: cliffs.run(__doc__, "maps/gaits.h5", "_period", chart), NotAMap, OSError)
