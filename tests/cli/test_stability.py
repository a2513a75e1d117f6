# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap stability --quick: its table and charts, and the comparison with programs that are not ours."""
import signal
import subprocess

import h5py
import numpy as np
import pytest
import xarray
from support.program import PROGRAM, leapmap, scripted


CASES = ("landing", "needle", "release", "graze", "long", "step", "tolerance", "chaos", "painleve", "slow",
         "dip", "stick", "bounces")
QUICK = tuple(case for case in CASES if case != "painleve")  # which takes longer than all others together
both = pytest.mark.parametrize("table", [QUICK, pytest.param(CASES, marks=pytest.mark.slow)],
                               ids=["quick", "all"], indirect=True)


@pytest.fixture(scope="module")
def table(tmp_path_factory, request):
    folder = tmp_path_factory.mktemp("stability")
    chosen = ("--cases", ",".join(request.param)) if request.param != CASES else ()
    done = leapmap("stability", "--quick", *chosen, "-o", folder / "table.h5")
    assert done.returncode == 0, done.stderr
    return folder / "table.h5", done.stdout, request.param


@both
def test_every_method_has_a_verdict_in_every_case_and_no_default_is_silently_wrong(table):
    path, printed, cases = table
    lines = [line for line in printed.splitlines() if line.startswith(CASES)]
    with xarray.open_dataset(path) as t:
        said = set(zip(t.study.values, t.method.values, t.control.values, t.verdict.values))
        assert len(said) == len(lines)
        for study, method, control, verdict in said:
            assert any([word.strip()
                        for word in (line[:10], line[11:38], line[39:48],
                                     line[50:70])] == [study, method, control, verdict]
                       for line in lines)
        defaults = [v for s, m, c, v in said if m in ("exact", "closed form (leapmap)")]
        assert len(defaults) == len(cases) - 1 and set(defaults) == {"fine"}
        assert {s for s, *_ in said} == set(cases)
        wrong = t.finding == "wrong"
        assert ((t.verdict == "silently wrong")
                | ~wrong).all() and wrong.any(), "a study in which nothing fails shows nothing"


def rows_of(table, cases, path):
    """The table with the rows of some cases alone."""
    with h5py.File(table) as whole, h5py.File(path, "w") as part:
        kept = np.isin(whole["study"].asstr()[()], cases)
        part.attrs.update(whole.attrs)
        for name, column in whole.items():
            part.create_dataset(name, data=column[()][kept], dtype=column.dtype)
            part[name].attrs.update({n: v for n, v in column.attrs.items() if n in ("units", "long_name")})
        part["row"].make_scale("row")
        for name in part.keys() - {"row"}:
            part[name].dims[0].attach_scale(part["row"])
    return path


@both
def test_charts_of_the_cases_show_the_verdicts(table, tmp_path):
    cases = CASES if table[2] == CASES else ("landing", "stick")
    done = scripted("stability_chart.py", rows_of(table[0], cases, tmp_path / "table.h5"), "-o",
                    tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    assert "wrong, silent" in (tmp_path / "chart.svg").read_text()
    for case in cases:
        drawn = (tmp_path / f"chart_{case}.svg").read_text()
        assert case in drawn and ("closed form" in drawn if case == "landing" else "gsl-rk8pd" in drawn), case


@pytest.mark.slow
def test_scipy_and_boost_solve_the_same_designs_and_stand_on_the_same_chart(tmp_path):
    done = scripted("rivals.py", "--quick", "--designs", 4, "-o", tmp_path / "rivals")
    assert done.returncode == 0, done.stderr
    with h5py.File(tmp_path / "rivals.h5") as t:
        method, setting = t["method"].asstr()[()], t["setting"][()]
        for rival in ("Boost.odeint, dopri5", "scipy, DOP853", "leapmap, gsl-rk8pd"):
            rows = np.flatnonzero(method == rival)
            tightest = rows[np.argmin(setting[rows])]
            # Three programs that share no code agree: within some hundred times the tightest tolerance, 1e-11
            # or less.
            assert t["max_height_error"][tightest] < 1e-8 and t["wrong"][tightest] == 0, rival
    drawn = (tmp_path / "rivals_time.svg").read_text()
    assert "scipy" in drawn and "Boost" in drawn and "leapmap, exact, SIMD lanes" in drawn


def test_a_thorough_run_that_is_interrupted_leaves_the_quick_table(tmp_path):
    table = tmp_path / "table.h5"
    process = subprocess.Popen(
        [PROGRAM, "stability", "--thorough", "--cases", "needle,long", "-o", table], stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True)
    for line in process.stdout:
        if line.startswith("thorough now"):
            break
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=60)[1] == f"leapmap: interrupted; {table} holds the quick run\n"
    assert process.returncode == 130
    with xarray.open_dataset(table) as t:
        assert t.attrs["quick"] == 1 and set(t.study.values) == {"needle", "long"}
