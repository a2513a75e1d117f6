#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the Python module adds to the C++ library: a million designs against the same call in C++, and one
design.

Medians of repeats, C++ and Python in turn. Needs LEAPMAP_BUILD; the C++ side is tests/solve-benchmark of that
build."""
import os
import statistics
import subprocess
import sys
import time

BUILD = os.environ.get("LEAPMAP_BUILD", "build/release")
sys.path.insert(0, os.path.join(BUILD, "python"))
import numpy as np  # noqa: E402

import leapmap  # noqa: E402

REPEATS = 7


def seconds(call, times=1):
    begin = time.perf_counter()
    for _ in range(times):
        call()
    return (time.perf_counter() - begin) / times


def main():
    slope, mass = np.linspace(0.1, 0.8, 1000)[:, None], np.geomspace(0.5, 10, 1000)
    runs = {"python": [], "C++": []}
    one = {"python": [], "C++": []}
    for _ in range(REPEATS):
        runs["python"].append(seconds(lambda: leapmap.solve(slope=slope, mass_ratio=mass)))
        one["python"].append(seconds(lambda: leapmap.solve(slope=0.4), 200))
        words = subprocess.run([os.path.join(BUILD, "tests", "solve-benchmark")], check=True,
                               capture_output=True, text=True).stdout.split()
        runs["C++"].append(float(words[0]))
        one["C++"].append(float(words[1]))
    many, single = ({k: statistics.median(v) for k, v in r.items()} for r in (runs, one))
    print(
        f"a million designs: C++ {many['C++']:.3f} s, Python {many['python']:.3f} s, "
        f"{many['python'] / many['C++'] - 1:+.1%}"
    )
    print(f"one design: C++ {single['C++'] * 1e6:.1f} us, Python {single['python'] * 1e6:.1f} us, "
          f"overhead {(single['python'] - single['C++']) * 1e6:.1f} us")


if __name__ == "__main__":
    main()
