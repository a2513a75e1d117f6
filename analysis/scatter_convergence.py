#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the error of a yield against the number of manufactured hoops, for the design and the tolerances of a
spec.

Compares leapmap's Sobol' points in 16 replicates with pseudo-random numbers, both against a yield of 2^20
hoops: root mean square over seeds, fitted slopes, and the error that leapmap reports. Needs leapmap's Python
module: PYTHONPATH=build/release/python."""
import numpy as np

import style
from read_map import NotAMap
from style import plt

MOST = 1 << 20
COUNTS = [16 << k for k in range(1, 13)]


def yields(leapmap, spec, goals, samples, seed):
    """The yield and its stated error, from a map of the one design."""
    m = leapmap.sweep(spec, in_memory=True, samples=samples, seed=seed, audit=0,
                      fields=["yield", "yield_error"], **goals)
    return float(m["yield"].values.ravel()[0]), float(m["yield_error"].values.ravel()[0])


def main():
    p = style.parser(__doc__, "a spec of one design with [scatter] and [goal]", "_convergence")
    p.add_argument("--seeds", type=int, default=32,
                   help="number of seeds for each number of hoops (default: %(default)s)")
    p.add_argument("--at-least", type=float, metavar="HEIGHT",
                   help="goal of jump_height, instead of the spec's")
    arguments = p.parse_args()
    goals = {} if arguments.at_least is None else {"goal.jump_height": {"at_least": arguments.at_least}}
    leapmap = style.leapmap_module()
    try:
        made = leapmap.scatter(arguments.source, samples=32, **goals)
        truth, _ = yields(leapmap, arguments.source, goals, MOST, 12345)
    except (ValueError, OSError) as error:
        raise NotAMap(str(error)) from None
    if not 0 < truth < 1:
        raise NotAMap(
            f"{arguments.source}: its yield is {truth:g}, and nothing converges; allowed: goals that some "
            "hoops reach"
        )
    spread = np.sqrt(truth * (1 - truth))
    rng = np.random.default_rng(1)
    sobol, stated, plain = [], [], []
    for n in COUNTS:
        told = np.array(
            [yields(leapmap, arguments.source, goals, n, seed) for seed in range(1, arguments.seeds + 1)])
        sobol.append(np.sqrt(np.mean((told[:, 0] - truth) ** 2)))
        stated.append(np.sqrt(np.mean(told[:, 1] ** 2)))
        # Whether a hoop reaches every goal is one throw of a coin: pseudo-random numbers need no hoops for
        # that.
        plain.append(np.sqrt(np.mean((rng.binomial(n, truth, 1000) / n - truth) ** 2)))
    figure, axis = plt.subplots(figsize=(6.0, 4.6), layout="constrained")
    for errors, colour, mark, words in ((plain, "#b2182b", "o", "pseudo-random"),
                                        (sobol, "#1f4e79", "s", "Sobol' in 16 replicates")):
        slope = np.polyfit(np.log(COUNTS), np.log(errors), 1)[0]
        axis.loglog(COUNTS, errors, mark, color=colour, label=f"{words}: error falls as n$^{{{slope:.2f}}}$")
        axis.loglog(COUNTS, np.exp(np.polyval(np.polyfit(np.log(COUNTS), np.log(errors), 1), np.log(COUNTS))),
                    color=colour, linewidth=0.8)
        print(f"{words}: slope {slope:.3f}, error {errors[5]:.2e} at {COUNTS[5]:,} hoops")
    axis.loglog(COUNTS, stated, ":", color="#1f4e79", label="error that leapmap reports")
    axis.set_xlabel("number of manufactured hoops")
    axis.set_ylabel("error of the yield")
    axis.set_title(
        f"yield {truth:.4f}, {len(made['cut_off'])} tolerances, {arguments.seeds} seeds each; one hoop "
        f"spreads by {spread:.2f}"
    )
    axis.legend(frameon=False)
    axis.grid(alpha=0.3)
    style.save(figure, arguments.output)


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
