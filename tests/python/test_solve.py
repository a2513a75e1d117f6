# SPDX-License-Identifier: GPL-3.0-or-later
"""leapmap.solve and leapmap.trace against tables made by other programs, and what they refuse."""
import ast
import copy
import csv
import inspect
import multiprocessing
import os
import pickle
import re
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import xarray

import leapmap
from support.program import REFERENCE

# times in sqrt(R/g), as the tables have them
UNIT = {"radius": 1.0, "gravity": 1.0, "motor_in_flight": False}
INPUTS = ("slope", "mass_ratio", "offset_ratio", "inertia_factor", "release_angle", "release_spin")


def table(name):
    with open(REFERENCE / name, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([row[key] for row in rows]) for key in rows[0]}


def numbers(column):
    return np.array([float(text) if text else np.nan for text in column])


@pytest.mark.parametrize(
    "name", ["noslip_top_release.csv", "noslip_general.csv", "noslip_turning.csv", "noslip_drive.csv"])
def test_agrees_with_the_40_digit_tables_without_slip(name):
    t = table(name)
    o = leapmap.solve(**{key: numbers(t[key]) for key in (*INPUTS, "drive_torque") if key in t}, **UNIT)
    assert [leapmap.Status(s).name for s in o.status] == t["status"].tolist()
    assert (np.where(o.spurious_first_jump == 255, -1, o.spurious_first_jump) == np.nan_to_num(
        numbers(t["spurious"]), nan=-1)).all()
    # 1e-10 is the tolerance of times; heights are good to some roundings of the largest term.
    np.testing.assert_allclose(o.jump_time, numbers(t["jump_time"]), rtol=1e-10)
    np.testing.assert_allclose(o.jump_height, numbers(t["jump_height"]), rtol=0, atol=1e-12)
    assert np.isfinite(o.jump_height).sum() > 20


@pytest.mark.parametrize("name, hop_height", [("coulomb_first_liftoff.csv", 0.0),
                                              ("coulomb_multihop.csv", 0.05)])
def test_agrees_with_the_tables_of_coulomb_friction(name, hop_height):
    t = table(name)
    keep = np.ones(len(t["status"]), bool)
    if "multihop" in name:
        keep[69] = False  # its row 70 misses a hop
    given = {key: numbers(t[key])[keep] for key in (*INPUTS, "mu_static", "mu_kinetic", "restitution")}
    o = leapmap.solve(friction="coulomb", hop_height=hop_height, **given, **UNIT)
    assert [leapmap.Status(s).name for s in o.status] == t["status"][keep].tolist()
    letters = [leapmap.phase_letters(s) for s in o.phase_sequence]
    assert [a.strip("-.") for a in letters] == [b[:32] for b in t["sequence"][keep]]
    # The tables have some 9 digits of times and 8 of heights.
    np.testing.assert_allclose(o.jump_time, numbers(t["jump_time"])[keep], rtol=1e-8)
    np.testing.assert_allclose(o.jump_height, numbers(t["jump_height"])[keep], rtol=0, atol=1e-8)


def test_without_arguments_it_is_the_papers_hoop():
    o = leapmap.solve()
    assert o.status == leapmap.Status.jumped
    assert o.jump_height == pytest.approx(0.98280096607011718, abs=1e-12)
    assert o.jump_time == pytest.approx(8.3639138031881432 * np.sqrt(0.041 / 9.81), rel=1e-10)
    assert "jump_height" in repr(o)


def test_arrays_broadcast_in_any_layout_and_agree_with_one_design_at_a_time():
    slope = np.linspace(0.1, 0.8, 7)
    mass = np.geomspace(0.5, 20, 30)[::-2][:, None]  # strides that run backwards
    lever = np.asfortranarray(np.linspace(0.5, 1, 7 * 15).reshape(15, 7)).astype(np.float32)
    o = leapmap.solve(slope=slope, mass_ratio=mass, offset_ratio=lever, inertia_factor=[1.0])
    assert o.jump_height.shape == o.status.shape == (15, 7) and o.status.dtype == np.uint8
    for i, j in [(0, 0), (3, 5), (14, 6)]:
        one = leapmap.solve(slope=slope[j], mass_ratio=mass[i, 0], offset_ratio=float(lever[i, j]))
        assert one.status == o.status[i, j]
        # Heights depend on nothing but the design; lanes and neighbours move them by roundings.
        np.testing.assert_allclose(one.jump_height, o.jump_height[i, j], rtol=1e-13)
    assert leapmap.solve(slope=np.zeros((0, 3))).jump_height.shape == (0, 3)


def test_the_number_of_threads_shows_in_no_bit():
    mass = np.geomspace(0.1, 20, 30_000)
    one, many = leapmap.solve(mass_ratio=mass, threads=1), leapmap.solve(mass_ratio=mass, threads=5)
    assert one.jump_time.tobytes() == many.jump_time.tobytes() and one.dip.tobytes() == many.dip.tobytes()


def test_angles_may_be_texts_and_fields_may_be_chosen():
    assert leapmap.solve(slope="30 deg").jump_height == leapmap.solve(slope=np.pi / 6).jump_height
    o = leapmap.solve(slope=[0.3, 0.4], fields=["jump_height"])
    assert list(o.to_xarray().data_vars) == ["jump_height"]
    with pytest.raises(AttributeError, match="jump_time was not computed: name it in fields"):
        o.jump_time
    with pytest.raises(AttributeError, match="phase_sequence was not computed: it needs friction='coulomb'"):
        leapmap.solve().phase_sequence


@pytest.mark.parametrize("given, says", [
    ({"slope": np.nan}, "slope = nan"),
    ({"offset_ratio": [0.5, 2.0]}, "design 1: offset_ratio = 2"),
    ({"mu_static": 0.4
      }, "mu_static = 0.4 has no effect because the contact never slips .*; allowed: with friction"),
    ({"friction": "glue"}, "friction = 'glue' is not a model; allowed: sticking, coulomb"),
    ({"colour": 3.0}, "colour: unknown parameter; allowed: "),
    ({"slope": "steep"}, "slope = 'steep' is not a number; allowed: .* deg"),
    ({"slope": object()}, "slope = <object object at"),
    ({"slope": True}, "slope = True is not a number"),
    ({"slope": None}, "slope = None is not a number"),
    ({"slope": np.array([0.3 + 0.5j])}, "slope = array.* is not a number"),
    ({"slope": np.ma.array([0.3, 0.4], mask=[0, 1])}, "is not a number"),
    ({"slope": ["0.3"]}, "is not a number"),
    ({"slope": "\udc80"}, "slope"),
    ({"friction": "coulomb", "mu_static": "é" * 100}, "mu_static = "),
    ({"fields": []}, "fields = .* is empty"),
    ({"threads": -3}, "threads = -3 is out of range"),
    ({"threads": "2"}, "threads = '2' is out of range"),
    ({"max_steps": 0.5}, "max_steps = 0.5 is out of range"),
    ({"slope": [0.1, 0.2], "mass_ratio": [1, 2, 3]
      }, r"shapes do not broadcast: slope \(2\), mass_ratio \(3\)"),
    ({"runway": [1.0, 2.0]}, "runway = .* is an array; allowed: one number"),
    ({"runway": -1.0}, "runway = -1"),
    ({"fields": ["height"]}, "fields = height: is not a field of this model; allowed: jump_height"),
    ({"method": "magic"}, "magic"),
    ({"tolerance": 0.0}, "tolerance"),
])
def test_refuses_what_is_no_hoop_naming_parameter_value_and_what_is_allowed(given, says):
    with pytest.raises(ValueError, match=says):
        leapmap.solve(**given)


def test_to_xarray_names_dimensions_after_the_parameter_that_varies_along_them():
    ds = leapmap.solve(slope=0.4, mass_ratio=np.geomspace(0.1, 20, 5)[:, None],
                       offset_ratio=[0.8, 1.0]).to_xarray()
    assert ds.jump_height.dims == ("mass_ratio", "offset_ratio") and ds.attrs["slope"] == 0.4
    assert ds.jump_height.sel(offset_ratio=1.0).shape == (5,)
    both = leapmap.solve(slope=[0.3, 0.4], mass_ratio=[2.0, 3.0]).to_xarray()
    assert both.jump_height.dims == ("dim_0",) and set(both.coords) == {"slope", "mass_ratio"}
    assert both.status.attrs["flag_meanings"].split()[1] == "jumped"
    assert isinstance(leapmap.solve().to_xarray(), xarray.Dataset)


def test_to_xarray_bears_empty_shapes_texts_and_arrays_that_change_later():
    assert leapmap.solve(slope=np.zeros((0, 3))).to_xarray().jump_height.shape == (0, 3)
    slope = np.array([0.3, 0.4])
    o = leapmap.solve(slope=slope, release_angle="180 deg", fields="jump_height")
    slope[:] = 9.0
    ds = o.to_xarray()
    assert ds.slope.values.tolist() == [0.3, 0.4] and ds.attrs["release_angle"] == np.pi


def test_results_can_be_copied_and_pickled():
    for result in (leapmap.solve(slope=[0.3, 0.4]), leapmap.trace().outcome):
        for again in (copy.deepcopy(result), pickle.loads(pickle.dumps(result))):
            np.testing.assert_array_equal(again.jump_height, result.jump_height)
    assert len(pickle.loads(pickle.dumps(leapmap.trace())).t) > 100


def heights_of(slope):
    return leapmap.solve(slope=slope, fields=["jump_height"]).jump_height.sum()


def test_a_forked_process_solves_too():
    slope = np.linspace(0.3, 0.8, 10_000)
    expected = heights_of(slope)  # starts OpenMP's threads, which the children do not have
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(heights_of, [slope, slope]).get(timeout=60) == [expected, expected]


def test_fields_of_packed_structures_are_read():
    packed = np.zeros(5, dtype=[("tag", "u1"), ("slope", "f8")])
    packed["slope"] = np.linspace(0.3, 0.5, 5)
    np.testing.assert_array_equal(
        leapmap.solve(slope=packed["slope"]).jump_height,
        leapmap.solve(slope=np.linspace(0.3, 0.5, 5)).jump_height)


def test_trace_tells_the_motion_that_solve_told_the_end_of():
    m = leapmap.trace(slope=0.4, interval=1e-3)
    o = leapmap.solve(slope=0.4)
    assert m.outcome.jump_height == o.jump_height and len(m.candidates) == o.candidates
    assert (np.diff(m.t) >= 0).all() and m.t[0] == 0.0
    # The apex is at most 0.5 ms from a sample, and |y''| at most g (1 + rho w^2), rho < 1.
    assert m.y.max() / 0.082 == pytest.approx(o.jump_height,
                                              abs=9.81 * (1 + o.jump_spin**2) * 0.5e-3**2 / 2 / 0.082)
    assert [phase["phase"] for phase in m.phases] == ["rolling", "flight"]
    assert m.to_xarray().y.attrs["units"] == "m"
    with pytest.raises(ValueError, match="trace takes one design"):
        leapmap.trace(slope=[0.1, 0.2])


def test_the_interpreters_lock_is_released_while_it_solves():
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(1e-3)
    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.perf_counter()
    leapmap.solve(mass_ratio=np.geomspace(0.5, 20, 300_000), threads=1)
    end = time.perf_counter()
    done.set()
    thread.join()
    assert sum(begin < t < end for t in ticks) > 3


def test_ctrl_c_ends_it_with_keyboard_interrupt():
    code = ("import leapmap, numpy as np, os, signal, threading\n"
            "threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()\n"
            "try:\n    leapmap.solve(mass_ratio=np.geomspace(0.5, 20, 20_000_000), fields=['status'])\n"
            "except KeyboardInterrupt:\n    print('interrupted')\n")
    path = "import os, sys; sys.path.insert(0, os.environ['LEAPMAP_BUILD'] + '/python')\n"
    done = subprocess.run([sys.executable, "-c", path + code], capture_output=True, text=True, timeout=120)
    assert done.stdout == "interrupted\n", done.stderr


@pytest.mark.parametrize("name", ["jumps", "settle", "most_period"])
def test_whole_numbers_are_refused_by_name_where_they_are_none(name):
    for wrong in (1.0, "1", np.array([3, 3]), None):
        with pytest.raises(ValueError, match=rf"{name} = .* is not a whole number"):
            leapmap.solve(**{name: wrong})


def test_help_and_stubs_know_every_parameter_and_field():
    from leapmap import _core

    stub = os.path.join(os.path.dirname(_core.__file__), "__init__.pyi")
    text = open(stub, encoding="utf-8").read()
    compile(text, stub, "exec")
    for row in [*_core.parameters(), *_core.fields()]:
        name = row["name"]
        assert re.search(rf"^ *(\* )?{name}( \[.*\])? ?: ", leapmap.solve.__doc__, re.M) and re.search(
            rf"\b{name}: ", text), name
    assert {"slope", "jumps", "settle", "most_period"} <= set(inspect.signature(leapmap.solve).parameters)
    defined = {
        node.name for node in ast.parse(text).body if isinstance(node, (ast.FunctionDef, ast.ClassDef))
    }
    assert set(leapmap.__all__) <= defined
    for of in (leapmap.design, leapmap.fit, leapmap.scatter):
        stubbed = next(node for node in ast.parse(text).body if getattr(node, "name", "") == of.__name__).args
        assert [a.arg for a in stubbed.args + stubbed.kwonlyargs + [stubbed.kwarg]] == list(
            inspect.signature(of).parameters)


def test_gradient_agrees_with_the_45_digit_table():
    t = table("noslip_gradient.csv")
    given = {key: numbers(t[key]) for key in (*INPUTS, "drive_torque")}
    compared = 0
    for of in ("jump_height", "jump_time", "apex_time", "flight_time", "jump_angle", "jump_spin"):
        g = leapmap.gradient(of=of, **given, **UNIT)
        assert list(g) == [*INPUTS, "drive_torque", "resisting_torque"]
        for name, found in g.items():
            if name == "resisting_torque":
                continue
            truth = numbers(t[f"{of}_by_{name}"])
            known = np.isfinite(truth)
            np.testing.assert_allclose(found[known], truth[known], rtol=1e-9)
            compared += known.sum()
    assert compared > 1500


def test_gradient_broadcasts_and_refuses_what_has_none():
    g = leapmap.gradient(slope=np.linspace(0.1, 0.8, 5)[:, None], offset_ratio=[0.8, 1.0], friction="coulomb",
                         mu_static=0.4)
    assert g["mu_static"].shape == (5, 2) and np.isnan(g["mu_kinetic"]).all()
    assert np.isfinite(g["slope"]).any()
    assert isinstance(leapmap.gradient()["slope"], float)
    for of, word in (("status", "status"), ("slip_distance", "jump_height"), ("weight", "weight")):
        with pytest.raises(ValueError, match=word):
            leapmap.gradient(of=of)
    with pytest.raises(ValueError, match="slope"):
        leapmap.gradient(slope=2.0)
