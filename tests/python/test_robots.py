# SPDX-License-Identifier: GPL-3.0-or-later
"""Hoops with a driven pendulum in Python."""
import leapmap
import numpy as np
import pytest

ROBOT = {"model": "pendulum", "slope": 0.0, "mass_ratio": 3.0}


def test_solve_takes_a_model_a_law_and_arrays():
    torque = np.linspace(0.5, 2.0, 7)
    o = leapmap.solve(**ROBOT, motor_torque=torque, no_load_speed=[[8.0], [np.inf]])
    assert o.jump_height.shape == (2, 7) and (o.status[1] == leapmap.Status.jumped).any()
    one = leapmap.solve(**ROBOT, motor_torque=2.0)
    assert one.jump_height == o.jump_height[1, -1]
    held = leapmap.solve(**ROBOT, motor_torque=2.0, motor_law="until_angle", motor_target="-10 deg")
    assert held.status == leapmap.Status.stalled  # the brake holds it from the start
    way = leapmap.solve(**ROBOT, motor_torque=2.0, fields=["efficiency", "motor_max_torque", "motor_energy"])
    assert way.motor_max_torque == 2.0 and 0 < way.efficiency < 1


def test_what_a_hoop_has_not_is_refused_or_told():
    with pytest.raises(ValueError, match="the model is hoop; allowed: with model = \"pendulum\""):
        leapmap.solve(motor_torque=1.0)
    with pytest.raises(ValueError, match="the model is pendulum"):
        leapmap.solve(**ROBOT, drive_torque=1.0)
    with pytest.raises(ValueError, match="motor_law = '?full'? is unknown; allowed: one of constant"):
        leapmap.solve(**ROBOT, motor_law="full")
    with pytest.raises(ValueError, match="needs derivatives, which the model \"pendulum\" lacks"):
        leapmap.gradient(**ROBOT, motor_torque=2.0)
    with pytest.raises(AttributeError, match="it needs model='pendulum'"):
        leapmap.solve().efficiency


def test_a_motion_has_the_pendulum():
    m = leapmap.trace(**ROBOT, motor_torque=2.0, interval=1e-3)
    assert len(m.pendulum_angle) == len(m.t) and (m.motor_torque == 2.0).all()
    assert m.pendulum_angle[0] == 0.0 and m.pendulum_spin[-1] > 0.0
    assert not hasattr(leapmap.trace(interval=1e-2), "pendulum_angle")
