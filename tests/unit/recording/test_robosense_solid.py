"""RoboSense packets of sensors that do not spin: directions, times, returns."""

import numpy as np
import pytest

from recon4.recording.packets.robosense.encode import encode_solid
from recon4.recording.packets.robosense.family import FAMILY as ROBOSENSE
from recon4.recording.packets.robosense.solid import MIDDLE, SOLID_MODELS
from tests.unit.recording.packet_builders import T0_NS
from tests.unit.recording.test_robosense_packets import datagrams, decoded, opened


def test_an_m1_points_by_two_angles_and_an_e1_by_a_vector():
    m1, e1 = SOLID_MODELS["M1"], SOLID_MODELS["E1"]
    blocks = np.zeros((2, 25), m1.block)
    blocks["us"] = 4 * np.arange(25)
    blocks["returned"] = [[1], [2]]
    blocks["points"]["distance"] = [[[2000]], [[2100]]]
    blocks["points"]["yaw"] = MIDDLE + 3000
    blocks["points"]["pitch"] = MIDDLE - 1000
    blocks["points"]["intensity"] = np.arange(5)
    t_ns = T0_NS + np.array([0, 158_730]) // 1000 * 1000

    shots = decoded(opened("M1"), encode_solid(t_ns, blocks, m1))

    flat = np.cos(np.deg2rad(10))
    ray = [flat * np.cos(np.deg2rad(30)), flat * 0.5, -np.sin(np.deg2rad(10))]
    assert shots.xyz[:125] == pytest.approx(10 * np.tile(ray, (125, 1)), abs=1e-5)
    assert shots.t_ns[5:10].tolist() == [t_ns[0] + 4000] * 5
    assert (shots.echo[:125].max(), shots.echo[125:].min(), len(shots)) == (0, 1, 250)
    assert shots.ring[:5].tolist() == shots.intensity[:5].tolist() == [0, 1, 2, 3, 4]

    blocks = np.zeros((1, 96), e1.block)
    blocks["us"] = 3 * np.arange(96)
    blocks["points"]["distance"] = 1000
    blocks["points"]["vector"] = [16384, 0, -16384]
    shots = decoded(opened("E1"), encode_solid(t_ns[:1], blocks, e1))
    assert shots.xyz[95].tolist() == [2.5, 0, -2.5]
    assert shots.t_ns[95] == t_ns[0] + 95 * 3000


def test_times_of_an_e1_that_would_reach_into_the_next_packets_are_nanoseconds():
    e1 = SOLID_MODELS["E1"]
    blocks = np.zeros((1, 96), e1.block)
    blocks["us"] = 500 * np.arange(96)
    blocks["points"]["distance"] = 1000
    blocks["points"]["vector"] = [MIDDLE - 1, 0, 0]

    shots = decoded(opened("E1"), encode_solid(np.array([T0_NS]), blocks, e1))

    assert (shots.t_ns - T0_NS).tolist() == (500 * np.arange(96)).tolist()


def test_an_m2_has_five_channels_of_vectors():
    m2 = SOLID_MODELS["M2"]
    blocks = np.zeros((1, 25), m2.block)
    blocks["us"] = 3 * np.arange(25)
    blocks["points"]["distance"] = 1000
    blocks["points"]["vector"] = [16384, -16384, 0]

    shots = decoded(opened("M2"), encode_solid(np.array([T0_NS]), blocks, m2))

    assert (len(shots), shots.xyz[124].tolist()) == (125, [2.5, -2.5, 0])
    assert (shots.ring[:5].tolist(), shots.t_ns[124]) == ([0, 1, 2, 3, 4], T0_NS + 72_000)


def test_an_m1_and_an_e1_are_told_by_size_and_first_bytes():
    for name, model in SOLID_MODELS.items():
        payloads = encode_solid(np.full(3, T0_NS), np.zeros((3, model.blocks), model.block), model)
        assert ROBOSENSE.recognize(datagrams(payloads), ()).model == name
