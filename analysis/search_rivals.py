#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare leapmap design with brute force and with scipy, on the same design problems.

A grid over the same bounds has --grid designs (with friction --slipping, of manufactured hoops --made); numpy
evaluates the goals. scipy's differential evolution and dual annealing solve one design at a time, through
leapmap.DesignProblem. "short" is the difference to the best result of all. Two objectives: the volume that
the front dominates, against that of --random designs. Exit status 1: another method found a better design or
front."""
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
    return [
        np.geomspace(*bounds, each) if log else np.linspace(*bounds, each)
        for bounds, log in zip(problem.bounds, logs)
    ]


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
    name, sign = (spec["goal"]["maximize"][0],
                  -1) if "maximize" in spec["goal"] else (spec["goal"]["minimize"][0], 1)
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
    logs = logs_of(path, problem)
    sign = -1 if "maximize" in spec["goal"] else 1

    def design():
        found = leapmap.design(path, seed=arguments.seed)
        # By the samples that all others see: a search reports its yield by fresh ones.
        best = problem.cost([found.parameters[name][0] for name in problem.names])
        return (best if found.reached else np.inf), found.evaluations

    count = arguments.made if "scatter" in spec else arguments.slipping if spec.get(
        "scene", {}).get("friction") == "coulomb" else arguments.grid
    return problem.objectives[0], sign, {
        "leapmap design": timed(design),
        "grid": timed(lambda: brute_force(spec, problem, logs, count)),
        "differential evolution": timed(
            lambda: scipys(path, optimize.differential_evolution, arguments.seed)),
        "dual annealing": timed(lambda: scipys(path, optimize.dual_annealing, arguments.seed)),
    }


def front_of(costs):
    """Of rows of two costs those that none dominates, in order of the first."""
    costs = costs[np.lexsort((costs[:, 1], costs[:, 0]))]
    least = np.minimum.accumulate(np.concatenate(([np.inf], costs[:-1, 1])))
    return costs[costs[:, 1] < least]


def volume(front, corner):
    """What a front dominates, up to a corner."""
    right = np.append(front[1:, 0], corner[0])
    return float(((right - front[:, 0]) * (corner[1] - front[:, 1])).sum())


def random_front(problem, logs, count):
    random, best = np.random.default_rng(1), np.empty((0, 2))
    low, high = np.array(problem.bounds).T
    for first in range(0, int(count), BLOCK):
        share = random.random((min(BLOCK, int(count) - first), len(low)))
        places = np.where(
            logs,
            np.exp(
                np.log(np.where(logs, low, 1)) +
                share * np.log(np.where(logs, high / np.where(logs, low, 1), 1))), low + share * (high - low))
        costs, violations = problem.judge(np.clip(places, low, high))
        best = front_of(np.concatenate((best, costs[violations == 0])))
    return best, int(count)


def fronts(path, arguments):
    """Both fronts' volumes, over the box from their best to their worst corner."""
    problem = leapmap.DesignProblem(path)

    def design():
        found = leapmap.design(path, seed=arguments.seed)
        signs = [
            -1 if name in tomllib.loads(path.read_text())["goal"].get("maximize", []) else 1
            for name in problem.objectives
        ]
        return np.stack([sign * found.objectives[name] for sign, name in zip(signs, problem.objectives)],
                        axis=1), found.evaluations

    found = {
        "leapmap design": timed(design),
        "random": timed(lambda: random_front(problem, logs_of(path, problem), arguments.random))
    }
    every = np.concatenate([front for front, _, _ in found.values()])
    corner, span = every.max(axis=0), np.ptp(every, axis=0).prod()
    return {
        by: (volume(front_of(front), corner) / span, len(front), solved, seconds)
        for by, (front, solved, seconds) in found.items()
    }


def logs_of(path, problem):
    spec = tomllib.loads(path.read_text())
    axes = [spec["design"].get(name) or spec["scene"][name] for name in problem.names]
    return np.array([axis.get("scale") == "log" for axis in axes])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("questions", nargs="*", type=Path, help="specs (default: those of sweeps/questions)")
    parser.add_argument("--grid", type=float, default=1e8, metavar="DESIGNS")
    parser.add_argument("--slipping", type=float, default=1e6, metavar="DESIGNS")
    parser.add_argument("--made", type=float, default=2e4, metavar="DESIGNS")
    parser.add_argument("--random", type=float, default=1e7, metavar="DESIGNS")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    folder = Path(__file__).resolve().parent.parent / "sweeps" / "questions"
    print(
        "| question | by | found | short; of a front: volume | designs | seconds |\n|---|---|---|---|---|---|"
    )
    beaten = False
    for path in arguments.questions or sorted(folder.glob("*.toml")):
        goal = tomllib.loads(path.read_text())["goal"]
        if len(goal.get("maximize", [])) + len(goal.get("minimize", [])) == 2:
            found = fronts(path, arguments)
            for by, (share, size, solved, seconds) in found.items():
                print(
                    f"| {path.stem} | {by} | {size:,} on the front | {100 * share:.4f} % | {solved:,} | "
                    f"{seconds:.1f} |",
                    flush=True)
            beaten |= found["leapmap design"][0] < found["random"][0]
            continue
        objective, sign, found = rivals(path, arguments)
        best = min(cost for cost, _, _ in found.values())
        for by, (cost, solved, seconds) in found.items():
            told = f"{objective} {sign * cost:.10g}" if cost < 1e29 else "none"
            print(
                f"| {path.stem} | {by} | {told} | {'-' if cost >= 1e29 else f'{cost - best:.1e}'} | "
                f"{solved:,} | {seconds:.1f} |",
                flush=True)
        beaten |= found["leapmap design"][0] > best + 1e-11 * (1 + abs(best))
    sys.exit(1 if beaten else 0)


if __name__ == "__main__":
    main()
