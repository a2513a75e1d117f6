#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the cases in which methods fail, from the table that leapmap stability writes: one chart for each
case, and a summary.

OUTPUT_CASE: left, the error along the case, one line for each method with its verdict; rings are silently
wrong answers, crosses reported failures, grey the effect of an ulp of the inputs. Right: work, energy drift,
condition or fraction of wrong designs. OUTPUT: the verdict of every method in every case."""
import numpy as np

import style
from precision_chart import COLOURS, FLOOR
from read_map import NotAMap, read_table
from style import plt

TITLES = {
    "needle": "a mass on the rim of an ever lighter hoop: a narrow spin peak at φ = 0",
    "release": "released ever closer to the unstable equilibrium",
    "graze": "across the fold at which a pair of lift-off and return appears",
    "long": "ever longer runs to the jump",
    "step": "fixed steps, ever longer",
    "tolerance": "tolerances no double can reach",
    "landing": "flights that start on the plane and enter it",
    "chaos": "jump after jump of a hoop that has no stable gait",
    "painleve": "with friction: a slide that barely misses Painlevé's paradox",
    "slow": "with friction: rolled off ever more slowly",
    "dip": "with friction: n₀ of a slide barely touches zero",
    "stick": "with friction: friction barely holds",
    "bounces": "with friction: ever more rebounds",
}
BESIDE = {
    "needle": "evaluations", "release": "condition", "graze": "condition", "long": "energy_drift",
    "step": "share", "tolerance": "evaluations", "chaos": "condition", "painleve": "evaluations",
    "slow": "evaluations", "dip": "condition", "stick": "condition", "bounces": "evaluations"
}
LABELS = {
    "evaluations": "right-hand sides per design",
    "condition": "condition: relative change of the answer over that of the inputs",
    "energy_drift": "energy drift at the jump, over 1 + kinetic energy",
    "share": "designs wrong (solid) or failed (dotted) [%]"
}
VERDICTS = {  # from best to worst
    "fine": "#2ca02c", "loses digits": "#bcbd22", "reports failure": "#9ecae1", "breaks down": "#7f7f7f",
    "silently wrong": "#d62728"
}
EPSILON = np.finfo(float).eps


def series(t, study):
    """(name of the method, its rows, its verdict) in the table's order."""
    names = [f"{m}, fixed" if c == "step" else m for m, c in zip(t.fields["method"], t.fields["control"])]
    here = np.flatnonzero(t.fields["study"] == study)
    for name in dict.fromkeys(names[i] for i in here):
        rows = np.array([i for i in here if names[i] == name])
        yield name, rows, t.fields["verdict"][rows[0]]


def look(name):
    method, _, fixed = name.partition(",")
    return dict(color=COLOURS.get(method, "#444444"), linestyle=":" if fixed else "-",
                linewidth=2.2 if method == "exact" else 1.1)


def along(x, values, summary):
    """Each place's summary of its values, in order of place."""
    places = np.unique(x)
    return places, np.array([summary(values[x == place]) for place in places])


def middle(values):
    values = values[np.isfinite(values)]
    return np.median(values) if len(values) else np.nan


def scale(axis, t, rows):
    """The walk on a log scale; on both sides of a fold a linear stretch without any place joins them."""
    x = t.fields["x"][rows]
    if (x < 0).any():
        axis.set_xscale("symlog", linthresh=np.abs(x).min())
        axis.axvline(0.0, color=style.EDGE, linewidth=0.6)
        ends = 10.0 ** np.arange(-13, 0, 4)
        axis.set_xticks([*-ends, *ends])
    else:
        axis.set_xscale("log")
    if t.fields["study"][rows[0]] in ("release", "tolerance"):
        axis.invert_xaxis()  # into trouble is to the right
    axis.set_xlabel(t.fields["abscissa"][rows[0]])
    axis.grid(alpha=0.25)


def case_chart(t, study):
    figure, (left, right) = plt.subplots(1, 2, figsize=(16.0, 5.6), layout="constrained")
    beside = BESIDE[study]
    everything, crosses = [], 4.0
    for name, rows, verdict in series(t, study):
        everything.extend(rows)
        x, finding = t.fields["x"][rows], t.fields["finding"][rows]
        places, error = along(x, np.maximum(t.fields["error"][rows], FLOOR), middle)
        left.plot(places, error, label=f"{name}: {verdict}", marker=".", markersize=4, **look(name))
        wrong = finding == "wrong"
        if wrong.any():
            # flags wrong: no error to draw
            at = np.where(np.isfinite(t.fields["error"][rows]), t.fields["error"][rows], 1.0)
            left.plot(x[wrong], np.clip(at[wrong], FLOOR,
                                        1.0), "o", markersize=9, markerfacecolor=look(name)["color"],
                      alpha=0.9, markeredgecolor=style.MARK, markeredgewidth=1.2)
        failed = np.unique(x[finding == "failed"])
        if len(failed):
            left.plot(failed, np.full(len(failed), crosses), "x", markersize=5, color=look(name)["color"],
                      markeredgewidth=1.1)
            crosses *= 2.5
        if beside == "share":
            for which, line in (("wrong", "-"), ("failed", ":")):
                right.plot(*along(x, 100.0 * (finding == which), np.mean), line, marker=".", markersize=4,
                           color=look(name)["color"])
        elif beside != "condition":
            places, value = along(x, t.fields[beside][rows], middle)
            right.plot(places, np.maximum(value, FLOOR), marker=".", markersize=4, **look(name))
    everything = np.array(everything)
    places, condition = along(t.fields["x"][everything], t.fields["condition"][everything], middle)
    left.plot(places, EPSILON * (1.0 + condition), color="#bbbbbb", linewidth=5, zorder=0,
              label="what an ulp of the inputs does")
    if beside == "condition":
        right.plot(places, np.maximum(condition, 1e-1), "-o", color=style.EDGE, markersize=4)
        right.set_title(
            "how ill-conditioned the question itself is, whatever the method; 0.1: not at all" if study ==
            "graze" else "how ill-conditioned the question itself is, whatever the method")
    left.set_yscale("log")
    right.set_yscale("linear" if beside == "share" else "log")
    left.set_ylim(top=2.0 * crosses)
    left.set_ylabel("error of height [diameters] or time [relative]")
    left.set_title(
        "red rings: silently wrong (at the top: flags wrong); crosses: reported failures, one row for each "
        "method"
    )
    right.set_ylabel(LABELS[beside])
    for axis in (left, right):
        scale(axis, t, everything)
    figure.suptitle(f"{study}: {TITLES[study]}", fontsize=11)
    right.legend(*left.get_legend_handles_labels(), loc="center left", bbox_to_anchor=(1.02, 0.5),
                 frameon=False)
    return figure


def landing_chart(t):
    figure, axis = plt.subplots(figsize=(11.0, 4.8), layout="constrained")
    for (name, rows, verdict), marker in zip(series(t, "landing"), "o^vsD"):
        x, error = np.maximum(t.fields["x"][rows], 1e-9), np.maximum(t.fields["error"][rows], FLOOR)
        axis.plot(x, error, marker, markersize=5, markerfacecolor="none", label=f"{name}: {verdict}")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.axhline(0.05, color=style.MARK, linewidth=0.8)
    axis.set_xlabel(t.fields["abscissa"][t.fields["study"] == "landing"][0] +
                    "; 1e-9: none, lift-offs out of sliding, a triple root")
    axis.set_ylabel("error of height [diameters] or duration [relative]")
    axis.set_title(f"landing: {TITLES['landing']}; above the red line the jump is lost or invented")
    axis.grid(alpha=0.25)
    axis.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False)
    return figure


def studies_of(t):
    return [study for study in TITLES if (t.fields["study"] == study).any()]


def overview(t):
    studies = studies_of(t)
    names, verdicts = [], {}
    for study in studies:
        for name, _, verdict in series(t, study):
            if name not in names:
                names.append(name)
            verdicts[name, study] = verdict
    figure, axis = plt.subplots(figsize=(2.4 + 0.98 * len(studies), 0.27 * len(names) + 1.6),
                                layout="constrained")
    for row, name in enumerate(names):
        for column, study in enumerate(studies):
            verdict = verdicts.get((name, study))
            if verdict:
                axis.barh(row, 0.96, left=column - 0.48, height=0.9, color=VERDICTS[verdict])
                short = {"silently wrong": "wrong, silent", "reports failure": "reports"}.get(
                    verdict, verdict)
                axis.text(column, row, short, ha="center", va="center", fontsize=7)
    axis.set_yticks(range(len(names)), names)
    axis.set_xticks(range(len(studies)), studies)
    axis.xaxis.tick_top()
    axis.set_xlim(-0.52, len(studies) - 0.48)
    axis.set_ylim(len(names) - 0.45, -0.55)
    axis.tick_params(length=0)
    figure.suptitle(
        "each method's worst in each case" +
        ("; a quick run, which leaves out places" if t.attributes["quick"] else "") + "; empty: not asked",
        fontsize=9)
    for side in axis.spines.values():
        side.set_visible(False)
    return figure


def main():
    p = style.parser(__doc__, "a table of leapmap stability, for example maps/stability.h5", "")
    arguments = p.parse_args()
    t = read_table(arguments.source, "leapmap stability")
    output = style.stem(arguments.output)
    style.save(overview(t), output)
    for study in studies_of(t):
        style.save(landing_chart(t) if study == "landing" else case_chart(t, study), f"{output}_{study}")


if __name__ == "__main__":
    style.run(main, NotAMap, OSError)
