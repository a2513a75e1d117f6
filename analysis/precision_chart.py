#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw speed against accuracy, from the table that leapmap precision writes: five charts.

OUTPUT_time, OUTPUT_work: error of the jump's height against time and work for one design, one line for each
method; lower left is better. Rings: some designs are silently wrong at that setting. Crosses: some designs
failed. The error is that of the others. OUTPUT_wrong: fraction of wrong designs against the tolerance.
OUTPUT_order: error of the time against the fixed step, with the fitted and the theoretical order.
OUTPUT_model: cost of models with more coordinates than rolling needs, and the drift of their constraints."""
import textwrap

import numpy as np

import style
from read_map import NotAMap, read_table
from style import plt

FLOOR = 1e-17  # where an error of exactly 0 is drawn
COLOURS = {
    "exact": "#000000", "gsl-rk8pd": "#1f77b4", "gsl-rkck": "#17becf", "gsl-rkf45": "#2ca02c",
    "gsl-rk4": "#bcbd22", "gsl-rk2": "#ff7f0e", "gsl-msadams": "#8c564b", "gsl-msbdf": "#c49c94",
    "gsl-bsimp": "#9467bd", "gsl-rk4imp": "#e377c2", "gsl-rk2imp": "#f7b6d2", "gsl-rk1imp": "#c5b0d5",
    "euler": "#7f7f7f", "semi-implicit-euler": "#556b2f", "velocity-verlet": "#b8860b"
}


LEAST = ("energy integral", "one coordinate")  # models no larger than rolling needs


def series(t, designs, control):
    """(method, its rows in the table's order), of those designs and that control, on the least models."""
    here = (t.fields["designs"] == designs) & (t.fields["control"] == control) & np.isin(
        t.fields["model"], LEAST)
    for method in dict.fromkeys(t.fields["method"][here]):
        yield method, np.flatnonzero(here & (t.fields["method"] == method))


CONTROLS = {"tolerance": ("-", "o", "steps as a tolerance asks"), "step": (":", "s", "fixed steps")}


def draw_methods(axis, t, designs, across, control):
    """Error over time or work, of the methods with that control; exact beside them for comparison."""
    error = np.maximum(t.fields["max_height_error"], FLOOR)
    x = 1e6 * t.fields[across] if across == "seconds" else t.fields[across]
    line, marker, _ = CONTROLS[control]
    drawn = list(series(t, designs, control))
    if control == "step":
        drawn = [row for row in series(t, designs, "tolerance") if row[0] == "exact"] + drawn
    for method, rows in drawn:
        axis.plot(x[rows], error[rows], linestyle="-" if method == "exact" else line, marker=marker,
                  markersize=3.5, linewidth=2.4 if method == "exact" else 1.3, color=COLOURS.get(
                      method, "#444444"), label=method)
        for mark, share, size in (("o", "wrong", 9), ("x", "failed", 8)):
            bad = rows[(t.fields[share][rows] > 0) & np.isfinite(error[rows])]
            axis.plot(x[bad], error[bad], mark, markersize=size, markerfacecolor="none", color=style.MARK,
                      markeredgewidth=0.9)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.grid(alpha=0.25)
    axis.annotate("better", xy=(0.03, 0.03), xytext=(0.14, 0.14), xycoords="axes fraction", fontsize=8,
                  arrowprops=dict(arrowstyle="->", color=style.EDGE))


def methods_chart(t, across, label):
    """A row for methods whose steps a tolerance sets and one for fixed steps, so that each has a dozen lines
    at most."""
    titles = {
        "random": f"{t.attributes['random_designs']} random designs (seed {t.attributes['seed']})",
        "paper": "the paper's hoop", "given": "the designs given"
    }
    sets = list(dict.fromkeys(t.fields["designs"]))
    controls = [control for control in CONTROLS if (t.fields["control"] == control).any()]
    figure, axes = plt.subplots(len(controls), len(sets), sharex="col", sharey=True, squeeze=False,
                                figsize=(3.4 + 4.8 * len(sets), 1.0 + 4.3 * len(controls)),
                                layout="constrained")
    for k, control in enumerate(controls):
        for axis, designs in zip(axes[k], sets):
            draw_methods(axis, t, designs, across, control)
            axis.set_title(f"{titles[designs]}: {CONTROLS[control][2]}")
        handles, labels = axes[k, 0].get_legend_handles_labels()
        handles += [
            plt.Line2D([], [], marker="o", linestyle="", markersize=9, markerfacecolor="none",
                       color=style.MARK),
            plt.Line2D([], [], marker="x", linestyle="", markersize=8, color=style.MARK)
        ]
        axes[k, -1].legend(handles, labels + ["some designs silently wrong", "some designs failed"],
                           loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False)
    figure.supxlabel(label, fontsize=9)
    figure.supylabel("largest error of the jump's height [hoop diameters]", fontsize=9)
    return figure


def wrong_chart(t):
    figure, axis = plt.subplots(figsize=(7.2, 4.4), layout="constrained")
    nothing_wrong = []
    for method, rows in series(t, t.fields["designs"][0], "tolerance"):
        wrong, failed = (100 * t.fields[k][rows] for k in ("wrong", "failed"))
        if not (wrong + failed).any():
            nothing_wrong.append(method)
            continue
        colour = COLOURS.get(method, "#444444")
        axis.plot(t.fields["setting"][rows], wrong, "-o", markersize=4, color=colour,
                  label=f"{method}, silently wrong")
        axis.plot(t.fields["setting"][rows], failed, ":x", markersize=5, color=colour,
                  label=f"{method}, failed")
    axis.set_xscale("log")
    axis.set_xlabel("tolerance")
    axis.set_ylabel("designs [%]")
    axis.set_title(
        textwrap.fill("no design wrong or failed at any tolerance: " + (", ".join(nothing_wrong) or "none"),
                      90))
    axis.grid(alpha=0.25)
    if axis.lines:
        axis.legend(frameon=False)
    return figure


def fitted_order(steps, errors):
    """Slope of the log-log line through the three smallest steps whose errors rounding does not reach; NaN
    without two."""
    use = np.flatnonzero(np.isfinite(errors) & (errors > 1e-12))[-3:]  # the table's steps become smaller
    return np.polyfit(np.log(steps[use]), np.log(errors[use]), 1)[0] if len(use) > 1 else np.nan


def order_chart(t):
    figure, axis = plt.subplots(figsize=(8.4, 5.2), layout="constrained")
    for method, rows in series(t, t.fields["designs"][-1], "step"):
        steps, errors = t.fields["setting"][rows], t.fields["max_time_error"][rows]
        order = fitted_order(steps, errors)
        fitted = "no fit" if np.isnan(order) else f"{order:.1f}"
        axis.plot(steps, np.maximum(errors, FLOOR), "-o", markersize=4, color=COLOURS.get(method, "#444444"),
                  label=f"{method}: order {fitted}, in theory {t.fields['order'][rows[0]]:.0f}")
    axis.set_xscale("log", base=2)
    axis.set_yscale("log")
    axis.set_xlabel("step [√(R/g)]; a gap: the method failed there")
    axis.set_ylabel("relative error of the jump's time")
    axis.set_title(
        f"designs: {t.fields['designs'][-1]}; fixed steps, orders fitted to the three smallest above rounding"
    )
    axis.grid(alpha=0.25)
    axis.legend(frameon=False, loc="lower right")
    return figure


MODELS = {  # colour, and what it is
    "energy integral": ("#000000", "exact: energy integral, no slip"),
    "one coordinate": ("#1f77b4", "φ integrated by (10)"),
    "multipliers": ("#2ca02c", "x, y, φ of (7)-(9), two multipliers"),
    "multipliers, projected": ("#98df8a", "the same, projected after every step"),
    "centre of mass": ("#d62728", "centre of mass and φ, two multipliers"),
    "centre of mass, projected": ("#ff9896", "the same, projected after every step")}


def model_chart(t):
    figure, (errors, drifts) = plt.subplots(1, 2, figsize=(12.0, 5.0), layout="constrained")
    best = np.isin(t.fields["method"], ("exact", "gsl-rk8pd")) & (t.fields["control"] == "tolerance") & (
        t.fields["designs"] == t.fields["designs"][0])
    for model, (colour, label) in MODELS.items():
        rows = np.flatnonzero(best & (t.fields["model"] == model))
        errors.plot(1e6 * t.fields["seconds"][rows], np.maximum(t.fields["max_height_error"][rows], FLOOR),
                    "-o", markersize=4, color=colour, label=label)
        if np.isfinite(t.fields["drift"][rows]).any():
            drifts.plot(t.fields["setting"][rows], np.maximum(t.fields["drift"][rows], FLOOR), "-o",
                        markersize=4, color=colour, label=label)
    for axis in (errors, drifts):
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.grid(alpha=0.25)
        axis.legend(frameon=False, loc="best")
    errors.set_xlabel("time for one design on one thread [µs]; better: left and down")
    errors.set_ylabel("largest error of the jump's height [hoop diameters]")
    errors.set_title("by model: exact, and gsl-rk8pd at tolerances from 1e-3 on")
    drifts.set_xlabel("tolerance")
    drifts.set_ylabel("largest violation of a constraint [R, √(gR)]")
    drifts.set_title("the paper's constraints are linear and drift by rounding only; curved ones drift")
    return figure


def main():
    p = style.parser(__doc__, "a table of leapmap precision, for example maps/precision.h5", "")
    arguments = p.parse_args()
    t = read_table(arguments.source, "leapmap precision")
    output = style.stem(arguments.output)
    style.save(methods_chart(t, "seconds", "time for one design on one thread [µs]"), f"{output}_time")
    if np.isfinite(t.fields["evaluations"]).any():
        style.save(
            methods_chart(t, "evaluations",
                          "right-hand sides for one design (exact asks for none, and is not here)"),
            f"{output}_work")
    if not np.isin(t.fields["model"], LEAST).all():
        style.save(model_chart(t), f"{output}_model")
    style.save(wrong_chart(t), f"{output}_wrong")
    if (t.fields["control"] == "step").any():
        style.save(order_chart(t), f"{output}_order")


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
