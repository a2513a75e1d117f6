#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw a fit, from the table of leapmap fit DATA.csv --csv FIT.csv: measurements and models over time, and
residuals.

Residuals of a film are in its own unit, for all models on one scale. Events have one bar each, over their
errors.
"""
import csv

import numpy as np

import style
from read_map import NotAMap
from style import plt

COLOURS = {"sticking": "#d95f02", "coulomb": "#1f4e79"}
WORDS = {"sticking": "no slip", "coulomb": "Coulomb friction"}
SHOWN = {
    "phi": "φ", "spin": "spin", "x_P": "x of the mass", "y_P": "y of the mass", "x_O": "x of the centre",
    "y_O": "y of the centre"
}


def read(path):
    """Quantities with their units, models, and columns of numbers by name."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    models = [n.removeprefix("model_") for n in (rows[0] if rows else {}) if n.startswith("model_")]
    if not rows or not {"t", "quantity", "unit", "measured"} <= rows[0].keys() or not models:
        raise NotAMap(f"{path}: is not what leapmap fit --csv writes")
    numbers = lambda name: np.array([float(row[name]) if row[name] else np.nan for row in rows])
    try:
        units = {row["quantity"]: row["unit"] for row in rows}
        names = np.array([row["quantity"] for row in rows])
        return names, units, models, {n: numbers(n) for n in rows[0] if n not in ("quantity", "unit")}
    except (TypeError, ValueError):
        raise NotAMap(f"{path}: is not what leapmap fit --csv writes") from None


def film(quantities, units, models, of):
    names = list(dict.fromkeys(quantities))
    figure, axes = plt.subplots(2 * len(names), 1, sharex=True, figsize=(7.2, 2.6 * len(names) + 1.4),
                                layout="constrained", gridspec_kw={"height_ratios": [2, 1] * len(names)},
                                squeeze=False)
    for k, name in enumerate(names):
        here = quantities == name
        above, below = axes[2 * k, 0], axes[2 * k + 1, 0]
        above.plot(of["t"][here], of["measured"][here], ".", markersize=2, color="#606060", label="measured")
        for model in reversed(models):
            residuals = of[f"residual_{model}"][here]
            above.plot(of["t"][here], of[f"model_{model}"][here], linewidth=1.2, color=COLOURS.get(model),
                       label=f"{WORDS.get(model, model)}")
            below.plot(of["t"][here], residuals, ".", markersize=2, color=COLOURS.get(model))
        largest = max(np.nanmax(np.abs(of[f"residual_{model}"][here])) for model in models)
        below.set_ylim(*(1.1 * max(largest, 1e-12) * np.array([-1, 1])))
        below.axhline(0, color=style.EDGE, linewidth=0.6)
        above.set_ylabel(f"{SHOWN.get(name, name)} [{units[name]}]")
        below.set_ylabel(f"residual\n[{units[name]}]")
    axes[-1, 0].set_xlabel("time in the film [s]")
    axes[0, 0].legend()
    return figure


def events(quantities, units, models, of):
    figure, axis = plt.subplots(figsize=(6.4, 1.2 + 0.6 * len(quantities)), layout="constrained")
    places = np.arange(len(quantities))
    for k, model in enumerate(models):
        axis.barh(places + 0.36 * (k - 0.5 * (len(models) - 1)), of[f"residual_{model}"], 0.32,
                  color=COLOURS.get(model), label=f"{WORDS.get(model, model)}")
    axis.axvline(0, color=style.EDGE, linewidth=0.8)
    axis.axvspan(-1, 1, color="#e8e8e8", zorder=0)
    axis.set_yticks(places, [f"{q} {v:g}" for q, v in zip(quantities, of["measured"])])
    axis.invert_yaxis()
    axis.set_xlabel("model less measured, in standard errors; grey: one")
    axis.legend()
    return figure


def main():
    p = style.parser(__doc__, "what leapmap fit --csv wrote", "_fit")
    arguments = p.parse_args()
    quantities, units, models, of = read(arguments.source)
    draw = events if np.isnan(of["t"]).all() else film
    style.save(draw(quantities, units, models, of), arguments.output)


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
