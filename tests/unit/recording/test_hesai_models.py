"""Numbers of the manuals, written out: the encoder shares the tables of the decoder."""

import numpy as np
import pytest

from recon4.recording.packets.hesai.family import FAMILY as HESAI
from recon4.recording.packets.hesai.models import MODELS, model_of
from tests.unit.recording.hesai_packets import datagrams
from tests.unit.recording.test_hesai_packets import spin

STARTS_US = {
    "XT32": [5.632 - 50.0 * k for k in range(7, -1, -1)],
    "Pandar40P": [-28.58 - 55.56 * k for k in range(9, -1, -1)],
    "QT64": [25.71 + 500.0 / 3.0 * k for k in range(4)],
    "QT128": [9.0, 9.0 + 111.11],
    "JT128": [-1888.0 - 111.0, -1888.0],
}
"""Start of each block after the stamp of its packet in single return mode [µs]."""


@pytest.mark.parametrize("name", STARTS_US)
def test_blocks_start_when_the_manual_says(name):
    starts = MODELS[name].start_us(len(STARTS_US[name]))

    np.testing.assert_allclose(starts, STARTS_US[name], atol=1e-9)


@pytest.mark.parametrize(
    ("status", "name"), [(0, "Pandar128"), (128, "OT128"), (136, "OT128"), (137, "JT128")]
)
def test_protocol_1_4_tells_its_sensor_by_the_version_of_the_status(status, name):
    model = MODELS[name]
    payload = spin(model, packets=1)[2][0]
    payload[4] = status

    assert model_of(payload, model.layout).name == name


def test_the_speed_of_a_jt128_is_in_tenths_of_revolutions_a_minute():
    payloads = spin(MODELS["JT128"], packets=200)[2]
    at = MODELS["JT128"].layout.tail_at + MODELS["JT128"].layout.tail.speed
    payloads[:, at : at + 2] = np.array([6000], "<u2").view(np.uint8)

    assert HESAI.recognize(datagrams(payloads), ()).rotation_hz == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("version", "shape", "name"),
    [((7, 2), (120, 1), "FT120"), ((2, 5), (8, 16), "ET25"), ((1, 4), (40, 8), "40, 64 or 90")],
)
def test_a_hesai_that_is_not_decoded_is_refused_by_name(version, shape, name):
    payloads = np.zeros((20, 1000), np.uint8)
    payloads[:, :12] = (0xEE, 0xFF, *version, 0, 0, *shape, 1, 4, 1, 0)

    found = HESAI.recognize(datagrams(payloads), ())

    assert (found.kind, name in found.refused) == ("other", True)
