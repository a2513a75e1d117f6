#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the Pareto front of a design problem with two objectives, and a cloud of designs that it dominates.

The front is read from the map that leapmap design -o wrote; of a spec it is searched for.
Colours show the number of the lift-off that jumps. Three designs are marked, each with the hoop in its jump.
A gap: neighbours on the front are far apart within the bounds, or another lift-off jumps. Needs leapmap's
Python module."""
import textwrap
from dataclasses import dataclass, field

import h5py
import numpy as np

import looks
import planes
import style
from read_map import NotAMap, read_map
from style import plt

CLOUD, SHOWN = 200_000, 15_000
NUMBERS = ("#b2182b", "#2166ac", "#1b7837")


def is_parameter(name):
    return name in looks.PARAMETERS or name.startswith("hoop.")


def shown(name, values):
    """As charts show it: angles in degrees."""
    return looks.as_shown(name, np.asarray(values)) if is_parameter(name) else np.asarray(values)


def label(name):
    return planes.axis_label(name) if is_parameter(name) else planes.field_label(name).replace(
        "\n", " ") if name in looks.LOOKS else name.replace("_", " ")


def called_out(x, y):
    """The front's ends, and the design between them that is farthest off the line that joins them."""
    u, v = (x - x[0]) / ((x[-1] - x[0]) or 1), (y - y[0]) / ((y[-1] - y[0]) or 1)
    return sorted({0, int(np.argmax(np.abs(u - v))), len(x) - 1})


@dataclass
class Front:
    """Designs in the order of the first objective. parameters: those that were free; fixed: the others and
    the scene, as leapmap.trace takes them; bounds: of the parameters, low and high of each; follows: what
    follows from free numbers of [hoop], as leapmap.trace takes it, for each design."""
    objectives: list
    parameters: dict
    values: dict
    candidates: np.ndarray
    jump_height: np.ndarray
    fixed: dict
    bounds: list
    follows: dict = field(default_factory=dict)

    def traced(self, i):
        """Design i as leapmap.trace takes it."""
        free = {n: v for n, v in self.parameters.items() if not n.startswith("hoop.")}
        return self.fixed | {n: float(v[i]) for n, v in (free | self.follows).items()}


def searched(path, problem, seed):
    """The front of a design problem, which is searched for."""
    if of_hoop := [n for n in problem.names if n.startswith("hoop.")]:
        raise NotAMap(f"{path}: {of_hoop[0]} is free; allowed: the map that leapmap design {path} -o MAP.h5 "
                      "writes")
    found = style.leapmap_module().design(path, seed=seed)
    if not found.reached:
        raise NotAMap(
            f"{path}: no design within the bounds reaches the goals; leapmap design shows the nearest miss")
    return Front(problem.objectives, {n: found.parameters[n] for n in problem.names}, found.objectives,
                 found.outcomes.candidates, found.outcomes.jump_height, problem.fixed, problem.bounds)


def stored(path, units):
    """The front that leapmap design -o wrote, its objectives in these units."""
    m = planes.in_units(read_map(path), units)
    spec, design = m.spec(), m.fields
    goal, scene = spec.get("goal", {}), spec["scene"]
    objectives = [*goal.get("maximize", ()), *goal.get("minimize", ())]
    if list(m.dims) != ["design"] or len(objectives) != 2:
        raise NotAMap(f"{path}: is no Pareto front; allowed: a map that leapmap design -o wrote for two "
                      "objectives, or a spec of two")
    columns = {n: design[n] for n in looks.listed(m)}
    free = {n: v for n, v in columns.items() if np.ptp(v) > 0 or n in objectives or n.startswith("hoop.")}
    of_contact = ("rest_speed", ) if m.slips else ()
    fixed = {n: scene[n] for n in ("friction", "runway", "hop_height", "gravity", *of_contact)}
    fixed |= {n: float(v[0]) for n, v in columns.items() if n not in free}
    if "hoop" in spec:
        ratios = {n: design[n] for n in ("mass_ratio", "offset_ratio", "inertia_factor")}
        follows = ratios | {"radius": np.broadcast_to(m.radii(), design["jump_height"].shape)}
    else:
        fixed["radius"], follows = scene["radius"], {}
    values = {n: design[n] for n in objectives}
    along, across = (np.diff(v) for v in values.values())
    is_front = all((d >= 0).all() or (d <= 0).all() for d in (along, across))
    if not free or not is_front:
        raise NotAMap(
            f"{path}: is no Pareto front of several designs; allowed: a map that leapmap design -o wrote")
    return Front(objectives, free, values, design["candidates"],
                 design["jump_height"], fixed, [(v.min(), v.max()) for v in free.values()], follows)


def pieces(front):
    """The front cut where it has a gap: slices."""
    low, high = np.array(front.bounds).T
    places = (np.stack(list(front.parameters.values()), axis=1) - low) / np.where(high > low, high - low, 1)
    far = np.abs(np.diff(places, axis=0)).max(axis=1) > 0.05
    other = np.diff(front.candidates.astype(int)) != 0
    ends = [0, *(np.flatnonzero(far | other) + 1), len(places)]
    return [slice(a, b) for a, b in zip(ends, ends[1:])]


def draw_hoop(axis, leapmap, hoop, colour):
    """The hoop at some moments of its jump, on its slope."""
    motion = leapmap.trace(**hoop, interval=2e-3)
    slope, size, radius = hoop["slope"], hoop["offset_ratio"], hoop["radius"]
    t, start, end = np.asarray(motion.t), float(motion.outcome.jump_time), np.asarray(motion.t)[-1]
    down, up = np.array([np.cos(slope), -np.sin(slope)]), np.array([np.sin(slope), np.cos(slope)])
    x0 = np.interp(start, t, motion.x)
    for moment in np.linspace(start, end, 6):
        x, y, phi = (np.interp(moment, t, np.asarray(v)) for v in (motion.x, motion.y, motion.phi))
        centre = (x - x0) / radius * down + (1 + y / radius) * up
        mass = centre + size * (-np.sin(phi) * down - np.cos(phi) * up)
        axis.add_patch(
            plt.Circle(centre, 1.0, fill=False, color=colour, linewidth=1.0,
                       alpha=0.35 + 0.65 * (moment - start) / (end - start)))
        axis.plot(*mass, "o", color=colour, markersize=4)
    reach = (np.interp(end, t, motion.x) - x0) / radius + 1.5
    axis.plot(*np.stack([-1.5 * down, reach * down]).T, color=style.EDGE, linewidth=1.0)
    axis.set_aspect("equal")
    axis.axis("off")


def cloud_of(problem, front):
    """Designs by chance that reach every goal: rows of both objectives."""
    low, high = np.array(problem.bounds).T
    costs, violations = problem.judge(low + (high - low) * np.random.default_rng(1).random((CLOUD, len(low))))
    signs = np.array([
        np.sign(np.nanmedian(costs[:, k])) * np.sign(np.nanmedian(front.values[n]))
        for k, n in enumerate(front.objectives)
    ])
    return (costs * np.where(signs == 0, 1, signs))[violations == 0][:SHOWN]


def answers(problem, front):
    """Whether a stored front may be the answer to a question: the same objectives, parameters within the
    bounds, and what is fixed alike."""
    bounds = dict(zip(problem.names, problem.bounds))
    at = front.parameters | {n: np.array([v]) for n, v in front.fixed.items() if n in bounds}
    return (problem.objectives == front.objectives and set(front.parameters) <= set(bounds) and all(
        low <= at[n].min() and at[n].max() <= high
        for n, (low, high) in bounds.items()) and all(
        front.fixed.get(n, v) == v for n, v in problem.fixed.items()))


def front_and_cloud(path, question, seed, units):
    """The front of a file, and the cloud around it, which needs the bounds of a question."""
    from_map = h5py.is_hdf5(path)
    front = stored(path, units) if from_map else None
    question = question if from_map else path
    if question is None:
        return front, np.empty((0, 2))
    problem = style.leapmap_module().DesignProblem(question)
    if len(problem.objectives) != 2:
        raise NotAMap(f"{question}: has {len(problem.objectives)} objectives; allowed: two")
    if front is None:
        front = searched(path, problem, seed)
    elif not answers(problem, front):
        raise NotAMap(f"{question}: is not the question that {path} answers")
    return front, cloud_of(problem, front)


def chart(path, question, seed, units):
    leapmap = style.leapmap_module()
    front, cloud = front_and_cloud(path, question, seed, units)
    first, second = front.objectives
    x, y = shown(second, front.values[second]), shown(first, front.values[first])
    figure = plt.figure(figsize=(9.6, 5.6), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=(2.1, 1))
    axis = figure.add_subplot(grid[:, 0])
    axis.plot(shown(second, cloud[:, 1]), shown(first, cloud[:, 0]), ",", color="#b8b8b8", rasterized=True)
    colour = lambda number: plt.get_cmap("viridis")(0.15 + 0.7 * min(number - 1, 3) / 3)
    for piece in pieces(front):
        axis.plot(x[piece], y[piece], ".-", markersize=2, linewidth=1.4,
                  color=colour(int(front.candidates[piece.start])))
    for number in sorted({int(c) for c in front.candidates}):
        axis.plot([], [], color=colour(number), label=f"lift-off {number} is the jump")
    if len(cloud):
        axis.plot([], [], "o", markersize=3, color="#b8b8b8", label="designs by chance")
    for k, i in enumerate(called_out(x, y)):
        axis.annotate(str(k + 1), (x[i], y[i]), xytext=(7, 5), textcoords="offset points", color=NUMBERS[k],
                      weight="bold", fontsize=11)
        axis.plot(x[i], y[i], "o", color=NUMBERS[k], markersize=6, markeredgecolor="white")
        design = {n: float(values[i]) for n, values in front.parameters.items()}
        beside = figure.add_subplot(grid[k, 1])
        if front.jump_height[i] > 0:
            draw_hoop(beside, leapmap, front.traced(i), NUMBERS[k])
        words = ", ".join(f"{planes.axis_label(n)} {shown(n, v):.4g}" for n, v in design.items()
                          if n not in front.objectives)
        beside.set_title(
            textwrap.fill(f"{k + 1}: {words}; {label(first)} {y[i]:.4g}, {label(second)} {x[i]:.4g}", 52),
            fontsize=7.5, color=NUMBERS[k])
    axis.set_xlabel(label(second))
    axis.set_ylabel(label(first))
    axis.margins(0.04)
    axis.legend(loc="best")
    axis.set_title(
        f"{len(x):,} designs; improving one objective makes the other worse; gaps: discontinuities")
    return figure


def main():
    p = style.parser(
        __doc__, "a Pareto front by leapmap design -o, or a spec of two objectives, which is searched first, "
        "for example sweeps/questions/height_against_time.toml", "_front")
    p.add_argument("--question", metavar="SPEC", help="the spec that a map answers: for the cloud of designs")
    p.add_argument("--seed", type=int, default=1, help="of the search (default: 1)")
    planes.add_units(p)
    arguments = p.parse_args()
    if arguments.question and not h5py.is_hdf5(arguments.source):
        raise NotAMap(f"--question {arguments.question}: has no effect beside a spec; allowed: beside a map")
    if arguments.units and (arguments.question or not h5py.is_hdf5(arguments.source)):
        raise NotAMap(f"--units {arguments.units}: goes with a map alone, as designs by chance are in the "
                      "map's own units; allowed: a map that leapmap design -o wrote, without --question")
    try:
        figure = chart(arguments.source, arguments.question, arguments.seed, arguments.units)
    except ValueError as error:
        raise NotAMap(str(error)) from None
    style.save(figure, arguments.output)


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
