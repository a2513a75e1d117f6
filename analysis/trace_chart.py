#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Redraws the paper's Figs 4 and 5 from a trace: angle, spin, normal and friction force over time, and the flight.

Lift-off candidates are dashed lines, the jump a solid one; the flight is shaded. Forces are in units of
the weight, friction positive downhill; y is the height of the hoop's lowest point above the plane.
"""
import numpy as np

import style
from read_map import NotAMap, read_trace
from style import plt


def panels(trace):
    """What is drawn: (axis label, values)."""
    f = trace.fields
    return [
        ("angle φ [degrees]", np.degrees(f["phi"])),
        ("spin [rad/s]", f["spin"]),
        ("normal force [weights]", f["normal_force"]),
        ("friction [weights]", f["friction"]),
        ("height y [mm]", 1e3 * f["y"]),
    ]


def runs(mask):
    """First and last index of every stretch where the mask holds."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(int)))
    return [(begin, end - 1) for begin, end in zip(edges[::2], edges[1::2])]


def chart(trace):
    t = trace.dims["t"]
    if len(t) < 2:
        raise NotAMap(f"{trace.path}: holds no motion to draw (the hoop {trace.attributes['status'].replace('_', ' ')})")
    jumped = trace.attributes["status"] == "jumped"
    flight, sliding = trace.code("phase", "flight"), trace.code("phase", "sliding")
    times, heights = trace.fields["candidate_time"], trace.fields["candidate_height"]
    figure, axes = plt.subplots(5, 1, sharex=True, figsize=(6.6, 9.6), layout="constrained")
    for axis, (label, values) in zip(axes, panels(trace)):
        # Forces end with contact: no line is drawn through the lift-off.
        force = "weights" in label
        axis.plot(t, np.where(flight, np.nan, values) if force else values, color="#1f4e79", linewidth=1.3)
        for begin, end in runs(flight):
            axis.axvspan(t[begin], t[end], color="#1f4e79", alpha=0.10, linewidth=0)
        for begin, end in runs(sliding):
            axis.axvspan(t[begin], t[end], color="#ff7f0e", alpha=0.10, linewidth=0)
        for i, time in enumerate(times):
            is_jump = jumped and i == len(times) - 1
            axis.axvline(time, color=style.MARK if is_jump else "#555555", linestyle="-" if is_jump else "--", linewidth=1.0)
        if force:
            axis.axhline(0.0, color="black", linewidth=0.6)
        axis.set_ylabel(label)
        axis.margins(x=0.01)
        axis.grid(alpha=0.25)
    for i, (time, height) in enumerate(zip(times, heights)):
        is_jump = jumped and i == len(times) - 1
        if len(times) > 6 and i > 0 and not is_jump:
            continue  # there is no room for all
        text = f"{'jump' if is_jump else 'candidate'} {time:.4f} s\nflies {height:.3g} diameters"
        place = dict(xy=(time, 0.06), xytext=(5, 0), ha="left", va="bottom", color=style.MARK) if is_jump else dict(
            xy=(time, 0.94), xytext=(-5, 0), ha="right", va="top", color="#555555")
        axes[0].annotate(text, xycoords=("data", "axes fraction"), textcoords="offset points", fontsize=7.5, **place)
    axes[-1].set_xlabel("time since release [s]")
    design = trace.numbers()
    shown = [f"slope {np.degrees(design['slope']):.4g}°", f"mₚ/m = {design['mass_ratio']:.4g}", f"L/R = {design['offset_ratio']:.4g}",
             f"released at {np.degrees(design['release_angle']):.4g}°", f"spin {design['release_spin']:.4g} √(g/R)",
             trace.attributes["status"].replace("_", " ")]
    if trace.slips:
        kinetic = design.get("mu_kinetic", design["mu_static"])
        shown[-1:] = [f"μ = {design['mu_static']:.4g}" + (f" / {kinetic:.4g}" if kinetic != design["mu_static"] else ""),
                      f"restitution {design['restitution']:.4g}", shown[-1]]
        below = "Coulomb friction: sliding shaded orange, flight blue"
    else:
        below = "rolling (10)-(12), then flight (13), shaded" if flight.any() else "rolling (10)-(12)"
    axes[0].set_title(",  ".join(shown) + "\n" + below, fontsize=8)
    return figure


def main():
    p = style.parser(__doc__, "a trace: leapmap hop --trace FILE", "maps/trace_chart")
    arguments = p.parse_args()
    style.save(chart(read_trace(arguments.source)), arguments.output)


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
