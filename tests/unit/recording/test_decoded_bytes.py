"""Points are the same to the last bit, however fast the kernels are made."""

import zlib

import pytest

from recon4.kernels.processor import instructions
from recon4.recording.packets.hesai.models import MODELS
from recon4.recording.packets.robosense.models import MODELS as ROBOSENSE_MODELS
from tests.unit.recording import test_hesai_packets as hesai
from tests.unit.recording import test_robosense_packets as robosense

DUAL = 0x39


def of_hesai(name, mode):
    model = MODELS[name]
    return hesai.decoded(model, hesai.spin(model, 12, mode)[2])[0]


def of_robosense(name, mode):
    model = ROBOSENSE_MODELS[name]
    payloads = robosense.spin(model, 12, dual=mode == DUAL)[1]
    layout = robosense.opened(name, beside=robosense.datagrams(robosense.device_of(model)))
    return robosense.decoded(layout, payloads)


@pytest.mark.skipif(instructions() != "x86-64-v3", reason="other instructions round otherwise")
@pytest.mark.parametrize(
    ("made", "name", "mode", "digest"),
    [
        (of_hesai, "XT32", 0x37, 2536218903),
        (of_hesai, "Pandar40P", DUAL, 1242508754),
        (of_hesai, "OT128", DUAL, 1820422214),
        (of_hesai, "AT128", 0x37, 3496369332),
        (of_hesai, "AT128", DUAL, 3546122487),
        (of_robosense, "Ruby Plus", 0x37, 3359212632),
        (of_robosense, "Airy", DUAL, 397399997),
    ],
)
def test_points_have_the_bytes_that_they_had_before_kernels_read_eight_shots_at_once(
    made, name, mode, digest
):
    shots = made(name, mode)

    total = 0
    for column in (shots.t_ns, shots.xyz, shots.intensity, shots.ring, shots.echo):
        total = zlib.crc32(column.tobytes(), total)
    assert total == digest
