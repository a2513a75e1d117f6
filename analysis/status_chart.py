#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw how designs end, over two axes, one panel for each value of the others.

Colours: a jump at the first lift-off, a jump after a spurious one, or the reason why there is no jump. A star
marks the paper's hoop. Needs status."""
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap

import cliffs
import looks
import style
from read_map import NotAMap

JUMPS = [("#1b7837", "jumps at its first lift-off"),
         ("#fdae61", "jumps after a sub-threshold first lift-off"), ("#5aae61", "jumps (lift-off unknown)")]
NONE_SPURIOUS = ("#dfc27d", "no jump: all lift-offs below the jump threshold")


def chart(grid, curves):
    m = grid.map
    if "status" not in m.fields:
        raise NotAMap(f"{m.path}: has no status; a status chart wants it")
    statuses = {**looks.STATUSES, "no_jump": (looks.STATUSES["no_jump"][0], "no lift-off at all")}
    kinds = [*JUMPS, NONE_SPURIOUS, *statuses.values()]
    known = "spurious_first_jump" in m.fields
    flag = m.fields["spurious_first_jump"] if known else np.full(m.fields["status"].shape, 255)
    jumped = m.code("status", "jumped")
    kind = np.zeros(jumped.shape, int)
    for i, code in enumerate(looks.STATUSES):
        kind[m.code("status", code)] = len(JUMPS) + 1 + i
    kind[m.code("status", "no_jump") & (flag == 1)] = len(JUMPS)
    kind[jumped] = np.where(flag[jumped] == 0, 0, 1) if known else 2
    panels = grid.cut(kind)

    figure, axes = grid.figure()
    drawn = set()
    for axis, panel, plane in zip(axes, grid.panels, panels):
        crisp = cliffs.Panel(grid, panel, curves)
        axis.pcolormesh(crisp.edges(grid.x), crisp.edges(
            grid.y), crisp.code(plane), shading="flat", rasterized=True, norm=BoundaryNorm(
                np.arange(len(kinds) + 1) - 0.5, len(kinds)), cmap=ListedColormap([c for c, _ in kinds]))
        drawn |= crisp.draw(axis)
        if place := grid.paper(panel):
            style.draw_star(axis, place)
    shares = np.bincount(np.concatenate([p.ravel()
                                         for p in panels]), minlength=len(kinds)) / sum(p.size
                                                                                        for p in panels)
    handles = [style.swatch(colour, f"{words}: {100 * share:.3g} %")
               for (colour, words), share in zip(kinds, shares) if share > 0] + cliffs.handles(drawn)
    if any(grid.paper(p) for p in grid.panels):
        handles.append(style.star_handle())
    style.legend_above(figure, handles)
    return figure


if __name__ == "__main__":
    style.run(lambda: cliffs.run(__doc__, "maps/slope_mass_ratio_offset.h5", "_status", chart), NotAMap,
              OSError)
