#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the paper's hoop with Coulomb friction over release angle and friction, and the region that agrees
with the measurements.

Left: the jump's height, with lines at the measured apex time (0.129 s), flight time (0.198 s) and height (one
diameter). Right: the number of small hops before the jump. Hatched: apex and flight within 2 % and height
within 10 % of the measurements."""
import numpy as np

import looks
import style
from read_map import NotAMap, read_map
from style import plt

APEX, FLIGHT, HEIGHT = 0.129, 0.198, 1.0  # paper.md, section on the experiment


def chart(m):
    axes_of = list(m.dims)
    if sorted(axes_of) != ["mu_static", "release_angle"]:
        raise NotAMap(f"{m.path}: has the axes {', '.join(axes_of)}; wanted: release_angle and mu_static")
    fields = {k: v if axes_of[0] == "mu_static" else v.T for k, v in m.fields.items()}
    angle, mu = np.degrees(m.dims["release_angle"]), m.dims["mu_static"]
    figure, (left, right) = plt.subplots(1, 2, sharey=True, figsize=(13.0, 5.2), layout="constrained")
    height = fields["jump_height"]
    filled = left.contourf(angle, mu, height, levels=np.arange(0.0, 1.25, 0.1), cmap="viridis")
    figure.colorbar(filled, ax=left, label="jump height [hoop diameters]")
    fits = (np.abs(fields["apex_time"] / APEX - 1) < 0.02) & (np.abs(fields["flight_time"] / FLIGHT - 1) <
                                                              0.02) & (np.abs(height - HEIGHT) < 0.1)
    if fits.any():
        left.contourf(angle, mu, fits, levels=[0.5, 1.5], colors="none", hatches=["xxx"])
    handles = []
    for name, level, colour, words in (("apex_time", APEX, "white", "apex after 0.129 s"),
                                       ("flight_time", FLIGHT, style.MARK, "flight of 0.198 s"),
                                       ("jump_height", HEIGHT, "black", "height of one diameter")):
        least, most = np.nanmin(fields[name]), np.nanmax(fields[name])
        there = least <= level <= most
        bound = "" if there else (f": nowhere, {'at most' if most < level else 'at least'} "
                                  f"{most if most < level else least:.3g}")
        handles.append(
            plt.Line2D([], [], color="#9aa4ae" if colour == "white" else colour,
                       linestyle="-" if there else ":", label=words + bound))
        if not there:
            continue
        lines = left.contour(angle, mu, fields[name], levels=[level], colors=[colour], linewidths=1.4)
        left.clabel(
            lines, fmt={
                level: {
                    "apex_time": "apex 0.129 s", "flight_time": "flight 0.198 s", "jump_height": "1 diameter"
                }[name]
            }, fontsize=7)
    left.plot(190, 0.4, "*", markersize=11, color=style.MARK, markeredgecolor="white")
    left.set_title(
        f"hatched: apex and flight within 2 %, height within 10 % ({100 * fits.mean():.0f} % of these "
        "designs); star: 190°, μ 0.4",
        fontsize=8)
    hops = np.where(height > 0, fields["candidates"].astype(float) - 1, np.nan)
    drawn = right.pcolormesh(angle, mu, np.minimum(hops, 3), cmap=plt.get_cmap("Blues", 4), vmin=-0.5,
                             vmax=3.5, shading="nearest", rasterized=True)
    bar = figure.colorbar(drawn, ax=right, ticks=[0, 1, 2, 3], label="small hops before the jump")
    bar.ax.set_yticklabels(["none", "1", "2", "3 or more"])
    for axis in (left, right):
        axis.set_facecolor(looks.STATUSES["no_jump"][0])
    right.set_title("it hops below 0.05 diameters before the jump; grey: no jump", fontsize=8)
    style.legend_above(figure, handles)
    for axis in (left, right):
        axis.set_xlabel("release angle [°]")
    left.set_ylabel("friction μ")
    return figure


def main():
    p = style.parser(__doc__, "a map over release_angle and mu_static, for example maps/experiment.h5", "")
    arguments = p.parse_args()
    style.save(chart(read_map(arguments.source)), arguments.output)


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
