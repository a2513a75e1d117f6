# SPDX-License-Identifier: GPL-3.0-or-later
"""Motors in flight, and what the way to a jump asks of them."""
import leapmap
import numpy as np
import pytest

WAY = ["status", "jump_height", "max_normal_force", "motor_energy", "motor_max_power", "motor_max_spin"]


def test_a_motor_drives_the_hoop_in_flight_unless_it_idles():
    torques = np.linspace(0.2, 1.0, 50)
    asked = {"slope": 0.0, "drive_torque": torques, "friction": "coulomb", "mu_static": 0.6}
    driven, idle = leapmap.solve(**asked), leapmap.solve(**asked, motor_in_flight=False)
    assert (driven.status == 1).all()
    assert (idle.status == 5).sum() > 5, "what an idle motor has lifted off sinks"
    both = idle.status == 1
    assert not np.array_equal(driven.jump_height[both], idle.jump_height[both])
    with pytest.raises(ValueError, match="motor_in_flight = 1 is not a bool"):
        leapmap.solve(motor_in_flight=1)


def test_the_way_to_a_jump_is_measured_if_it_is_asked_for():
    o = leapmap.solve(slope=[0.3, 0.4], drive_torque=0.1, fields=WAY)
    assert (o.max_normal_force > 1).all() and (o.motor_energy > 0).all()
    assert (o.motor_max_power <= 0.1 * o.motor_max_spin * (1 + 1e-14)).all()
    fine = leapmap.trace(slope=0.4, drive_torque=0.1, interval=1e-4)
    before = fine.t <= leapmap.solve(slope=0.4, drive_torque=0.1).jump_time
    assert o.max_normal_force[1] >= fine.normal_force[before].max() * (1 - 1e-13)
    assert o.max_normal_force[1] <= fine.normal_force[before].max() * 1.001
    shown = leapmap.solve(slope=0.4, mass="158 g", fields=WAY).to("N")
    assert shown.max_normal_force == pytest.approx(
        leapmap.solve(slope=0.4, fields=WAY).max_normal_force * 0.158 * 9.81)
