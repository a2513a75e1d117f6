#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the motion of a trace as in the paper's Figs 4 to 6: angle, spin, normal and friction force, height
over time.

A second figure shows the flight of the jump. Dashed lines: lift-offs; solid line: the jump; shaded: sliding
and flight. Forces are in units of the weight, friction positive downhill; y is the height of the hoop's
lowest point. --paper adds the published values."""
import sys

import numpy as np

import style
from read_map import NotAMap, read_trace
from style import plt


# Section 3 of the paper: when its model's normal force vanishes (Fig. 5: "about 0.17 s", "about 0.3 s"), when
# the hoop was seen to leave the plane (Fig. 3 b); and of the flight, from the lift-off, its apex and its
# landing (Fig. 3 c and d), and its height.
PAPER_MODEL, PAPER_SEEN = (0.17, 0.30), 0.330  # s
PAPER_APEX, PAPER_LANDING = 0.129, 0.198  # s
PUBLISHED = "#7b3294"


def panels(trace):
    """What is drawn: (axis label, values)."""
    f = trace.fields
    if "pendulum_angle" in f:
        first = [("angle ψ [degrees]", np.degrees(f["pendulum_angle"])),
                 ("motor's speed [rad/s]", f["pendulum_spin"] - f["spin"]),
                 ("torque [(m + mₚ) g R]", f["motor_torque"])]
    else:
        first = [("angle φ [degrees]", np.degrees(f["phi"])), ("spin [rad/s]", f["spin"])]
    return [
        *first,
        ("normal force [weights]", f["normal_force"]),
        ("friction [weights]", f["friction"]),
        ("height y [mm]", 1e3 * f["y"]),
    ]


def runs(mask):
    """First and last index of every stretch where the mask holds."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(int)))
    return [(begin, end - 1) for begin, end in zip(edges[::2], edges[1::2])]


def chart(trace, paper):
    t = trace.dims["t"]
    if len(t) < 2:
        raise NotAMap(
            f"{trace.path}: holds no motion to draw (the hoop {trace.attributes['status'].replace('_', ' ')})"
        )
    flight, sliding = trace.code("phase", "flight"), trace.code("phase", "sliding")
    times, heights, jumps = (trace.fields[name]
                             for name in ("candidate_time", "candidate_height", "candidate_is_jump"))
    shown = panels(trace)
    figure, axes = plt.subplots(len(shown), 1, sharex=True, figsize=(6.6, 1.92 * len(shown)),
                                layout="constrained")
    for axis, (label, values) in zip(axes, shown):
        # Forces end with contact: no line is drawn through the lift-off.
        force = "weights" in label
        axis.plot(t, np.where(flight, np.nan, values) if force else values, color="#1f4e79", linewidth=1.3)
        for begin, end in runs(flight):
            axis.axvspan(t[begin], t[end], color="#1f4e79", alpha=0.10, linewidth=0)
        for begin, end in runs(sliding):
            axis.axvspan(t[begin], t[end], color="#ff7f0e", alpha=0.10, linewidth=0)
        for i, time in enumerate(times):
            is_jump = jumps[i]
            axis.axvline(time, color=style.MARK if is_jump else "#555555", linestyle="-" if is_jump else "--",
                         linewidth=1.0)
        if force:
            axis.axhline(0.0, color="black", linewidth=0.6)
        axis.set_ylabel(label)
        if paper:
            for time in PAPER_MODEL:
                axis.axvline(time, color=PUBLISHED, linestyle=":", linewidth=1.4)
            axis.axvline(PAPER_SEEN, color=PUBLISHED, linestyle="-.", linewidth=1.4)
        axis.margins(x=0.01)
        axis.grid(alpha=0.25)
    for i, (time, height) in enumerate(zip(times, heights)):
        is_jump = jumps[i]
        if len(times) > 6 and i not in (0, np.argmax(jumps), len(times) - 1):
            continue  # there is no room for all
        text = f"{'jump' if is_jump else 'lift-off'} {time:.4f} s\nflies {height:.3g} diameters"
        place = dict(xy=(time,
                         0.06), xytext=(5, 0), ha="left", va="bottom", color=style.MARK) if is_jump else dict(
                             xy=(time, 0.94), xytext=(-5, 0), ha="right", va="top", color="#555555")
        axes[0].annotate(text, xycoords=("data", "axes fraction"),
                         textcoords="offset points", fontsize=7.5, zorder=5, bbox=dict(
                             facecolor="white", alpha=0.8, edgecolor="none", pad=0.5), **place)
    if paper:
        for time in PAPER_MODEL:
            axes[2].annotate(f"paper: about {time:.2f} s", (time, 0.97), xycoords=("data", "axes fraction"),
                             xytext=(3, 0), textcoords="offset points", ha="left", va="top", fontsize=7,
                             color=PUBLISHED, rotation=90)
        axes[2].annotate(f"seen {PAPER_SEEN:.3f} s", (PAPER_SEEN, 0.97), xycoords=("data", "axes fraction"),
                         xytext=(3, 0), textcoords="offset points", ha="left", va="top", fontsize=7,
                         color=PUBLISHED, rotation=90)
    axes[-1].set_xlabel("time since release [s]")
    axes[0].set_title(caption(trace), fontsize=8)
    return figure


def flight_chart(trace, paper):
    """The flight of the first jump, after the paper's Fig. 6."""
    t, f = trace.dims["t"], trace.fields
    first = int(np.argmax(f["candidate_is_jump"]))
    time = f["candidate_time"][first]
    begin, end = next(run for run in runs(trace.code("phase", "flight")) if t[run[1]] >= time * (1 - 1e-12))
    # The lift-off itself is the last moment of contact where it is a sample, as without slip.
    begin -= int(begin > 0 and t[begin - 1] >= time * (1 - 1e-12))
    part = slice(begin, end + 1)
    after = t[part] - time
    radius = trace.numbers()["radius"]
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(6.6, 6.6), layout="constrained")
    for axis, (label, values) in zip(axes, (("Δx along the plane [mm]", 1e3 * (f["x"] - f["x"][begin])),
                                            ("Δy above the plane [mm]", 1e3 * f["y"]),
                                            ("Δφ [degrees]", np.degrees(f["phi"] - f["phi"][begin])))):
        axis.plot(after, values[part], color="#1f4e79", linewidth=1.3, label="leapmap")
        axis.set_ylabel(label)
        axis.grid(alpha=0.25)
        axis.margins(x=0.01)
        if paper:
            axis.axvline(PAPER_APEX, color=PUBLISHED, linestyle="-.", linewidth=1.4)
            axis.axvline(PAPER_LANDING, color=PUBLISHED, linestyle="-.", linewidth=1.4)
    apex = int(np.argmax(f["y"][part]))
    axes[1].plot(after[apex], 1e3 * f["y"][part][apex], "o", color="#1f4e79", markersize=4)
    axes[1].annotate(f"apex {f['candidate_height'][first]:.3f} diameters\nafter {after[apex]:.3f} s",
                     (after[apex], 1e3 * f["y"][part][apex]), xytext=(0, -18),
                     textcoords="offset points", ha="center", va="top", fontsize=7.5, bbox=dict(
                         facecolor="white", edgecolor="none", pad=1))
    axes[1].annotate(f"lands after {after[-1]:.4f} s", (after[-1], 0), xytext=(-24, 2),
                     textcoords="offset points", ha="right", va="bottom", fontsize=7.5)
    if paper:
        axes[1].axhline(2e3 * radius, color=PUBLISHED, linestyle="-.", linewidth=1.4)
        axes[1].annotate("one diameter", (0, 2e3 * radius), xytext=(2, 2), textcoords="offset points",
                         fontsize=7.5, color=PUBLISHED, va="bottom")
        axes[1].margins(y=0.12)
        for time, words, side in ((PAPER_APEX, "apex", 1), (PAPER_LANDING, "landing", -1)):
            axes[2].annotate(f"measured {words} {time:.3f} s", (time, 0.03),
                             xycoords=("data", "axes fraction"), xytext=(3 * side, 0),
                             textcoords="offset points", ha="left" if side > 0 else "right", va="bottom",
                             fontsize=7, color=PUBLISHED, rotation=90)
    axes[-1].set_xlabel("time since lift-off [s]")
    axes[0].set_title(
        caption(trace, "the flight of the jump (13)" + (", marked: measured in the paper" if paper else "")),
        fontsize=8)
    return figure


def caption(trace, below=None):
    """Which hoop it is, and below it by which model it moves, or other words."""
    flight, design = trace.code("phase", "flight"), trace.numbers()
    shown = [
        f"slope {np.degrees(design['slope']):.4g}°", f"mₚ/m = {design['mass_ratio']:.4g}",
        f"L/R = {design['offset_ratio']:.4g}",
        f"released at {np.degrees(design['pendulum_angle' if trace.has_pendulum else 'release_angle']):.4g}°",
        f"spin {design['release_spin']:.4g} √(g/R)", trace.attributes["status"].replace("_", " ")
    ]
    if design.get("drive_torque"):
        shown.insert(-1, f"τ = {design['drive_torque']:.4g}")
    if trace.has_pendulum:
        law = trace.spec()["design"]["motor_law"].replace("_", " ")
        shown.insert(-1, f"torque {design['motor_torque']:.4g}, no load {design['no_load_speed']:.4g}, {law}")
    if trace.slips:
        kinetic = design.get("mu_kinetic", design["mu_static"])
        shown[-1:] = [
            f"μ = {design['mu_static']:.4g}" +
            (f" / {kinetic:.4g}" if kinetic != design["mu_static"] else ""),
            f"restitution {design['restitution']:.4g}", shown[-1]
        ]
        below = below or "Coulomb friction: sliding shaded orange, flight blue"
    elif trace.has_pendulum:
        below = below or "rolling without slip, then flight, shaded"
    else:
        below = below or "rolling (10)-(12), then flight (13), shaded" if flight.any(
        ) else "rolling (10)-(12)"
    return ",  ".join(shown) + "\n" + below


def main():
    p = style.parser(__doc__, "a trace: leapmap hop --trace FILE", "")
    p.add_argument("--paper", action="store_true", help="mark the paper's times and its height")
    arguments = p.parse_args()
    trace = read_trace(arguments.source)
    jumped = trace.attributes["status"] == "jumped"
    same_clock = jumped and abs(trace.fields["candidate_time"][np.argmax(trace.fields["candidate_is_jump"])] -
                                PAPER_SEEN) < 0.05
    if arguments.paper and not same_clock:
        print(
            f"{trace.path}: was released at another moment than the paper's hoop; its times since release "
            "are not marked",
            file=sys.stderr)
    style.save(chart(trace, arguments.paper and same_clock), arguments.output)
    if jumped:
        style.save(flight_chart(trace, arguments.paper), f"{style.stem(arguments.output)}_flight")


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
