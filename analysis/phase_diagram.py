#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the number of the lift-off that jumps, over two axes, one panel for each value of the others.

Grey: no jump. Lines: discontinuities, if leapmap boundaries has found them; the legend names them. A star
marks the paper's hoop. Needs status and candidates."""
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap

import cliffs
import looks
import style
from read_map import NotAMap

MOST = 6  # lift-offs told apart
COLOURS = ["#e8e8e8", "#fde725", "#5ec962", "#21918c", "#3b528b", "#440154", "#8c6bb1"]


def ordinal(k):
    return f"{k}{ {1: 'st', 2: 'nd', 3: 'rd'}.get(k, 'th')}"


def region_of(m):
    """0: no jump; k: the jump is lift-off k, MOST: that or a later one."""
    return np.where(m.code("status", "jumped"), np.clip(m.fields["candidates"], 1, MOST), 0)


def middle_of(mask):
    """The pixel of a region that is farthest from its edge, roughly: what is left last as it is worn away."""
    inner = np.pad(mask, 1)
    while True:
        worn = inner.copy()
        for axis in (0, 1):
            for way in (1, -1):
                worn &= np.roll(inner, way, axis)
        if not worn.any():
            rows, columns = np.nonzero(inner[1:-1, 1:-1])
            return rows[len(rows) // 2], columns[len(columns) // 2]
        inner = worn


def chart(grid, curves):
    m = grid.map
    for name in ("status", "candidates"):
        if name not in m.fields:
            raise NotAMap(f"{m.path}: has no {name}; a phase diagram wants it")
    figure, axes = grid.figure()
    kinds, present = set(), set()
    for axis, panel, plane in zip(axes, grid.panels, grid.cut(region_of(m))):
        crisp = cliffs.Panel(grid, panel, curves)
        pixels = crisp.code(plane)
        axis.pcolormesh(crisp.edges(grid.x), crisp.edges(grid.y), pixels, shading="flat", rasterized=True,
                        norm=BoundaryNorm(np.arange(MOST + 2) - 0.5, MOST + 1), cmap=ListedColormap(COLOURS))
        kinds |= crisp.draw(axis)
        present |= set(np.unique(pixels).tolist())
        for k in range(1, MOST):
            if (pixels == k).mean() < 0.01:
                continue
            row, column = middle_of(pixels == k)
            axis.text(
                crisp.centres(grid.x)[column],
                crisp.centres(grid.y)[row], ordinal(k), ha="center", va="center", fontsize=10,
                color="white" if k > 2 else style.EDGE)
        if place := grid.paper(panel):
            style.draw_star(axis, place)
    handles = [style.swatch(COLOURS[0], "no jump")] if 0 in present else []
    for k in range(1, MOST + 1):
        if k in present:
            handles.append(
                style.swatch(COLOURS[k],
                             f"jumps on the {ordinal(k)} lift-off{' or a later one' if k == MOST else ''}"))
    handles += cliffs.handles(kinds)
    if any(grid.paper(p) for p in grid.panels):
        handles.append(style.star_handle())
    style.legend_above(figure, handles)
    return figure


if __name__ == "__main__":
    style.run(lambda: cliffs.run(__doc__, "maps/slope_mass_ratio.h5", "_phases", chart), NotAMap, OSError)
