"""Line scans: where the sweeps of the head end."""

import numpy as np

from recon4.model.line_scans import LineScans
from recon4.simulation.profiler import HeadModel


def lines_of(angle_rad, *, hz=100.0):
    t_ns = np.round(np.arange(len(angle_rad)) * 1e9 / hz).astype(np.int64)
    return LineScans(t_ns, np.asarray(angle_rad, float), np.full(len(t_ns), 500))


def test_a_turn_ends_where_the_head_reverses():
    rng = np.random.default_rng(0)
    t_s = np.arange(2600) * 0.01
    angle = HeadModel().angle_rad(t_s + 2.0) + 3e-5 * rng.standard_normal(len(t_s))

    lines = lines_of(angle)

    ends = lines.sweeps()
    assert ends[0] == 0
    assert ends[-1] == 2600
    assert np.abs(ends[1:-1] - [400, 1000, 1600, 2200]).max() <= 5


def test_a_head_that_spins_has_a_turn_every_revolution():
    lines = lines_of(np.arange(1000) * np.deg2rad(-1.2))  # 300 lines a revolution

    assert lines.sweeps().tolist() == [0, 300, 600, 900, 1000]


def test_few_lines_are_one_turn():
    assert lines_of(np.arange(5)).sweeps().tolist() == [0, 5]
