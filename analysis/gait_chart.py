#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the return map of a hoop, from the angle of one lift-off to the next, and the heights of its jumps
over the slope.

Left: the return map, with the first jumps as a cobweb, and every gait. It crosses the diagonal at gaits,
which are stable if its slope there, the Floquet multiplier, is below 1 in size. Right: the heights after a
transient, as a density. Needs leapmap's Python module."""
import argparse

import numpy as np

import style
from style import plt

TRANSIENT = 50  # jumps that are not drawn


def draw_return_map(axis, leapmap, hoop, runway):
    gaits = leapmap.gaits(**hoop, runway=5.0)
    returns = gaits["returns"]
    ahead = ~returns["uphill"]
    angle, following = np.degrees(returns["angle"][ahead]), np.degrees(returns["next"][ahead])
    far = np.abs(np.diff(following)) > 20.0
    following[1:][far] = np.nan
    axis.plot(angle, following, color="#2166ac", lw=1.4, label="return map")
    axis.plot([0, 360], [0, 360], color="0.7", lw=0.8)
    motion = leapmap.trace(**hoop, interval=0.0, jumps=30, runway=runway)
    lift_offs = np.degrees([one["phi"] for one in motion.candidates if one["is_jump"]]) % 360.0
    path = np.repeat(lift_offs, 2)
    axis.plot(path[:-2], path[1:-1], color="0.45", lw=0.7, label=f"its first {len(lift_offs)} jumps")
    others = 0
    for gait in gaits["gaits"]:
        there, stable = np.degrees(gait["jumps"]["angle"][0]) % 360.0, abs(gait["multiplier"]) < 1
        told = (f"{'stable' if stable else 'unstable'} gait: {gait['height']:.4f} diameters, multiplier "
                f"{gait['multiplier']:.3f}")
        others += not stable
        if stable or others == 1:
            label = told
        else:
            unstable = sum(abs(one["multiplier"]) >= 1 for one in gaits["gaits"])
            label = f"{unstable - 1} more, all unstable" if others == 2 else None
        axis.plot(there, there, "o", ms=7 if stable else 5, color=style.MARK,
                  mfc=style.MARK if stable else "white", label=label)
    seen = np.concatenate([angle[np.isfinite(following)], following[np.isfinite(following)]])
    axis.set_xlim(seen.min() - 3, seen.max() + 3)
    axis.set_ylim(axis.get_xlim())
    axis.set_aspect("equal")
    axis.set_xlabel("angle at a lift-off [°]")
    axis.set_ylabel("angle at the next [°]")
    axis.legend(fontsize=7, loc="lower right")


def draw_bifurcations(axis, leapmap, hoop, runway, slopes, jumps):
    names = ["jump_height" if k == 1 else f"jump_height_{k}" for k in range(TRANSIENT + 1, jumps + 1)]
    outcome = leapmap.solve(**(hoop | {"slope": slopes}), jumps=jumps, runway=runway,
                            fields=["jumps"] + names)
    heights = np.array([getattr(outcome, name) for name in names])
    places = np.broadcast_to(np.degrees(slopes), heights.shape)
    there = np.isfinite(heights) & (outcome.jumps == jumps)
    counts, x, y = np.histogram2d(places[there], heights[there], bins=(len(slopes) // 4, 400))
    axis.pcolormesh(x, y,
                    np.where(counts > 0, np.log10(np.maximum(counts, 1)), np.nan).T, cmap="viridis",
                    rasterized=True)
    axis.axvline(np.degrees(hoop["slope"]), color=style.MARK, lw=0.8, ls="--")
    axis.set_xlabel("slope [°]")
    axis.set_ylabel("jump height [hoop diameters]")
    axis.set_title(
        f"{there.sum():,} jumps after a transient of {TRANSIENT} at every slope; dashed: hoop on the left",
        fontsize=8)


def main():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("-o", "--output", default="maps/gait",
                   help="file name without ending; PNG, SVG and PDF are written (default: maps/gait)")
    for name, value in (("slope", 12.0), ("mass_ratio", 3.0), ("offset_ratio", 0.5)):
        p.add_argument("--" + name.replace("_", "-"), type=float, default=value,
                       help=f"default {value}" + (", in degrees" if name == "slope" else ""))
    p.add_argument("--slopes", type=int, default=6000,
                   help="slopes on the right; default 6000: a million jumps")
    p.add_argument("--from", dest="least", type=float, default=2.0,
                   help="least slope on the right, in degrees")
    p.add_argument("--to", dest="most", type=float, default=22.0,
                   help="largest slope on the right, in degrees")
    arguments = p.parse_args()
    leapmap = style.leapmap_module()
    hoop = {
        "slope": np.radians(arguments.slope), "mass_ratio": arguments.mass_ratio,
        "offset_ratio": arguments.offset_ratio
    }
    figure, (left, right) = plt.subplots(1, 2, figsize=(12.5, 5.4), layout="constrained")
    draw_return_map(left, leapmap, hoop, 50.0)
    draw_bifurcations(right, leapmap, hoop, 1e5,
                      np.radians(np.linspace(arguments.least, arguments.most, arguments.slopes)), 250)
    figure.suptitle(
        f"slope {arguments.slope:g}°, m_p/m {arguments.mass_ratio:g}, L/R {arguments.offset_ratio:g}, no slip"
    )
    style.save(figure, arguments.output)


if __name__ == "__main__":
    style.run(main, OSError, ValueError)
