#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare leapmap with other programs, on the same designs in the same run.

The others are scipy's DOP853 with events, and Boost.odeint's dopri5 with dense output
(analysis/boost_rival.cpp, compiled here). OUTPUT.h5 is the table. OUTPUT_time is the chart: error of the
jump's height against time for one design on one thread. The reference is leapmap's exact method at 1e-13.
Needs Debian's python3-scipy, libboost-dev and g++."""
import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np
from scipy import integrate, optimize

import style
from precision_chart import FLOOR
from read_map import read_table
from style import plt

FOLDER = Path(__file__).resolve().parent
PROGRAM = os.environ.get("LEAPMAP", FOLDER.parent / "build" / "release" / "leapmap")
RUNWAY, HOP_HEIGHT = 4.0, 0.05
TOLERANCES = 10.0 ** -np.arange(3.0, 13.5)
FAILED = 6
REPEATS = 3  # the least counts
sys.path.append(str(Path(PROGRAM).parent / "python"))  # the module of the same build
NUDGE = 1e-9  # [sqrt(R/g)]; its square is below all rounding


NAMES = {"exact": "exact, SIMD lanes"}


class NotThere(Exception):
    """A program or package that the comparison needs is missing."""


def run(*command, text=None):
    try:
        done = subprocess.run([str(word) for word in command], input=text, capture_output=True, text=True)
    except FileNotFoundError:
        raise NotThere(
            f"{command[0]}: is not there; build leapmap, and install g++, libboost-dev and python3-scipy"
        ) from None
    if done.returncode:
        raise NotThere(f"{command[0]}: {done.stderr.strip()}")
    return done.stdout


def flight_height(rho, cos_slope, phi, w):
    """Apex of the first interval with y > 0 [diameters], by samples and a bounded minimiser."""
    speed = rho * np.sin(phi) * w

    def y(t):
        return -rho * np.cos(phi) + speed * t - 0.5 * cos_slope * t**2 + rho * np.cos(phi + w * t)
    last = (speed + np.sqrt(speed**2 + 4 * cos_slope * rho)) / cos_slope
    t = np.linspace(0, last, int(50 * last * (1 + w)) + 10)[1:]
    heights = y(t)
    above = np.flatnonzero(heights > 1e-12)
    if not len(above):
        return 0.0
    landed = np.flatnonzero(heights[above[0]:] <= 0)
    end = above[0] + landed[0] if len(landed) else len(t)
    top = above[0] + np.argmax(heights[above[0]:end])
    best = optimize.minimize_scalar(lambda s: -y(s), bounds=(t[top] - t[0], t[top] + t[0]), method="bounded",
                                    options={"xatol": 1e-10})
    return 0.5 * max(heights[top], -best.fun)


def solve_by_scipy(slope, beta, lam, tolerance):
    """(status, spurious, candidates, height, time): rolls from lift-off to lift-off, each a terminal
    event."""
    alpha = beta / (1 + beta)
    rho, J0, sn, cs = alpha * lam, 1 / (1 + beta) + alpha * lam**2, np.sin(slope), np.cos(slope)

    def acceleration(phi, w):
        s, c = np.sin(phi), np.cos(phi)
        return (sn - rho * (sn * c + cs * s) - rho * s * w * w) / (J0 + 1 - 2 * rho * c)

    def rhs(t, y):
        return y[1], acceleration(*y)

    def force(t, y):
        return cs + rho * (np.sin(y[0]) * acceleration(*y) + np.cos(y[0]) * y[1] ** 2)

    def runway(t, y):
        return y[0] - np.pi - 2 * np.pi * RUNWAY

    def stall(t, y):
        return y[1]
    force.terminal = runway.terminal = stall.terminal = True
    force.direction = stall.direction = -1
    t, y, candidates, spurious = 0.0, (np.pi, 0.0), 0, 255
    while True:
        part = integrate.solve_ivp(rhs, (t, 1e4), y, method="DOP853", rtol=max(tolerance, 3e-14),
                                   atol=tolerance, events=(force, runway, stall))
        if part.status != 1:
            return FAILED, spurious, candidates, np.nan, np.nan
        if not len(part.t_events[0]):
            return 2 if len(part.t_events[1]) else 3, spurious, candidates, np.nan, np.nan
        t, y = part.t_events[0][0], part.y_events[0][0]
        height = flight_height(rho, cs, *y)
        candidates += 1
        spurious = spurious if candidates > 1 else int(height < HOP_HEIGHT)
        if height >= HOP_HEIGHT:
            return 1, spurious, candidates, height, t
        y = y + NUDGE * np.array(rhs(t, y))  # past the event, which would fire again at its own root
        t += NUDGE


def errors(answers, truth):
    """(largest error of height, of time, shares wrong and failed), as leapmap precision has them."""
    answers = np.asarray(answers)
    failed = answers[:, 0] == FAILED
    same = (answers[:, :3] == truth[:, :3]).all(axis=1) & ~failed
    jumped = same & (truth[:, 0] == 1)
    height = time_ = np.nan
    if jumped.any():
        height = np.abs(answers[jumped, 3] - truth[jumped, 3]).max()
        time_ = np.abs(answers[jumped, 4] / truth[jumped, 4] - 1).max()
    return height, time_, (~same & ~failed).mean(), failed.mean()


def measure(designs, folder, quick):
    """Rows of method, setting, seconds, errors of height and time, shares wrong and failed."""
    tolerances = TOLERANCES[::3] if quick else TOLERANCES
    np.savetxt(folder / "designs.csv", designs, delimiter=",", header="slope,mass_ratio,offset_ratio",
               comments="", fmt="%.17g")
    import leapmap  # here: only a measurement needs it

    slope, mass_ratio, offset_ratio = designs.T
    o = leapmap.solve(slope=slope, mass_ratio=mass_ratio, offset_ratio=offset_ratio, runway=RUNWAY,
                      tolerance=1e-13, radius=1, gravity=1)
    truth = np.stack([o.status, o.spurious_first_jump, o.candidates, o.jump_height, o.jump_time],
                     axis=1).astype(float)

    run(PROGRAM, "precision", "--points", folder / "designs.csv", "--methods", "exact,gsl-rk8pd,gsl-rkck",
        "-o", folder / "precision.h5", *([] if quick else ["--thorough"]))
    ours = read_table(folder / "precision.h5", "leapmap precision").fields
    rows = [(f"leapmap, {NAMES.get(m, m)}", s, t, h, e, w, f)
            for m, c, s, t, h, e, w, f in zip(*(ours[k] for k in ("method", "control", "setting", "seconds",
                                                                  "max_height_error", "max_time_error",
                                                                  "wrong", "failed")))
            if c == "tolerance"]

    run("g++", "-std=c++17", "-O3", "-march=native", "-o", folder / "boost_rival", FOLDER / "boost_rival.cpp")
    text = "\n".join(" ".join(f"{value:.17g}" for value in design) for design in designs)
    for tolerance in tolerances:
        lines = run(folder / "boost_rival", repr(float(tolerance)), REPEATS, text=text).split("\n")
        answers = [[float(word) for word in line.split()] for line in lines[:len(designs)]]
        rows.append(("Boost.odeint, dopri5", tolerance, float(lines[len(designs)]) / len(designs),
                     *errors(answers, truth)))
    solve_by_scipy(*designs[0], 1e-6)  # warm
    for tolerance in tolerances:
        least = np.inf
        for _ in range(REPEATS):
            begin = time.perf_counter()
            answers = [solve_by_scipy(*design, tolerance) for design in designs]
            least = min(least, time.perf_counter() - begin)
        rows.append(("scipy, DOP853", tolerance, least / len(designs), *errors(answers, truth)))
    return rows


def write(rows, path, count, seed):
    texts, numbers = [r[0] for r in rows], np.array([r[1:] for r in rows], float)
    with h5py.File(path, "w") as table:
        table.attrs.update(filetype="leapmap rivals", title="leapmap beside scipy and Boost.odeint",
                           designs=count, seed=seed)
        table.create_dataset("method", data=texts, dtype=h5py.string_dtype())
        for column, (name, about) in enumerate({
                "setting": "tolerance", "seconds": "for one design on one thread",
                "max_height_error": "of the jump's height, in hoop diameters",
                "max_time_error": "of jump_time, relative",
                "wrong": "fraction of designs that are silently wrong", "failed": "fraction that failed"
        }.items()):
            table[name] = numbers[:, column]
            table[name].attrs["long_name"] = about


def chart(path):
    with h5py.File(path) as table:
        fields = {k: (v.asstr()[()] if k == "method" else v[()]) for k, v in table.items()}
        count = table.attrs["designs"]
    figure, axis = plt.subplots(figsize=(9.0, 5.4), layout="constrained")
    colours = dict(
        zip(dict.fromkeys(fields["method"]), ("#000000", "#17becf", "#1f77b4", "#2ca02c", "#ff7f0e")))
    for method, colour in colours.items():
        rows = fields["method"] == method
        x, y = 1e6 * fields["seconds"][rows], np.maximum(fields["max_height_error"][rows], FLOOR)
        axis.plot(x, y, "-o", markersize=4, color=colour, label=method)
        for share, mark in (("wrong", "o"), ("failed", "x")):
            bad = fields[share][rows] > 0
            axis.plot(x[bad], y[bad], mark, markersize=9, markerfacecolor="none", color=style.MARK)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.grid(alpha=0.25)
    axis.set_xlabel("time for one design on one thread [µs]; better: left and down")
    axis.set_ylabel("largest error of the jump's height [hoop diameters]")
    axis.set_title(
        f"{count} random designs, tolerances from 1e-3 on; rings: some designs silently wrong, crosses: some "
        "failed"
    )
    axis.legend(frameon=False)
    return figure


def main():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("-o", "--output", default="maps/rivals",
                   help="file name without ending (default: %(default)s)")
    p.add_argument("--designs", type=int, default=40, help="random ones (default: %(default)s)")
    p.add_argument("--seed", type=int, default=1, help="of the designs (default: %(default)s)")
    p.add_argument("--quick", action="store_true", help="fewer tolerances")
    arguments = p.parse_args()
    random = np.random.default_rng(arguments.seed)
    designs = random.uniform((0.1, 0.5, 0.3), (0.8, 10.0, 1.0), (arguments.designs, 3))
    output = style.stem(arguments.output)
    os.makedirs(os.path.dirname(output) or ".", exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        rows = measure(designs, Path(folder), arguments.quick)
    print(
        "program, method          tolerance   for one design  largest errors: height [diameters], time "
        "[relative]"
    )
    for row in rows:
        print(
            "{:<24} {:>8.0e} {:>12.1f} us  height {:>8.1e}  time {:>8.1e}  wrong {:>5.1f}%  failed {:>5.1f}%".
            format(row[0], row[1], 1e6 * row[2], row[3], row[4], 100 * row[5], 100 * row[6]))
    write(rows, output + ".h5", arguments.designs, arguments.seed)
    print(output + ".h5")
    style.save(chart(output + ".h5"), output + "_time")


if __name__ == "__main__":
    style.run(main, NotThere, ImportError, OSError)
