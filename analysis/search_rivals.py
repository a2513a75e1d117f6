#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap design against brute force and against scipy, on the same questions: what is found, how many designs it takes, how long.

A grid goes through the same box with as many designs as --grid says (with friction as --slipping, of hoops as made --made); the goals are
looked at with numpy. scipy's differential evolution and dual annealing ask one design at a time, through leapmap.DesignProblem. "short"
is by how much each misses the best of all. Exit status 1: something found a better design than leapmap design.
"""
import argparse
import sys
import time
import tomllib
from pathlib import Path

import leapmap
import numpy as np
from scipy import optimize

BLOCK = 1 << 20


def grid_of(problem, logs, count):
    """Axes of a grid of about so many designs."""
    each = round(count ** (1 / len(problem.names)))
    return [np.geomspace(*bounds, each) if log else np.linspace(*bounds, each) for bounds, log in zip(problem.bounds, logs)]


def blocks(axes):
    shape = tuple(len(axis) for axis in axes)
    for first in range(0, int(np.prod(shape)), BLOCK):
        at = np.unravel_index(np.arange(first, min(first + BLOCK, int(np.prod(shape)))), shape)
        yield [axis[i] for axis, i in zip(axes, at)]


def reached(outcomes, goals):
    """Which of the outcomes reach every goal."""
    good = np.ones(np.shape(outcomes.status), bool)
    for field, goal in goals.items():
        values = getattr(outcomes, field)
        for bound, holds in (("at_least", np.greater_equal), ("at_most", np.less_equal), ("is", np.equal)):
            if bound in goal:
                good &= holds(values, goal[bound])
    return good


def brute_force(spec, problem, logs, count):
    """The best objective over a grid, its sign turned if it is to be large; how many designs that took."""
    goals = {k: v for k, v in spec["goal"].items() if k not in ("maximize", "minimize")}
    name, sign = (spec["goal"]["maximize"][0], -1) if "maximize" in spec["goal"] else (spec["goal"]["minimize"][0], 1)
    fixed = {k: v for k, v in {**spec.get("scene", {}), **spec["design"]}.items() if not isinstance(v, dict)}
    best, solved = np.inf, 0
    for columns in blocks(grid_of(problem, logs, count)):
        solved += len(columns[0])
        if "scatter" in spec:
            best = min(best, problem.costs(np.stack(columns, axis=1))[:, 0].min())
            continue
        fields = sorted({*goals, "status"} | ({name} - set(problem.names)))
        outcomes = leapmap.solve(**fixed, **dict(zip(problem.names, columns)), fields=fields)
        values = columns[problem.names.index(name)] if name in problem.names else getattr(outcomes, name)
        good = reached(outcomes, goals) & np.isfinite(values)
        if good.any():
            best = min(best, (sign * values[good]).min())
    return best, solved


def timed(work):
    begin = time.perf_counter()
    told = work()
    return *told, time.perf_counter() - begin


def scipys(path, method, seed):
    problem = leapmap.DesignProblem(path, threads=1)
    found = method(problem.cost, problem.bounds, seed=seed)
    return found.fun, problem.evaluations


def rivals(path, arguments):
    spec = tomllib.loads(path.read_text())
    problem = leapmap.DesignProblem(path)
    logs = [spec["design"].get(name, spec.get("scene", {}).get(name))["scale"] == "log"
            if "scale" in spec["design"].get(name, spec.get("scene", {}).get(name)) else False for name in problem.names]
    sign = -1 if "maximize" in spec["goal"] else 1

    def design():
        found = leapmap.design(path, seed=arguments.seed)
        return (sign * found.objectives[problem.objectives[0]][0] if found.reached else np.inf), found.evaluations

    count = arguments.made if "scatter" in spec else arguments.slipping if spec.get("scene", {}).get("friction") == "coulomb" else arguments.grid
    return problem.objectives[0], sign, {
        "leapmap design": timed(design),
        "grid": timed(lambda: brute_force(spec, problem, logs, count)),
        "differential evolution": timed(lambda: scipys(path, optimize.differential_evolution, arguments.seed)),
        "dual annealing": timed(lambda: scipys(path, optimize.dual_annealing, arguments.seed)),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("questions", nargs="*", type=Path, help="specs of one objective (default: those of sweeps/questions)")
    parser.add_argument("--grid", type=float, default=1e8, metavar="DESIGNS")
    parser.add_argument("--slipping", type=float, default=1e6, metavar="DESIGNS")
    parser.add_argument("--made", type=float, default=2e4, metavar="DESIGNS")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    folder = Path(__file__).resolve().parent.parent / "sweeps" / "questions"
    print("| question | by | found | short | designs | seconds |\n|---|---|---|---|---|---|")
    beaten = False
    for path in arguments.questions or sorted(folder.glob("*.toml")):
        goal = tomllib.loads(path.read_text())["goal"]
        if len(goal.get("maximize", [])) + len(goal.get("minimize", [])) != 1:
            continue
        objective, sign, found = rivals(path, arguments)
        best = min(cost for cost, _, _ in found.values())
        for by, (cost, solved, seconds) in found.items():
            told = f"{objective} {sign * cost:.10g}" if cost < 1e29 else "none"
            print(f"| {path.stem} | {by} | {told} | {'-' if cost >= 1e29 else f'{cost - best:.1e}'} | {solved:,} | {seconds:.1f} |", flush=True)
        beaten |= found["leapmap design"][0] > best + 1e-11 * (1 + abs(best))
    sys.exit(1 if beaten else 0)


if __name__ == "__main__":
    main()
