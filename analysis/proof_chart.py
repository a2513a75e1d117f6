#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw what is proved of the cells of a map that leapmap prove has made, one panel for each value of the
axes beyond two.

Colours: the least height that every design of a proved cell jumps; grey: proved that none of its designs
jumps. Black: a discontinuity crosses the cell, as two of its designs have different outcomes. Red: open."""
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap

import cliffs
import looks
import style
from design_chart import scale_of
from read_map import NotAMap

NONE, CROSSED, OPEN = "#d9d9d9", "#202020", "#e31a1c"


def chart(grid, curves):
    m = grid.map
    if "proof" not in m.fields or "jump_height_low" not in m.fields:
        raise NotAMap(f"{m.path}: holds no proofs; leapmap prove SPEC -o FILE makes a map that does")
    proved, crossed, opened = (m.code("proof", word) for word in ("proved", "crossed", "open"))
    if not (proved & np.isfinite(m.fields["jump_height_low"])).any():
        raise NotAMap(f"{m.path}: no cell is proved to jump, so there is no height to draw")
    low = np.where(proved, m.fields["jump_height_low"], np.nan)
    look = looks.LOOKS["jump_height"]
    colours, norm, levels = scale_of(look, looks.levels_of(look, low), low)
    kinds = [(proved & np.isnan(low), NONE, "proved: none jumps"),
             (crossed, CROSSED, "crossed by a discontinuity"), (opened, OPEN, "open")]
    figure, axes = grid.figure()
    starred = False
    for k, (axis, panel) in enumerate(zip(axes, grid.panels)):
        edges = grid.edges(grid.x), grid.edges(grid.y)
        axis.pcolormesh(*edges, np.maximum(grid.cut(low)[k], norm.vmin), shading="flat", cmap=colours,
                        norm=norm, rasterized=True)
        for where, colour, _ in kinds:
            plane = np.where(grid.cut(where)[k], 1.0, np.nan)
            axis.pcolormesh(*edges, plane, shading="flat", cmap=ListedColormap([colour]), vmin=0, vmax=2,
                            rasterized=True)
        if place := grid.paper(panel):
            starred = True
            style.draw_star(axis, place, look.star)
    bar = figure.colorbar(ScalarMappable(norm, colours), ax=axes, ticks=levels, shrink=0.9, pad=0.015,
                          label="least height of all designs of a cell [hoop diameters]")
    bar.ax.set_yticks(levels, [f"{v:g}" for v in levels])
    share = lambda where: f"{100 * where.mean():.3g} %"
    jumps = share(proved & ~np.isnan(low))
    handles = [style.swatch(colours(0.7), f"proved: jumps at least so high: {jumps}")]
    handles += [style.swatch(colour, f"{words}: {share(where)}")
                for where, colour, words in kinds if where.any()]
    if starred:
        handles.append(style.star_handle(look.star))
    style.legend_above(figure, handles)
    return figure


if __name__ == "__main__":
    style.run(lambda: cliffs.run(__doc__, "maps/proof.h5", "_proof", chart), NotAMap, OSError)
