# SPDX-License-Identifier: GPL-3.0-or-later
"""Jump after jump, and gaits, from Python."""
import numpy as np
import pytest

import leapmap

HOOP = dict(slope=np.radians(12), mass_ratio=3.0, offset_ratio=0.5)


def test_solve_tells_every_jump_of_arrays():
    o = leapmap.solve(slope=[0.2, 0.3], mass_ratio=3.0, offset_ratio=0.5, jumps=4, runway=20.0)
    assert o.jumps.tolist() == [4, 4] and o.jump_height_4.shape == (2,)
    assert (np.diff([o.jump_time, o.jump_time_2, o.jump_time_3, o.jump_time_4], axis=0) > 0).all()
    one = leapmap.solve(slope=0.2, mass_ratio=3.0, offset_ratio=0.5, jumps=4, runway=20.0,
                        fields=["jump_height_4"])
    assert one.jump_height_4 == o.jump_height_4[0]


def test_gradients_of_later_jumps_are_those_of_differences():
    by = leapmap.gradient(**HOOP, jumps=3, runway=20.0, of="jump_height_3")["mass_ratio"]
    step = 1e-5
    beside = [
        leapmap.solve(**(HOOP | {"mass_ratio": 3.0 + way * step}), jumps=3, runway=20.0).jump_height_3
        for way in (1, -1)
    ]
    assert by == pytest.approx((beside[0] - beside[1]) / (2 * step), rel=1e-6)


def test_a_release_settles_on_one_of_the_gaits():
    settled = leapmap.solve(**HOOP, settle=500)
    told = leapmap.gaits(**HOOP)
    stable = [gait for gait in told["gaits"] if abs(gait["multiplier"]) < 1]
    assert settled.gait_period == 1 and len(stable) == 1
    assert stable[0]["height"] == pytest.approx(float(settled.gait_height), abs=1e-10)
    assert told["returns"]["angle"].shape == told["returns"]["next"].shape
    assert "most_period" in leapmap.gaits.__doc__


@pytest.mark.parametrize(
    "wrong",
    [dict(jumps=0),
     dict(jumps=1.5),
     dict(jumps="2"),
     dict(settle=-1),
     dict(most_period=65, settle=5)])
def test_what_is_no_number_of_jumps_is_refused(wrong):
    with pytest.raises(ValueError):
        leapmap.solve(**HOOP, **wrong)


def test_gaits_refuse_arrays_and_periods_beyond_16():
    with pytest.raises(ValueError):
        leapmap.gaits(slope=[0.1, 0.2])
    with pytest.raises(ValueError):
        leapmap.gaits(most_period=17)
    for name in ("friction", "jumps", "settle", "mu_static"):
        with pytest.raises(ValueError, match=name):
            leapmap.gaits(**HOOP, **{name: 2})
