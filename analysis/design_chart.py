#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the design chart of a map: jump height, or jump time, over slope and mass ratio, one panel for each L/R.

Filled contours with labelled isolines; hatched where the first lift-off is spurious; grey where there is no jump,
with stalled, airborne, failed and not computed designs told apart; a star at the paper's hoop. Needs jump_height or
jump_time; spurious_first_jump, jump_angle (gaps at cliffs) and status are drawn if the map has them.
"""
import math
import sys

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap, PowerNorm

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
# status -> colour and words where there is no jump to draw
STATUSES = {
    "no_jump": (style.NO_JUMP, "no jump on the runway"),
    "stalled": ("#a6a6a6", "stalled"),
    "airborne_at_release": ("#c6b7d6", "airborne at release"),
    "failed": ("#f4a582", "failed"),
    "not_computed": ("white", "not computed"),
}
SYMBOLS = {"offset_ratio": "L/R", "inertia_factor": "I/(m R²)", "release_angle": "release angle", "release_spin": "release spin"}


def time_levels(values):
    """Isolines a designer can read: 1-2-5 steps that give 8 to 16 of them over the middle of the data."""
    low, high = np.nanpercentile(values, [0.5, 99.0])
    high = max(high, low * (1 + 1e-6) + 1e-9)
    for step in (s * 10.0**e for e in range(-6, 6) for s in (1, 2, 5)):
        if (high - low) / step <= 16:
            return np.arange(math.floor(low / step), math.ceil(high / step) + 1) * step


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


def caption(fixed, columns):
    """What the axes do not tell: the parameters and the scene all panels share; on two lines below a single panel."""
    words = [titled(k, fixed[k]) for k in SYMBOLS if k in fixed]
    words += [f"runway {fixed['runway']:g} turns", f"jump from {fixed['hop_height']:g} diameters", f"R = {1e3 * fixed['radius']:g} mm"]
    if fixed["slips"]:
        words += [f"μ = {fixed['mu_static']:g}" if "mu_static" in fixed else "μ varies", f"restitution {fixed.get('restitution', 0):g}"]
    half = len(words) if columns > 1 else (len(words) + 1) // 2
    return "\n".join(",  ".join(part) for part in (words[:half], words[half:]) if part)


def draw_panel(axis, degrees, ratios, plane, flags, angle, status, look):
    """One panel: what happened where there is no jump, the field, its isolines, and hatching where spurious."""
    colours, norm, fill, levels, ink = look
    codes = list(STATUSES)
    background = np.full(plane.shape, np.nan)
    for i, code in enumerate(codes):
        background[status[code]] = i
    axis.pcolormesh(degrees, ratios, background, shading="nearest", norm=BoundaryNorm(np.arange(len(codes) + 1) - 0.5, len(codes)),
                    cmap=ListedColormap([STATUSES[c][0] for c in codes]), rasterized=True)
    # Cells first: contours need four neighbours, and a lone design must show too.
    axis.pcolormesh(degrees, ratios, plane, shading="nearest", cmap=colours, norm=norm, rasterized=True)
    filled = axis.contourf(degrees, ratios, plane, levels=fill, cmap=colours, norm=norm, extend="both")
    lines = axis.contour(degrees, ratios, without_cliffs(plane, angle), levels=levels, colors=ink, linewidths=0.8)
    axis.clabel(lines, fmt=lambda v: f"{v:g}", fontsize=7)
    hatched = np.where(np.isfinite(plane), (flags == 1) * 1.0, np.nan)
    axis.contourf(degrees, ratios, hatched, levels=[0.5, 1.5], colors="none", hatches=["///"])
    axis.contour(degrees, ratios, hatched, levels=[0.5], colors=style.EDGE, linewidths=0.7)
    return filled


def chart(m, name):
    """One figure: the field over slope and mass ratio."""
    keep = ("mass_ratio", "slope")
    missing = [k for k in keep if k not in m.dims]
    if missing:
        raise NotAMap(f"{m.path}: has no {missing[0]}; a design chart wants a sweep over slope and mass_ratio")
    if min(len(m.dims[k]) for k in keep) < 2:
        raise NotAMap(f"{m.path}: a design chart wants at least two slopes and two mass ratios")
    if not np.isfinite(m.fields[name]).any():
        raise NotAMap(f"{m.path}: no design in it jumps, so there is no {name} to draw")
    label, colours, exponent, ink, levels = FIELDS[name]
    levels = np.asarray(levels if levels is not None else time_levels(m.fields[name]))
    fill = np.unique(np.concatenate([levels] + [np.linspace(a, b, 5) for a, b in zip(levels, levels[1:])]))
    # The map's darkest quarter is left out: hatching must show on every colour.
    colours = ListedColormap(plt.get_cmap(colours)(np.linspace(0.25, 1.0, 256) if exponent < 1 else np.linspace(0.0, 0.75, 256)))
    look = colours, PowerNorm(exponent, fill[0], fill[-1]), fill, levels, ink
    order = [np.argsort(m.dims[k]) for k in keep]
    ratios, slopes = (m.dims[k][o] for k, o in zip(keep, order))

    def planes(field):
        return [(where, plane[np.ix_(*order)]) for where, plane in sliced(m, field, keep)]

    panels = planes(name)
    # What a map was not asked to store is not drawn: hatching, gaps of isolines at cliffs, reasons why there is no jump.
    flags, angles = (planes(k) if k in m.fields else [(w, np.zeros(p.shape)) for w, p in panels]
                     for k in ("spurious_first_jump", "jump_angle"))
    if "status" in m.fields:
        meaning = {c: i for c, i in zip(m.about["status"]["flag_meanings"].split(), m.about["status"]["flag_values"])}
        told = [{c: plane == meaning[c] for c in STATUSES} for _, plane in planes("status")]
    else:
        m.fields["computed"] = m.computed()
        told = [{c: np.isnan(plane) & ((done & (c == "no_jump")) | (~done & (c == "not_computed"))) for c in STATUSES}
                for (_, plane), (_, done) in zip(panels, planes("computed"))]
    fixed = {**m.numbers(), "slips": m.slips}

    columns = min(4, len(panels))
    rows = math.ceil(len(panels) / columns)
    width, height = (3.0, 2.75) if len(panels) > 1 else (6.0, 4.6)
    figure, axes = plt.subplots(rows, columns, squeeze=False, sharex=True, sharey=True, layout="constrained",
                                figsize=(width * columns + 0.9, height * rows + 0.95))
    starred = False
    for axis, (where, plane), (_, flag), (_, angle), ends in zip(axes.flat, panels, flags, angles, told):
        filled = draw_panel(axis, np.degrees(slopes), ratios, plane, flag, angle, ends, look)
        inside = slopes[0] <= PAPER["slope"] <= slopes[-1] and ratios[0] <= PAPER["mass_ratio"] <= ratios[-1]
        if inside and shows_paper(where, fixed):
            starred = True
            axis.plot(math.degrees(PAPER["slope"]), PAPER["mass_ratio"], "*", color=style.MARK, markersize=13,
                      markeredgecolor="white", zorder=5)
        if ratios[0] > 0 and ratios[-1] / ratios[0] > 10:
            axis.set_yscale("log")
            axis.yaxis.set_major_formatter(lambda v, _: f"{v:g}")
        axis.set_title("\n".join(titled(k, v) for k, v in where.items()))
    for axis in axes.flat[len(panels):]:
        axis.set_visible(False)
    if not m.whole:
        figure.text(0.01, 0.01, f"INCOMPLETE: {m.computed().mean():.0%} of the designs are computed", color=style.MARK, fontsize=9)
    figure.supxlabel(f"slope [degrees]\n{caption(fixed, columns)}", fontsize=9)
    figure.supylabel("mass ratio mₚ/m", fontsize=9)
    bar = figure.colorbar(filled, ax=axes, label=label, ticks=levels, shrink=0.9, pad=0.015)
    bar.ax.set_yticklabels([f"{v:g}" for v in levels])
    handles = [plt.Rectangle((0, 0), 1, 1, facecolor="white", edgecolor=style.EDGE, hatch="///", label="first lift-off is spurious")]
    for code, (colour, words) in STATUSES.items():
        if any(ends[code].any() for ends in told):
            handles.append(plt.Rectangle((0, 0), 1, 1, facecolor=colour, edgecolor="#808080", label=words))
    if starred:
        handles.append(plt.Line2D([], [], marker="*", color="none", markerfacecolor=style.MARK, markeredgecolor="white",
                                  markersize=12, label="the paper's hoop"))
    figure.legend(handles=handles, loc="upper center", ncols=len(handles), frameon=False)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - 0.35 / figure.get_figheight()))
    return figure


def main():
    p = style.parser(__doc__, "a map over slope and mass_ratio, for example maps/slope_mass_ratio_offset.h5", "maps/design_chart")
    arguments = p.parse_args()
    m = read_map(arguments.source)
    drawn = [name for name in FIELDS if name in m.fields]
    if not drawn:
        raise NotAMap(f"{m.path}: has no {' or '.join(FIELDS)}; a design chart wants one of them")
    if not m.whole:
        print(f"{m.path}: INCOMPLETE, {m.computed().mean():.0%} of its designs are computed; the others are left white", file=sys.stderr)
    for name in drawn:
        style.save(chart(m, name), f"{style.stem(arguments.output)}_{name}")


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
