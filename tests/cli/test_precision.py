# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap precision --quick: its table, which others read, and the charts drawn from it."""
import re

import numpy as np
import pytest
import xarray
from support.program import leapmap, scripted


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    folder = tmp_path_factory.mktemp("precision")
    done = leapmap("precision", "--quick", "--designs", 12, "-o", folder / "table.h5")
    assert done.returncode == 0, done.stderr
    return folder / "table.h5", done.stdout


def test_every_row_printed_is_in_the_table_and_xarray_reads_it(table):
    path, printed = table
    with xarray.open_dataset(path) as t:
        rows = [line.split() for line in printed.splitlines() if line.startswith(("random", "paper"))]
        assert len(rows) == t.sizes["row"]
        assert [r[1] for r in rows] == list(t.method.values)
        assert [float(r[3]) for r in rows] == pytest.approx(list(t.setting.values), rel=0.06)
        assert t.attrs["random_designs"] == 12 and t.attrs["filetype"] == "leapmap precision"
        assert {"exact", "gsl-rk8pd", "gsl-msbdf", "semi-implicit-euler"} <= set(t.method.values)


def test_what_the_study_is_for_holds_in_it(table):
    with xarray.open_dataset(table[0]) as t:
        exact = t.isel(row=np.flatnonzero((t.method == "exact")))
        assert (exact.wrong == 0).all() and (exact.failed == 0).all() and exact.max_height_error.max() < 1e-13
        others = t.isel(row=np.flatnonzero((t.method != "exact") & (t.designs == "random")))
        assert exact.isel(row=np.flatnonzero(
            exact.designs == "random")).max_height_error.max() < others.max_height_error.min()
        assert (exact.seconds > 0).all() and (others.seconds > 0).all()


@pytest.mark.slow  # its twin reads the table
def test_charts_show_every_method(table, tmp_path):
    done = scripted("precision_chart.py", table[0], "-o", tmp_path / "chart")
    assert done.returncode == 0, done.stderr
    drawn = {
        kind: (tmp_path / f"chart_{kind}.svg").read_text()
        for kind in ("time", "work", "wrong", "order", "model")
    }
    for method in ("exact", "gsl-rk8pd", "gsl-bsimp", "velocity-verlet"):
        assert method in drawn["time"], method
    assert "two multipliers" in drawn["model"] and "projected" in drawn["model"]
    for kind in ("time", "work"):
        assert "better" in drawn[kind] and "silently wrong" in drawn[kind]
    assert "in theory 8" in drawn["order"] and re.search(r"tolerance", drawn["wrong"])


def test_a_table_replaces_a_table_but_nothing_else(table, tmp_path):
    (tmp_path / "notes.h5").write_text("precious")
    done = leapmap("precision", "--quick", "--designs", 1, "-o", tmp_path / "notes.h5")
    assert done.returncode == 2 and (tmp_path / "notes.h5").read_text() == "precious"
    other = scripted("design_chart.py", table[0], "-o", tmp_path / "chart")
    assert other.returncode == 2 and "leapmap map" in other.stderr
