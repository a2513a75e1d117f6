#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the differences between two maps of the same hoops: one without slip, one with Coulomb friction.

One panel for each friction coefficient, over slope and mass ratio. Dark green: heights agree within 5 %,
possibly by chance. Yellow: both models jump, but heights differ. Orange: only one of them jumps. Purple:
Painlevé's paradox. Hatched: only one of them has a sub-threshold first lift-off. A star marks the paper's
hoop."""
import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

import cliffs
import looks
import planes
import style
from read_map import NotAMap, read_map
from style import plt

ENOUGH = 0.05  # of the height
KINDS = [(looks.STATUSES["no_jump"][0], "neither jumps"), ("#1b7837", "height within 5 %"),
         ("#ffdd57", "both jump, heights differ by more"), ("#e66101", "only one of them jumps"),
         ("#8c6bb1", "indeterminate or failed")]
KEEP = ("slope", "mass_ratio")  # to the right, and up


def kinds(sticking, coulomb, jumps_sticking, jumps_coulomb, unknown):
    """A number of KINDS for each design."""
    kind = np.zeros(sticking.shape, int)
    both = jumps_sticking & jumps_coulomb
    with np.errstate(invalid="ignore"):
        close = np.abs(sticking - coulomb) <= ENOUGH * coulomb
    kind[both & close] = 1
    kind[both & ~close] = 2
    kind[jumps_sticking != jumps_coulomb] = 3
    kind[unknown] = 4
    return kind


def plane_of(m, values):
    """An array along m's axes with KEEP's two last."""
    names = list(m.dims)
    return np.moveaxis(values, [names.index(k) for k in KEEP], [-2, -1])


def chart(rigid, slipping, of_rigid, of_slipping):
    """of_...: the cliffs of the two maps, or None."""
    for k in KEEP:
        if k not in rigid.dims or k not in slipping.dims or not np.array_equal(
                rigid.dims[k], slipping.dims[k]):
            raise NotAMap(f"{rigid.path} and {slipping.path}: are not over the same {k}")
    if len(rigid.dims) != 2 or rigid.slips:
        raise NotAMap(
            f"{rigid.path}: is not a map of hoops that never slip over slope and mass_ratio; it comes first")
    others = [n for n in slipping.dims if n not in KEEP]
    if others not in (["mu_static"], []):
        raise NotAMap(
            f"{slipping.path}: has the axes {', '.join(slipping.dims)}; wanted: slope, mass_ratio and "
            "mu_static"
        )
    mus = slipping.dims.get("mu_static", [slipping.numbers().get("mu_static")])
    height, jumps, flag = (plane_of(rigid, v)
                           for v in (rigid.fields["jump_height"], rigid.code("status", "jumped"),
                                     rigid.fields["spurious_first_jump"]))
    panels = len(mus)
    shape = (2, 2) if panels == 4 else (1, panels)
    figure, axes = plt.subplots(*shape, sharex=True, sharey=True, squeeze=False,
                                figsize=(5.4 * shape[1], 4.2 * shape[0] + 0.8), layout="constrained")
    degrees, ratios = np.degrees(rigid.dims["slope"]), rigid.dims["mass_ratio"]
    across, up = KEEP
    grids = [planes.Planes(m, across, up) for m in (rigid, slipping)]
    left = cliffs.Panel(grids[0], grids[0].panels[0], of_rigid if of_slipping is not None else None)
    drawn = set()
    unknown = plane_of(slipping, slipping.code("status", "indeterminate") | slipping.code("status", "failed"))
    heights, jump, flags = (plane_of(slipping, v)
                            for v in (slipping.fields["jump_height"], slipping.code("status", "jumped"),
                                      slipping.fields["spurious_first_jump"]))
    for i, (axis, mu) in enumerate(zip(axes.flat, mus)):
        here = (i,) if "mu_static" in slipping.dims else ()
        right = cliffs.Panel(grids[1], grids[1].panels[i], of_slipping if of_rigid is not None else None)
        # Rows along the mass ratio, pixel by pixel where there are cliffs.
        kind = kinds(left.field(height.T), right.field(heights[here].T), left.code(jumps.T),
                     right.code(jump[here].T), right.code(unknown[here].T))
        axis.pcolormesh(right.edges(across), right.edges(up), kind, cmap=ListedColormap(
            [c for c, _ in KINDS]), vmin=-0.5, vmax=len(KINDS) - 0.5, shading="flat", rasterized=True)
        differs = (flag != flags[here]) & jumps & jump[here]
        if differs.any():
            differs = left.code(jumps.T) & right.code(
                jump[here].T) & (left.code(flag.T) != right.code(flags[here].T))
            axis.contourf(right.centres(across), right.centres(up), differs, levels=[0.5, 1.5], colors="none",
                          hatches=["////"])
        drawn |= left.draw(axis) | right.draw(axis)
        axis.plot(np.degrees(looks.PAPER["slope"]), looks.PAPER["mass_ratio"], "*", markersize=10,
                  color=style.MARK, markeredgecolor="white")
        both = jumps & jump[here]
        close = kinds(height, heights[here], jumps, jump[here], unknown[here]) == 1
        share = 100 * close.sum() / max(both.sum(), 1)
        axis.set_title(f"μ = {mu:g}: height agrees for {share:.0f} % of what jumps in both")
        style.log_scale(axis.yaxis)
    for axis in axes[-1]:
        axis.set_xlabel("slope [degrees]")
    for axis in axes[:, 0]:
        axis.set_ylabel("mass ratio mₚ/m")
    handles = [Patch(color=c, label=text) for c, text in KINDS]
    handles += cliffs.handles(drawn)
    handles += [
        Patch(facecolor="none", edgecolor=style.EDGE, hatch="////",
              label="only one sees a sub-threshold first lift-off"),
        plt.Line2D([], [], marker="*", linestyle="", markersize=10, color=style.MARK,
                   label="the paper's hoop")
    ]
    axes[0, -1].legend(handles=handles, loc="upper left", bbox_to_anchor=(1.02, 1.0), frameon=False)
    return figure


def main():
    p = style.parser(__doc__, "the map without slip, for example maps/adequacy_sticking.h5", "_adequacy")
    p.add_argument("coulomb", help="the map with Coulomb friction, for example maps/adequacy_coulomb.h5")
    arguments = p.parse_args()
    maps = [read_map(path) for path in (arguments.source, arguments.coulomb)]
    style.save(chart(*maps, *(cliffs.read_cliffs(m, None) for m in maps)), arguments.output)


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
