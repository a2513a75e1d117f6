# SPDX-License-Identifier: GPL-3.0-or-later
"""Hoops as a drawing has them, and outcomes in its units."""
import math

import leapmap
import numpy as np
import pytest

SLUG, BATTERY = leapmap.Weight("85 g", at="47 mm"), leapmap.Weight("12 g", at="30 mm", angle="180 deg")


def drawing(slug=SLUG):
    return leapmap.Hoop(diameter="120 mm", mass="61 g", inertia="1.9e-4 kg m2", weights=[slug, BATTERY])


def test_a_drawing_solves_as_its_ratios():
    hoop = drawing()
    assert hoop.total_mass == pytest.approx(0.158, rel=1e-15)
    assert hoop.eccentricity == pytest.approx(3635e-6 / (0.158 * 0.06), rel=1e-14)
    assert hoop.inertia_ratio == pytest.approx(
        (1.9e-4 + 0.085 * 0.047**2 + 0.012 * 0.03**2) / (0.158 * 0.06**2), rel=1e-14)
    asked = {"slope": "18 deg", "friction": "coulomb", "mu_static": 0.6}
    o = leapmap.solve(hoop=hoop, **asked)
    assert o.jump_height == leapmap.solve(**hoop.parameters, **asked).jump_height
    assert leapmap.phase_letters(o.phase_sequence) == "RSRSF"
    # One design is solved by other instructions than many.
    assert leapmap.trace(hoop=hoop, **asked).outcome.jump_height == pytest.approx(o.jump_height, rel=1e-12)
    assert leapmap.gradient(hoop=hoop, **asked)["slope"] == leapmap.gradient(**hoop.parameters,
                                                                             **asked)["slope"]
    assert len(leapmap.gaits(hoop=hoop, slope="12 deg", runway=20)["gaits"]) == len(
        leapmap.gaits(**hoop.parameters, slope="12 deg", runway=20)["gaits"])


def test_a_weight_may_be_an_array():
    masses = np.linspace(0.04, 0.16, 13)
    hoop = drawing(leapmap.Weight(masses, at="47 mm"))
    o = leapmap.solve(hoop=hoop, slope=np.radians([20.0, 30.0])[:, None])
    assert o.jump_height.shape == (2, 13) and "mass" not in hoop.parameters
    for k in (0, 6, 12):
        one = leapmap.solve(hoop=drawing(leapmap.Weight(masses[k], at="47 mm")), slope="30 deg")
        # times of many share their number of nodes, heights do not
        assert o.jump_height[1, k] == pytest.approx(one.jump_height, rel=1e-14, nan_ok=True)


@pytest.mark.parametrize("of", ["jump_height", "jump_time"])
def test_derivatives_are_by_the_numbers_of_the_drawing(of):
    def hoop(numbers):
        slug = leapmap.Weight(numbers["slug.mass"], numbers["slug.at"], inertia=numbers["slug.inertia"],
                              name="slug")
        battery = leapmap.Weight("12 g", "30 mm", angle=numbers["weights[1].angle"])
        return leapmap.Hoop(numbers["diameter"], numbers["mass"], numbers["inertia"], [slug, battery])

    numbers = {
        "diameter": 0.12, "mass": 0.061, "inertia": 1.9e-4, "slug.mass": 0.085, "slug.at": 0.047,
        "slug.inertia": 2e-6, "weights[1].angle": 3.0
    }
    asked = {"slope": [0.55, 0.65], "friction": "coulomb", "mu_static": 0.6}
    by = leapmap.gradient(hoop=hoop(numbers), of=of, **asked)
    assert "mass_ratio" not in by and by["slope"].shape == (2,)
    for name, value in numbers.items():
        def at(change):
            changed = hoop(numbers | {name: value + change})
            return getattr(leapmap.solve(hoop=changed, tolerance=1e-13, **asked), of)
        step = 1e-4 * value
        differences = (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step)
        # Differences of the fourth order lose digits where a number hardly matters.
        assert by[f"hoop.{name}"] == pytest.approx(differences, rel=1e-7, abs=1e-9 / value), name
    of_many = hoop(numbers | {"slug.mass": np.array([[0.08], [0.085], [0.09]])})
    assert leapmap.gradient(hoop=of_many, of=of, **asked)["hoop.slug.at"][1] == pytest.approx(
        by["hoop.slug.at"], rel=1e-12)


def test_newtons_of_hoops_with_masses_of_their_own():
    o = leapmap.solve(hoop=drawing(leapmap.Weight([0.04, 0.085], at="47 mm")), slope=[[0.5], [0.6]])
    one = leapmap.solve(hoop=drawing(), slope=0.6).to("N.s mm")
    shown = o.to("N.s mm")
    assert shown.landing_impulse.shape == (2, 2)
    assert shown.landing_impulse[1, 1] == pytest.approx(one.landing_impulse, rel=1e-12)
    assert shown.jump_height[1, 1] == pytest.approx(one.jump_height, rel=1e-12)
    assert shown.to_xarray().landing_impulse.attrs["units"] == "N.s"


def test_outcomes_are_shown_in_a_drawing_s_units():
    o = leapmap.solve(hoop=drawing(), slope=[0.5, 0.01], friction="coulomb", mu_static=0.6)
    shown = o.to("mm deg ms rpm N.s J mm/s")
    speed = math.sqrt(9.81 * 0.06)
    for name, factor in (("jump_height", 120), ("jump_distance", 60), ("jump_angle", 180 / math.pi),
                         ("jump_time", 1000), ("jump_spin", 30 / math.pi * speed / 0.06), ("landing_impulse",
                                                                                           0.158 * speed),
                         ("energy_lost", 0.158 * 9.81 * 0.06), ("landing_normal_speed", 1000 * speed)):
        assert getattr(shown, name) == pytest.approx(getattr(o, name) * factor, rel=1e-13, nan_ok=True), name
    assert (shown.status == o.status).all() and np.isnan(shown.jump_height[1]) and o.jump_height[0] < 2


def test_specs_take_hoops_with_axes_free_numbers_and_tolerances():
    asked = {"friction": "coulomb", "mu_static": 0.6}
    slug = leapmap.Weight("85 g", at="47 mm", name="slug")
    one = leapmap.solve(hoop=drawing(slug), slope="30 deg", **asked)
    masses = {"values": ["70 g", "85 g"]}
    ds = leapmap.sweep({"scene": asked}, hoop=drawing(slug), slope="30 deg", **{"hoop.slug.mass": masses})
    assert float(ds.jump_height.sel({"hoop.slug.mass": 0.085})) == pytest.approx(one.jump_height, rel=1e-12)
    found = leapmap.design(hoop=drawing(slug), slope="30 deg", maximize="jump_height", sample=512, most=1,
                           **asked, **{"hoop.slug.mass": {"from": "70 g", "to": "85 g"}})
    assert found.objectives["jump_height"][0] >= one.jump_height * (1 - 1e-12)
    sizes = {"hoop.diameter": {"from": "100 mm", "to": "150 mm"}}
    walled = leapmap.DesignProblem(hoop=drawing(slug), clear_height="8 mm", slope="30 deg",
                                   minimize="jump_time", **sizes)
    assert walled.fixed["clear_height"] == "0.008 m", "whatever the diameter"
    assert "radius" not in walled.fixed and walled.fixed["mass"] == pytest.approx(0.158), "one is free"
    spread = leapmap.scatter({"hoop": drawing(), "design": {"slope": "30 deg"}, "scene": asked},
                             scatter={"hoop.weight1.mass": {"normal": "1 g"}})
    assert 0 < spread["jump_height"]["sd"].value < 0.05


def test_outcomes_of_searches_and_of_manufactured_hoops_are_shown_by_each_hoop_s_size_and_mass():
    slug = leapmap.Weight("85 g", at="47 mm", name="slug")
    free = {"hoop.slug.mass": {"from": "70 g", "to": "85 g"},
            "hoop.diameter": {"from": "100 mm", "to": "150 mm"}}
    found = leapmap.design(hoop=drawing(slug), slope="30 deg", maximize=["jump_height", "hoop.diameter"],
                           sample=512, most=8, **free)
    shown, sizes = found.outcomes.to("mm N.s"), found.parameters["hoop.diameter"]
    assert len(found) > 1 and np.ptp(sizes) > 0.01
    assert shown.jump_height == pytest.approx(1000 * sizes * found.outcomes.jump_height, rel=1e-12)
    of_one = leapmap.solve(hoop=drawing(slug), slope="30 deg").to("mm N.s")
    made = leapmap.scatter({"hoop": drawing(slug), "design": {"slope": "30 deg"}},
                           scatter={"hoop.diameter": {"uniform": "1 mm"}, "samples": 64})
    heights = made["outcomes"].to("mm").jump_height / made["outcomes"].jump_height
    assert 119 <= np.nanmin(heights) < 119.2 and 120.8 < np.nanmax(heights) <= 121
    one = leapmap.design(hoop=drawing(slug), slope="30 deg", maximize="jump_height", sample=64, most=1,
                         **{"hoop.slug.mass": {"from": "84.9999999 g", "to": "85 g"}})
    assert one.outcomes.to("mm").jump_height[0] == pytest.approx(of_one.jump_height, rel=1e-6)


@pytest.mark.parametrize(("make", "says"), [
    (lambda: leapmap.Weight("85 mm", at=0.01), "'85 mm' cannot be converted to kg; allowed: "),
    (lambda: leapmap.Weight("85 gg", at=0.01), "the unit 'gg' is unknown"),
    (lambda: leapmap.Weight(None, at=0.01), "weight.mass = None is not a valid value"),
    (lambda: leapmap.Hoop("120 mm", mass="-1 g"), "hoop.mass = -0.001 is out of range"),
    (lambda: leapmap.Hoop([0.1, 0.2], mass=1), "allowed: one number"),
    (lambda: leapmap.Hoop("120 mm", mass=1, weights=["85 g"]), "a list of leapmap.Weight"),
    (lambda: leapmap.Hoop("90 mm", mass=1, weights=[SLUG, BATTERY]),
     "hoop.weights[0].at = 0.047 is out of range"),
    (lambda: leapmap.solve(hoop="120 mm"), "allowed: a leapmap.Hoop"),
    (lambda: leapmap.sweep({"hoop": {"diameter": 0.1}}, hoop=drawing()), "allowed: one of the two"),
    (lambda: leapmap.design("hoop.toml", hoop=drawing()), "has no effect beside a file or [hoop]"),
    (lambda: leapmap.design(hoop=drawing(leapmap.Weight([0.04, 0.08], at="47 mm"))), "hoop holds arrays"),
    (lambda: leapmap.solve(hoop=drawing(), mass_ratio=3), "mass_ratio = 3 has no effect beside hoop"),
    (lambda: leapmap.solve(hoop=drawing(), radius="60 mm"), "radius = '60 mm' has no effect beside hoop"),
    (lambda: leapmap.Hoop("120 mm", mass=1, inertia=np.nan), "inertia = nan is not finite"),
    (lambda: leapmap.Hoop("120 mm", mass=[1, 2], weights=leapmap.Weight([1, 2, 3], at=0)),
     "do not broadcast"),
    (lambda: leapmap.Weight("85 g\udc80", at=0), "no UTF-8"),
    (lambda: leapmap.Weight("8 5 g", at=0), "the unit '5 g' is unknown"),
    (lambda: leapmap.solve().to(5), "units = 5 is not a text"),
    (lambda: leapmap.design(slope={"from": 0.1, "to": 0.5}, maximize="jump_height", sample=64, most=1).
     outcomes.to("N.s"), "newtons and joules need the parameter mass"),
    (lambda: leapmap.solve().to("mmm"), "the unit 'mmm' is unknown"),
    (lambda: leapmap.solve().to("N.s"), "newtons and joules need the parameter mass"),
    (lambda: leapmap.solve(mass=1).to("kg"), "no field can be given in kg; allowed: "),
    (lambda: leapmap.solve(drive_torque="0.1 N m"), "needs the total mass too"),
    (lambda: leapmap.solve(release_spin="30 Hz"), "cannot be converted to rad s-1"),
])
def test_what_is_no_hoop_and_no_unit_is_refused_in_a_line(make, says):
    with pytest.raises(ValueError) as refused:
        make()
    assert says in str(refused.value) and "\n" not in str(refused.value)


def test_units_hang_on_the_call_s_own_radius_in_any_order():
    one = leapmap.solve(hop_height="6 mm", radius="60 mm")
    two = leapmap.solve(radius=0.06, hop_height=0.05)
    assert one.jump_height == two.jump_height
    ds = leapmap.solve(slope=[0.3, 0.4], release_spin="60 rpm", radius="60 mm").to_xarray()
    assert ds.attrs["release_spin"] == pytest.approx(2 * math.pi * math.sqrt(0.06 / 9.81))


def test_units_chosen_twice_count_from_what_was_solved():
    o = leapmap.solve(slope=[0.3, 0.4], radius="60 mm")
    assert (o.to("mm").to("mm").jump_height == o.to("mm").jump_height).all()
    assert o.to("mm").to("m").jump_height == pytest.approx(o.to("m").jump_height, rel=1e-15)
    assert (o.to("mm m").jump_height == o.to("mm").jump_height).all(), "the first that fits"
    ds = o.to("mm ms").to_xarray()
    assert ds.jump_height.attrs["units"] == "mm" and "diameters" not in ds.jump_height.attrs["long_name"]
    assert ds.jump_time.attrs["units"] == "ms" and o.to_xarray().jump_time.attrs["units"] == "s"
