"""Real packets of Ouster sensors against the decode of the maker's SDK (``*.ref.npz``).

The reference holds range, signal and points of every column of a scan, beam by beam; its points are
whole millimeters in the sensor frame.
"""

import json

import numpy as np
import pytest

from recon4.recording.packets.ouster.family import FAMILY as OUSTER
from tests.unit.recording.ouster_packets import companion, data_of, of_port, opened

_OS0, _OS1, _OS2 = (
    "OS-0-32-U1_v2.2.0_1024x10",
    "OS-1-128_v2.3.0_1024x10_lb_n3",
    "OS-2-32-U0_v2.0.0_1024x10",
)
_FUSA = "OS-1-128_767798045_1024x10_20230712_120049"
_WINDOW = "windowed_frame1"
CASES = {
    _OS0: (_OS0, 7502, "OS0-32", "dual", 10.0),
    _OS1: ("OS-1-128_v2.3.0_1024x10", 7502, "OS1-128", "single", 10.0),
    _OS2: (_OS2, 7502, "OS2-32", "single", 20.0),
    _FUSA: (_FUSA, 7502, "OS1-128", "dual", 10.0),
    _WINDOW: ("windowed_frame1_0", 53750, "OS0-128", "single", 10.0),
}
cases = pytest.mark.parametrize("name", CASES)


def decoded(data, name, report=None):
    """The packets of a sample file, all of them decoded on their own clock."""
    folder = data("packets/ouster")
    beside, port = CASES[name][:2]
    head = of_port(folder / f"{name}.pcap", port)
    packets = opened(head, companion(folder / f"{beside}.json"), report=report)
    payloads = data_of(head, packets.size)
    payloads = payloads[packets.sound(payloads)]
    return packets.decode(packets.stamps_ns(payloads), payloads)


def reference(data, name):
    """All returns, in order of column, beam and range.

    Returns:
        Stamp [ns], ring, range [mm] and intensity of each, (N, 4); point by the maker's formula
        [mm], (N, 3); echo, (N,): 0 for the only one, or for that of the stronger signal.
    """
    folder = data("packets/ouster")
    document = json.loads((folder / f"{CASES[name][0]}.json").read_text())
    arrays = np.load(folder / f"{name}.ref.npz")
    ring = np.argsort(np.argsort(values_of(document, "beam_altitude_angles")))
    rows, points, echoes = [], [], []
    for k in range(sum(key.startswith("RANGE_") for key in arrays.files)):
        kind = "SIGNAL" if f"SIGNAL_{k}" in arrays.files else "REFLECTIVITY"
        returns = [echo for echo in ("", "2") if f"RANGE{echo}_{k}" in arrays.files]
        range_mm = np.stack([arrays[f"RANGE{echo}_{k}"].astype(np.int64) for echo in returns])
        strength = np.stack([arrays[f"{kind}{echo}_{k}"].astype(np.int64) for echo in returns])
        there = (range_mm > 0) & (arrays[f"status_{k}"] & 1 > 0)
        there[1:] &= range_mm[1:] != range_mm[:1]
        both = there.all(axis=0) if len(returns) == 2 else np.zeros(there.shape[1:], dtype=bool)
        swapped = both & (strength[-1] > strength[0]) & (kind == "SIGNAL")
        echo, beam, column = np.nonzero(there)
        stamp = arrays[f"column_timestamp_ns_{k}"].astype(np.int64)
        rows.append(np.column_stack([stamp[column], ring[beam], range_mm[there], strength[there]]))
        points.append(points_mm(document, range_mm)[there])
        echoes.append(both[beam, column] & (echo.astype(bool) ^ swapped[beam, column]))
        first = np.where(there[0], 1, 0)[:, :, None] * points_mm(document, range_mm)[0]
        seen = arrays[f"status_{k}"] & 1 > 0
        assert np.abs(first - arrays[f"xyz_mm_{k}"])[:, seen].max() <= 1.0
    rows = np.concatenate(rows)
    order = np.lexsort((rows[:, 2], rows[:, 1], rows[:, 0]))
    return rows[order], np.concatenate(points)[order], np.concatenate(echoes)[order]


def values_of(document, key):
    sections = [part for part in document.values() if isinstance(part, dict) and key in part]
    return np.array([document, *sections][-1][key])


def points_mm(document, range_mm):
    """Points in the sensor frame by the Firmware User Manual, (..., H, W) -> (..., H, W, 3)."""
    columns = range_mm.shape[-1]
    encoder = 2.0 * np.pi * (1.0 - np.arange(columns) / columns)
    azimuth = encoder - np.deg2rad(values_of(document, "beam_azimuth_angles"))[:, None]
    elevation = np.deg2rad(values_of(document, "beam_altitude_angles"))[:, None]
    n = float(values_of(document, "lidar_origin_to_beam_origin_mm"))
    x = (range_mm - n) * np.cos(azimuth) * np.cos(elevation) + n * np.cos(encoder)
    y = (range_mm - n) * np.sin(azimuth) * np.cos(elevation) + n * np.sin(encoder)
    z = (range_mm - n) * np.sin(elevation)
    T_sensor_lidar = values_of(document, "lidar_to_sensor_transform").reshape(4, 4)
    return np.stack([x, y, z], axis=-1) @ T_sensor_lidar[:3, :3].T + T_sensor_lidar[:3, 3]


@cases
def test_every_return_of_the_reference_is_found_and_no_other(data, name):
    wanted, points, echo = reference(data, name)
    shots = decoded(data, name)
    away = np.linalg.norm(shots.xyz, axis=1)
    order = np.lexsort((away, shots.ring, shots.t_ns))

    assert len(wanted) > 9000
    np.testing.assert_array_equal(shots.t_ns[order], wanted[:, 0])
    np.testing.assert_array_equal(shots.ring[order], wanted[:, 1])
    np.testing.assert_array_equal(shots.intensity[order], wanted[:, 3])
    assert np.abs(1e3 * shots.xyz[order] - points).max() < 0.1
    np.testing.assert_array_equal(shots.echo[order], echo)


@cases
def test_samples_are_recognized_with_model_mode_and_rate(data, name):
    folder = data("packets/ouster")
    beside, port, model, mode, rotation_hz = CASES[name]
    head = of_port(folder / f"{name}.pcap", port)

    found = OUSTER.recognize(head, [companion(folder / f"{beside}.json")])

    assert (found.kind, found.model, found.mode, found.findings) == ("data", model, mode, ())
    assert found.rotation_hz == pytest.approx(rotation_hz, rel=0.01)
    assert found.packet_s == pytest.approx(np.median(np.diff(head.t_ns)) / 1e9, rel=0.5)
