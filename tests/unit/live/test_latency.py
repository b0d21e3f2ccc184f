"""The latency is measured on one clock, also if the clock of the computer is wrong."""

import pytest

from recon4.live.mapper.latency import Latency
from recon4.live.mapper.tuning import LATENCY
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS
from tests.unit.recording.test_packets_clock import PACKET_NS, packets


class Clock:
    def __init__(self, now_ns):
        self.now_ns = now_ns

    def __call__(self):
        return self.now_ns


@pytest.mark.parametrize("wrong_s", [0.0, 3.0, -3.0, 86_400.0])
def test_gps_drives_the_sensors_and_the_computer_clock_is_wrong(wrong_s):
    t_ns, arrival, stamps = packets(500)
    report = ImportReport()
    offset_ns = -round(wrong_s * SECOND_NS)
    sensor = SensorClock("lidar", packet_s=PACKET_NS / 1e9, report=report, utc_offset_ns=offset_ns)
    sensor.push(arrival - offset_ns, stamps)
    end_ns = int(t_ns[-1])
    clock = Clock(end_ns - offset_ns + 300_000_000)
    latency = Latency(report, clock)

    age_s = latency.age_s(latency.on_recorder_clock(end_ns))
    soon = [latency.leave_out(end_ns) for _ in range(4)]
    clock.now_ns += LATENCY.kept[0][0]
    behind = [latency.leave_out(end_ns) for _ in range(4)]

    clock.now_ns += 5_000_000_000
    far_behind = [latency.leave_out(end_ns) for _ in range(10)]

    assert age_s == pytest.approx(0.3, abs=0.005)
    assert soon == [False] * 4
    assert behind == [True, False, True, False]
    assert far_behind == [True, True, True, True, False] * 2
