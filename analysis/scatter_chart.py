#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the distribution of one manufactured design, from the output of leapmap hop SPEC.toml --scatter
--json.

The argument is a file, or - for standard input. Above: histograms of height and time of the hoops that jump,
with goals and quantiles. Below: the fraction of the variance of yield, height and time that is due to each
tolerance. Bars: total Sobol' indices; filled: first order; whiskers: 95 % intervals."""
import json
import sys

import numpy as np

import looks
import style
from read_map import NotAMap
from style import plt

OF_WORDS = {
    "yield": "reaching every goal", "jumps": "jumping at all", "jump_height": "the height of those that jump",
    "jump_time": "the time of those that jump"
}
COLOURS = {"yield": "#3b528b", "jumps": "#5ec962", "jump_height": "#21918c", "jump_time": "#b8860b"}
BEYOND = "#d9d9d9"


def read(path):
    """The scatter of a hop's JSON, and its design."""
    try:
        with (open(path, encoding="utf-8") if path != "-" else sys.stdin) as file:
            told = json.load(file)
        design, scatter = told["design"], told["scatter"]
        assert scatter["quantities"].keys() >= {"jump_height", "jump_time"} and scatter["spreads"]
    except (KeyError, TypeError, ValueError, AssertionError):
        raise NotAMap(f"{path}: is not what leapmap hop SPEC.toml --scatter --json prints") from None
    return told, design, scatter


def share(estimate):
    return f"{100 * estimate['value']:.1f} ± {196 * estimate['error']:.1f} %"


def draw_histogram(axis, scatter, name):
    of, look = scatter["quantities"][name], looks.LOOKS[name]
    axis.set_xlabel(look.title)
    axis.set_yticks([])
    counts = np.array(of["histogram"]["counts"])
    if not counts.size:
        axis.text(0.5, 0.5, "no hoop jumps", transform=axis.transAxes, ha="center")
        return
    low, high = of["histogram"]["from"], of["histogram"]["to"]
    edges = np.linspace(low, high if high > low else low + 1e-9, counts.size + 1)
    goal = scatter["goals"].get(name, {})
    least, most = (goal.get(k) for k in ("at_least", "at_most"))
    middles = (edges[1:] + edges[:-1]) / 2
    reached = (middles >= (-np.inf if least is None else least)) & (middles <=
                                                                    (np.inf if most is None else most))
    axis.bar(edges[:-1], counts, np.diff(edges), align="edge", color=np.where(reached, COLOURS[name], BEYOND),
             edgecolor="white", linewidth=0.3)
    for bound, words in ((least, "goal: at least"), (most, "goal: at most")):
        if bound is not None:
            axis.axvline(bound, color=style.MARK, linewidth=1.5, label=f"{words} {bound:g}")
    for quantile, dashes in (("q05", ":"), ("q50", "-"), ("q95", ":")):
        axis.axvline(of[quantile]["value"], color=style.EDGE, linestyle=dashes, linewidth=1.0)
    axis.plot([], [], color=style.EDGE, label=f"median {of['q50']['value']:.4g}")
    axis.plot([], [], ":", color=style.EDGE,
              label=f"5 and 95 %: {of['q05']['value']:.4g}, {of['q95']['value']:.4g}")
    axis.margins(x=0.02)
    axis.legend(frameon=False, loc="upper left", fontsize=7)


def draw_tornado(axis, scatter, of, order):
    """The tolerances in one order for all, the one that brings most on top."""
    importance = scatter["importance"][of]
    number = lambda estimate, key: np.nan if estimate[key] is None else estimate[key]
    rows = np.arange(len(order))[::-1]
    totals, firsts = ([importance[kind][k] for k in order] for kind in ("total", "first"))
    for estimates, height, colour, filled in ((totals, 0.7, COLOURS[of], False), (firsts, 0.7, COLOURS[of],
                                                                                  True)):
        values = np.array([number(e, "value") for e in estimates])
        axis.barh(rows, np.clip(values, 0, None), height, color=colour if filled else "none",
                  edgecolor=colour, alpha=0.75 if filled else 1.0)
    for row, estimate in zip(rows, totals):
        if np.isfinite(number(estimate, "error")):
            axis.errorbar(number(estimate, "value"), row, xerr=1.96 * number(estimate, "error"), fmt="none",
                          ecolor=style.EDGE, capsize=2, elinewidth=0.8)
    axis.set_xlim(0, 1.15)
    axis.set_yticks(rows, [looks.parameter(k)[0].split(" [")[0] for k in order])
    axis.set_xlabel("fraction of the variance")
    axis.set_title(f"of {OF_WORDS[of]}" +
                   (f"\n(among pairs that both jump: {100 * importance['pairs']:.0f} %)"
                    if importance["pairs"] < 1 else ""))
    if not np.isfinite([number(e, "value") for e in totals]).any():
        axis.text(0.5, 0.5, "nothing varies", transform=axis.transAxes, ha="center", va="center")


def chart(told, design, scatter):
    drawn = [of for of in ("yield", "jump_height", "jump_time") if of in scatter["importance"]]
    of = drawn[0]
    key = lambda k: -(scatter["importance"][of]["total"][k]["value"] or 0)
    order = sorted(scatter["spreads"], key=key)
    figure = plt.figure(figsize=(11, 6.2), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=(1.15, 1))
    for axis, name in zip(above.subplots(1, 2), ("jump_height", "jump_time")):
        draw_histogram(axis, scatter, name)
    for axis, name in zip(below.subplots(1, len(drawn), sharey=True), drawn):
        draw_tornado(axis, scatter, name, order)
    words = [
        looks.titled(k, v)
        for k, v in design.items()
        if k in ("slope", "mass_ratio", "offset_ratio", "mu_static") and v is not None
    ]
    words.append("Coulomb friction" if told["scene"]["friction"] == "coulomb" else "no slip")
    title = f"{scatter['samples']:,} manufactured hoops: " + (f"{share(scatter['yield'])} reach every goal, "
                                                              if scatter["goals"] else
                                                              "") + f"{share(scatter['jumps'])} jump (± 95 %)"
    above.suptitle(title + "\n" + ", ".join(words), fontsize=10)
    tolerances = [
        looks.spread(k, s["law"], s["width"], s["percent"]) +
        (f" (to {100 * s['shrink']:.0f} % of it for 99 %)" if s["shrink"] and s["shrink"] < 1 else "")
        for k, s in scatter["spreads"].items()
    ]
    if scatter["shrink_all"] is not None and 0 < scatter["shrink_all"] < 1:
        tolerances.append(f"for 99 % all shrink to {100 * scatter['shrink_all']:.0f} %")
    figure.supxlabel(
        style.wrapped(tolerances, figure) +
        "\nbars: total Sobol' index, filled: the parameter by itself, whiskers: 95 % of the total; grey: "
        "misses a goal",
        fontsize=8)
    return figure


def main():
    p = style.parser(__doc__, "the JSON, or - for standard input", "_scatter")
    arguments = p.parse_args()
    style.save(chart(*read(arguments.source)),
               "scatter" if arguments.output == "-_scatter" else arguments.output)


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
