"""A prior on the speed of who carries the sensors: it bounds what nothing observes."""

from types import SimpleNamespace

import numpy as np
import pytest

from recon4.registration.frame_fit import _add_speed_of_person
from recon4.registration.state_vector import END, END_VELOCITY, VECTOR

SIZE = max(part.stop for part in (VECTOR.velocity, VECTOR.position))


def corrected(velocity, *, sd_m_s, observed=None):
    """The velocity after the prior, known to ``sd_m_s`` by the IMU and maybe observed to 1 cm/s."""
    vector = np.zeros(SIZE + 20)
    vector[VECTOR.velocity] = velocity
    information, g = np.eye(END.stop), np.zeros(END.stop)
    information[END_VELOCITY, END_VELOCITY] = np.eye(3) / sd_m_s**2
    if observed is not None:
        information[END_VELOCITY, END_VELOCITY] += np.eye(3) / 0.01**2
        g[END_VELOCITY] += (np.asarray(velocity) - observed) / 0.01**2
    _add_speed_of_person(information, g, SimpleNamespace(end=SimpleNamespace(vector=vector)))
    return velocity - np.linalg.solve(information, g)[END_VELOCITY]


def test_a_velocity_that_nothing_observes_is_pulled_to_that_of_a_person():
    there = corrected(np.array([6.0, 8.0, 0.0]), sd_m_s=1.0)

    np.testing.assert_allclose(there, [2.4, 3.2, 0.0], atol=1e-9)


@pytest.mark.parametrize("speed", [0.0, 1.4, 2.4])
def test_who_walks_is_not_changed(speed):
    velocity = np.array([speed, 0.0, 0.0])

    np.testing.assert_array_equal(corrected(velocity, sd_m_s=1.0), velocity)


def test_a_vehicle_that_a_lidar_observes_is_not_held_back():
    velocity = np.array([9.0, 0.0, 0.0])

    there = corrected(velocity, sd_m_s=1.0, observed=velocity)

    assert there[0] == pytest.approx(9.0, abs=0.005)
