#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the design chart of a map: jump height, or jump time, over slope and mass ratio, one panel for each L/R.

Filled contours with labelled isolines; hatched where the first lift-off is spurious; grey where there is no jump;
a star at the paper's hoop.
"""
import math

import numpy as np
from matplotlib.colors import ListedColormap, PowerNorm

import style
from read_map import NotAMap, read_map, sliced
from style import plt

PAPER = {"slope": 0.40, "mass_ratio": 20 / 8.2, "offset_ratio": 1.0, "inertia_factor": 1.0,
         "release_angle": math.pi, "release_spin": 0.0}
# field -> colour bar's label, colour map, exponent of its scale, isolines' colour, levels for the isolines (None: chosen from the data)
FIELDS = {
    "jump_height": ("jump height [hoop diameters]", "viridis", 0.6, "white", [0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0]),
    "jump_time": ("time from release to the jump [s]", "cividis_r", 1.0, "black", None),
}
SYMBOLS = {"offset_ratio": "L/R", "inertia_factor": "I/(m R²)", "release_angle": "release angle", "release_spin": "release spin"}


def time_levels(values):
    """Isolines a designer can read: 1-2-5 steps that give 8 to 16 of them over the middle of the data."""
    low, high = np.nanpercentile(values, [0.5, 99.0])
    for step in (s * 10.0**e for e in range(-6, 6) for s in (1, 2, 5)):
        if (high - low) / step <= 16:
            return np.arange(math.floor(low / step), math.ceil(high / step) + 1) * step


def fixed_parameters(m):
    """The parameters that no axis varies, from the resolved spec the map carries."""
    values = {}
    for line in m.attributes["spec"].splitlines():
        key, _, value = line.partition(" = ")
        if key in PAPER and not value.startswith("{"):
            values[key] = float(value)
    return values


def shows_paper(coordinates, fixed):
    """True for the panel that the paper's hoop belongs to."""
    here = {**fixed, **coordinates}
    return all(math.isclose(here[k], PAPER[k], rel_tol=1e-6, abs_tol=1e-9) for k in PAPER if k not in ("slope", "mass_ratio"))


def without_cliffs(plane, angle):
    """The plane with gaps where the jump passes from one lift-off to another: isolines must not cross there."""
    cliffs = np.zeros(plane.shape, dtype=bool)
    for axis in (0, 1):
        jumps = np.abs(np.diff(angle, axis=axis)) > 1.0  # rad; along one lift-off the angle changes far less a cell
        before, after = [slice(None)] * 2, [slice(None)] * 2
        before[axis], after[axis] = slice(None, -1), slice(1, None)
        cliffs[tuple(before)] |= jumps
        cliffs[tuple(after)] |= jumps
    return np.where(cliffs, np.nan, plane)


def titled(name, value):
    shown = f"{math.degrees(value):.4g}°" if name == "release_angle" else f"{value:.4g}"
    return f"{SYMBOLS.get(name, name)} = {shown}"


def chart(m, name):
    """One figure: the field over slope and mass ratio."""
    keep = ("mass_ratio", "slope")
    missing = [k for k in keep if k not in m.dims] + [k for k in (name, "spurious_first_jump", "jump_angle") if k not in m.fields]
    if missing:
        raise NotAMap(f"{m.path}: has no {missing[0]}; a design chart wants a sweep over slope and mass_ratio with the "
                      "fields jump_height, jump_time, jump_angle and spurious_first_jump")
    label, colours, exponent, ink, levels = FIELDS[name]
    values = m.fields[name]
    levels = np.asarray(levels if levels is not None else time_levels(values))
    fill = np.unique(np.concatenate([levels] + [np.linspace(a, b, 5) for a, b in zip(levels, levels[1:])]))
    # The map's darkest quarter is left out: hatching must show on every colour.
    colours = ListedColormap(plt.get_cmap(colours)(np.linspace(0.25, 1.0, 256) if exponent < 1 else np.linspace(0.0, 0.75, 256)))
    norm = PowerNorm(exponent, fill[0], fill[-1])
    panels = list(sliced(m, name, keep))
    spurious = [plane for _, plane in sliced(m, "spurious_first_jump", keep)]
    angles = [plane for _, plane in sliced(m, "jump_angle", keep)]
    fixed = fixed_parameters(m)

    columns = min(4, len(panels))
    rows = math.ceil(len(panels) / columns)
    width, height = (3.0, 2.75) if len(panels) > 1 else (6.0, 4.6)
    figure, axes = plt.subplots(rows, columns, squeeze=False, sharex=True, sharey=True, layout="constrained",
                                figsize=(width * columns + 0.9, height * rows + 0.75))
    degrees, ratios = np.degrees(m.dims["slope"]), m.dims["mass_ratio"]
    filled = None
    for axis, (coordinates, plane), flags, angle in zip(axes.flat, panels, spurious, angles):
        axis.set_facecolor(style.NO_JUMP)
        if np.isfinite(plane).any():
            filled = axis.contourf(degrees, ratios, plane, levels=fill, cmap=colours, norm=norm, extend="both")
            lines = axis.contour(degrees, ratios, without_cliffs(plane, angle), levels=levels, colors=ink, linewidths=0.8)
            axis.clabel(lines, fmt=lambda v: f"{v:g}", fontsize=7)
            hatched = np.where(np.isfinite(plane) & (flags == 1), 1.0, 0.0)
            axis.contourf(degrees, ratios, hatched, levels=[0.5, 1.5], colors="none", hatches=["///"])
            axis.contour(degrees, ratios, hatched, levels=[0.5], colors=style.EDGE, linewidths=0.7)
        if shows_paper(coordinates, fixed):
            axis.plot(math.degrees(PAPER["slope"]), PAPER["mass_ratio"], "*", color=style.MARK, markersize=13,
                      markeredgecolor="white", clip_on=True, zorder=5)
        axis.set_yscale("log")
        axis.yaxis.set_major_formatter(lambda v, _: f"{v:g}")
        axis.set_title(", ".join(titled(k, v) for k, v in coordinates.items()) or
                       (titled("offset_ratio", fixed["offset_ratio"]) if "offset_ratio" in fixed else ""))
    for axis in axes.flat[len(panels):]:
        axis.set_visible(False)
    figure.supxlabel("slope [degrees]", fontsize=9)
    figure.supylabel("mass ratio mₚ/m", fontsize=9)
    if filled is not None:
        bar = figure.colorbar(filled, ax=axes, label=label, ticks=levels, shrink=0.9, pad=0.015)
        bar.ax.set_yticklabels([f"{v:g}" for v in levels])
    handles = [
        plt.Rectangle((0, 0), 1, 1, facecolor="white", edgecolor=style.EDGE, hatch="///", label="first lift-off is spurious"),
        plt.Rectangle((0, 0), 1, 1, facecolor=style.NO_JUMP, edgecolor="#808080", label="no jump on the runway"),
        plt.Line2D([], [], marker="*", color="none", markerfacecolor=style.MARK, markeredgecolor="white", markersize=12,
                   label="the paper's hoop"),
    ]
    figure.legend(handles=handles, loc="upper center", ncols=3, frameon=False)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - 0.35 / figure.get_figheight()))
    return figure


def main():
    p = style.parser(__doc__, "a map over slope and mass_ratio, for example maps/slope_mass_ratio_offset.h5", "maps/design_chart")
    arguments = p.parse_args()
    m = read_map(arguments.source)
    for name in FIELDS:
        style.save(chart(m, name), f"{arguments.output}_{name}")


if __name__ == "__main__":
    style.run(main, NotAMap)
