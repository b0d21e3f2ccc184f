"""Real Hesai packets against point clouds of the Nebula driver, an independent decoder.

Nebula lets the head stand still while a block fires. The manuals turn each channel on by its firing
time (PandarXT-16 3.1.4.2, XT32M2X 3.1.3, Pandar64 3.1.4.2, QT128C2X 3.1.3), and so do walls: the
last test. So the clouds are compared with the turn left out, and what the turn adds is tested.

Of two returns of a shot Nebula drops the second one if it equals the first, as we do. It leaves out
what is nearer than its limit for the model.
"""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from recon4.recording.packets.hesai.angles import read_angles
from recon4.recording.packets.hesai.family import FAMILY as HESAI
from tests.unit.recording.hesai_packets import (
    datagrams,
    decoded,
    packet_sensor,
    packets_of_bag,
    tables_in,
    without_turn,
)

CASES = {  # model, points, revolution of the reference after the first shot [ms], its limit [m]
    "xt32": ("XT32", 63021, (290.0, 400.1), 0.0),
    "40p": ("Pandar40P", 56762, (198.5, 300.9), 0.3),
    "qt64": ("QT64", 34158, (195.0, 305.0), 0.1),
    "qt128": ("QT128", 73560, (90.0, 200.0), 0.3),
    "xt32m": ("XT32M2X", 13574, (286.0, 400.1), 0.0),
}
INSIDE_MS = 25.0
"""Before and after the revolution of the reference other ones begin: none invented holds inside."""


def read(data, folder):
    """Payloads, the format for them, the same without turn, and the cloud of the reference."""
    folder = data("packets/nebula/hesai") / folder
    payloads = packets_of_bag(folder)
    head = datagrams(payloads[:300])
    tables = tables_in(folder)
    found = HESAI.recognize(head, tables)
    sensor = packet_sensor(found.model, head=head, companions=tables)
    made = HESAI.open(sensor)
    rows = np.stack([np.frombuffer(payload, np.uint8) for payload in payloads])
    still = without_turn(made, sensor, read_angles(tables[0]))
    raw = max(folder.glob("*.pcd"), key=lambda path: path.name).read_bytes()
    at = raw.index(b"\n", raw.index(b"DATA binary")) + 1
    return rows, made, still, np.frombuffer(raw[at:], "<f4").reshape(-1, 3)


@pytest.mark.parametrize("folder", CASES)
def test_every_point_of_the_reference_is_found_and_none_is_invented(data, folder):
    model, points, (start_ms, end_ms), limit_m = CASES[folder]
    payloads, made, still, cloud = read(data, folder)

    shots = decoded(payloads, still)

    ms = 1e-6 * (shots.t_ns - shots.t_ns[0])
    of_scan = (ms > start_ms) & (ms < end_ms)
    xyz, ms = shots.xyz[of_scan], ms[of_scan]
    off_m, _ = cKDTree(xyz).query(cloud)
    assert made.packets.model.name == model
    assert len(cloud) == points
    assert off_m.max() < 2e-5
    inside = (ms > start_ms + INSIDE_MS) & (ms < end_ms - INSIDE_MS)
    far = np.linalg.norm(xyz, axis=1) > limit_m
    extra_m, _ = cKDTree(cloud).query(xyz[inside & far])
    assert inside.sum() > 1000
    assert (extra_m > 0.005).sum() <= 1  # one pair of the QT128 0.1 m apart counts as one there


@pytest.mark.parametrize("folder", CASES)
def test_the_turn_while_a_block_fires_is_all_that_differs(data, folder):
    payloads, made, still, _ = read(data, folder)
    payloads = payloads[:200]

    turned, kept = decoded(payloads, made), decoded(payloads, still)

    np.testing.assert_array_equal(turned.t_ns, kept.t_ns)
    np.testing.assert_allclose(turned.xyz[:, 2], kept.xyz[:, 2], atol=1e-5)
    ours, theirs = (np.arctan2(shots.xyz[:, 0], shots.xyz[:, 1]) for shots in (turned, kept))
    by_rad = (ours - theirs + np.pi) % (2 * np.pi) - np.pi
    model = made.packets.model
    rpm = 600 if folder in ("40p", "qt64", "qt128") else 599
    firing_us = model.firing_us if folder != "qt128" else model.firing_us[:, 64:]
    expected = np.array([firing_us.min(), firing_us.max()]) * 1e-6 * rpm / 60 * 2 * np.pi
    margin = 2e-5 + 0.01 * np.abs(expected)  # single precision; the speed varies by some rpm
    far = np.linalg.norm(kept.xyz[:, :2], axis=1) > 1.0
    assert by_rad[far].min() > expected[0] - margin[0]
    assert by_rad[far].max() < expected[1] + margin[1]
    assert np.ptp(by_rad[far]) > 0.7 * np.ptp(expected)


def flat_patches(xyz, rng):
    """Rows of some small flat patches of walls."""
    tree = cKDTree(xyz)
    for center in rng.choice(len(xyz), 600, replace=False):
        distance = np.linalg.norm(xyz[center])
        rows = np.array(tree.query_ball_point(xyz[center], np.clip(0.06 * distance, 0.35, 1.5)))
        if len(rows) < 60:
            continue
        _, values, axes = np.linalg.svd(xyz[rows] - xyz[rows].mean(axis=0), full_matrices=False)
        if values[2] < 0.025 * np.sqrt(len(rows)) and values[1] > 0.25 * values[0]:
            yield rows, axes


def test_walls_are_flatter_if_the_head_turns_while_a_block_fires(data):
    payloads, made, still, _ = read(data, "40p")  # neighbors fire up to 50 µs apart
    turned, kept = decoded(payloads[:720], made), decoded(payloads[:720], still)
    far = (np.linalg.norm(kept.xyz, axis=1) > 1.0) & (kept.echo == 0)
    turned, kept = turned.xyz[far].astype(float), kept.xyz[far].astype(float)

    walls = list(flat_patches(kept, np.random.default_rng(1)))
    deviation, turn = [], []
    for rows, axes in walls:
        flat = kept[rows] - kept[rows].mean(axis=0)
        plane, _ = np.linalg.qr(np.column_stack([np.ones(len(rows)), flat @ axes[:2].T]))
        across = np.column_stack([flat @ axes[2], (turned[rows] - kept[rows]) @ axes[2]])
        across -= plane @ (plane.T @ across)
        deviation.append(across[:, 0])
        turn.append(across[:, 1])
    deviation, turn = np.concatenate(deviation), np.concatenate(turn)

    # How much of the turn the deviations from the planes of the walls undo: 0 = it is not there,
    # 1 = it is there in full (somewhat less is seen, because planes were fitted without it).
    assert len(walls) > 100
    assert 0.5 < -(turn @ deviation) / (turn @ turn) < 1.1
