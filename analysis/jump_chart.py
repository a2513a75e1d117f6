#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the hoop of a trace on its slope at equal intervals of time, with the path of its mass.

--animate makes a GIF.

    leapmap hop --trace maps/hop.h5
    analysis/jump_chart.py maps/hop.h5 --animate

The plane is drawn at its angle, lengths in metres. Dark hoops: contact; blue: flight of the jump.
"""
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter

import style
from read_map import NotAMap, read_trace
from style import plt

FRAMES_A_SECOND = 20


class Slope:
    """Points of the plane's axes (x downhill, y away from it) on the page: x to the right, height up."""

    def __init__(self, slope):
        self.downhill = np.array([np.cos(slope), -np.sin(slope)])
        self.away = np.array([np.sin(slope), np.cos(slope)])

    def place(self, x, y):
        return np.multiply.outer(x, self.downhill) + np.multiply.outer(y, self.away)


def markers(trace, numbers, slope):
    """Centres of the hoop and places of the mass, (samples, 2) each."""
    f = trace.fields
    radius, arm = numbers["radius"], numbers["offset_ratio"] * numbers["radius"]
    centre = slope.place(f["x"], f["y"] + radius)
    angle = f.get("pendulum_angle", f["phi"])  # of a pendulum the hoop's own does not matter
    mass = centre - arm * (np.sin(angle)[:, None] * slope.downhill + np.cos(angle)[:, None] * slope.away)
    return centre, mass


def draw_plane(axis, slope, centre, radius):
    travel = centre @ slope.downhill
    ends = np.array([min(travel.min(), 0.0) - 2 * radius, travel.max() + 2 * radius])
    plane = slope.place(ends, np.zeros(2))
    axis.plot(*plane.T, color=style.EDGE, lw=1.5)
    axis.set_aspect("equal")
    axis.set_xlim(plane[:, 0].min(), plane[:, 0].max())
    axis.set_ylim(plane[:, 1].min(), max(plane[:, 1].max(), centre[:, 1].max()) + 1.5 * radius)
    axis.set_axis_off()


def hoop_patches(axis, radius, colour, alpha):
    circle = plt.Circle((0, 0), radius, fill=False, color=colour, lw=1.6, alpha=alpha)
    dot = plt.Circle((0, 0), 0.13 * radius, color="#d62728", alpha=alpha)
    axis.add_patch(circle)
    axis.add_patch(dot)
    return circle, dot


def strobe(trace, numbers, count):
    slope = Slope(numbers["slope"])
    centre, mass = markers(trace, numbers, slope)
    figure, axis = plt.subplots(figsize=(9, 4.2), layout="constrained")
    draw_plane(axis, slope, centre, numbers["radius"])
    axis.plot(*mass.T, color="#d62728", lw=0.8, alpha=0.6)
    t, flight = trace.dims["t"], trace.code("phase", "flight")
    for i in np.searchsorted(t, np.linspace(t[0], t[-1], count)).clip(max=len(t) - 1):
        circle, dot = hoop_patches(
            axis, numbers["radius"], "#1f4e79" if flight[i] else "black", 1.0 if flight[i] else 0.45
        )
        circle.center, dot.center = centre[i], mass[i]
    return figure


def animation(trace, numbers, slow):
    slope = Slope(numbers["slope"])
    centre, mass = markers(trace, numbers, slope)
    figure, axis = plt.subplots(figsize=(5.4, 2.7), layout="constrained")
    draw_plane(axis, slope, centre, numbers["radius"])
    (path,) = axis.plot([], [], color="#d62728", lw=0.8, alpha=0.6)
    circle, dot = hoop_patches(axis, numbers["radius"], "#1f4e79", 1.0)
    t = trace.dims["t"]
    frames = np.searchsorted(t, np.arange(t[0], t[-1], 1 / (slow * FRAMES_A_SECOND))).clip(max=len(t) - 1)

    def show(i):
        circle.center, dot.center = centre[i], mass[i]
        path.set_data(*mass[: i + 1].T)
        return circle, dot, path

    return FuncAnimation(figure, show, [*frames, *[frames[-1]] * (FRAMES_A_SECOND // 2)])


def main():
    p = style.parser(__doc__, "a trace, from leapmap hop --trace", "_jump")
    p.add_argument("--count", type=int, default=24, help="number of hoops drawn (default: %(default)s)")
    p.add_argument(
        "--animate", action="store_true", help="write OUTPUT.gif too, five times slower than the hoop"
    )
    arguments = p.parse_args()
    trace = read_trace(arguments.source)
    numbers = trace.numbers()
    if len(trace.dims["t"]) < 2:
        raise NotAMap(
            f"{trace.path}: holds no motion to draw (the hoop {trace.attributes['status'].replace('_', ' ')})"
        )
    style.save(strobe(trace, numbers, arguments.count), arguments.output)
    if arguments.animate:
        path = f"{style.stem(arguments.output)}.gif"
        animation(trace, numbers, 5.0).save(path, writer=PillowWriter(fps=FRAMES_A_SECOND), dpi=72)
        print(path)


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
