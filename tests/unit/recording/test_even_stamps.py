"""Clouds whose stamps scatter although the sensor measures evenly."""

import json

import numpy as np
import pytest

from recon4.recording.bags.recording import BagRecording
from recon4.recording.clocks.even_stamps import EvenStamps
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS, bag_path, room_cloud, write_pcd
from tests.robot_bags import RobotBag
from tests.unit.recording.ingested import run
from tests.warned import derivations

PERIOD_NS = 100_000_000
EVEN_NS = T0_NS + PERIOD_NS * np.arange(80)
TURN_NS = np.array([0, PERIOD_NS - 1])


def scattered(sd_ms=5.0):
    """Stamps of even clouds that scatter."""
    return EVEN_NS + np.rint(1e6 * np.random.default_rng(5).normal(0.0, sd_ms, 80)).astype(int)


def evened(stamps_ns, points_ns):
    """The stamps as they are evened, six of which are known ahead."""
    even = EvenStamps()
    for stamp_ns in stamps_ns[:6]:
        even.add(int(stamp_ns))
    found = []
    for k, stamp_ns in enumerate(stamps_ns):
        for later in stamps_ns[k + 6 : k + 7]:
            even.add(int(later))
        found.append(int(stamp_ns) - even.late_ns(int(stamp_ns), points_ns[k]))
    return np.array(found)


def off_ms(stamps_ns, even_ns=EVEN_NS):
    return 1e-6 * (stamps_ns - even_ns)[20:]


@pytest.mark.parametrize("missing", [0, 7], ids=["all", "every seventh missing"])
def test_stamps_of_arrival_are_put_where_even_ones_would_be(missing):
    there = np.arange(80) % missing != 3 if missing else np.ones(80, bool)
    stamps_ns = scattered()[there]

    found = evened(stamps_ns, stamps_ns[:, None] + TURN_NS)

    off = off_ms(found, EVEN_NS[there])
    assert np.std(off_ms(stamps_ns, EVEN_NS[there])) > 4.0
    assert np.std(off) < 1.6
    assert np.std(np.diff(off)) < 0.8


def test_stamps_stay_where_points_have_times_of_their_own():
    stamps_ns = scattered()

    found = evened(stamps_ns, EVEN_NS[:, None] + TURN_NS)

    np.testing.assert_array_equal(found, stamps_ns)


def test_stamps_stay_where_clouds_are_uneven():
    stamps_ns = scattered()
    ends_ns = np.append(stamps_ns[1:], EVEN_NS[-1] + PERIOD_NS)

    found = evened(stamps_ns, np.column_stack([stamps_ns, ends_ns]))

    np.testing.assert_array_equal(found, stamps_ns)


def test_stamps_stay_where_they_scatter_as_packets_do_or_a_single_one_is_late():
    stamps_ns = scattered(sd_ms=0.3)
    stamps_ns[40] += 30_000_000

    found = evened(stamps_ns, stamps_ns[:, None] + TURN_NS)

    np.testing.assert_array_equal(found, stamps_ns)


def test_stamps_around_one_that_was_set_say_nothing_of_it():
    even, stamps_ns = EvenStamps(), scattered().tolist()
    for stamp_ns in stamps_ns[:30]:
        even.add(stamp_ns)
    others = [even.late_ns(one, one + TURN_NS) for one in stamps_ns[:29]]
    moved = stamps_ns[29] + 7
    late_ns = even.late_ns(moved, moved + TURN_NS)
    even.forget()

    assert any(others)
    assert late_ns == 0
    assert even.late_ns(stamps_ns[29], stamps_ns[29] + TURN_NS) == 0


def test_stamps_stay_where_they_are_equal_or_follow_no_rate():
    steps_ns = np.random.default_rng(2).uniform(2e7, 1.8e8, 80)
    for stamps_ns in (np.repeat(EVEN_NS[::2], 2), T0_NS + np.cumsum(steps_ns).astype(int)):
        found = evened(stamps_ns, stamps_ns[:, None] + TURN_NS)

        np.testing.assert_array_equal(found, stamps_ns)


def test_the_clouds_of_a_bag_are_evened_counted_and_it_is_stated(tmp_path):
    path, table = bag_path(tmp_path, "db3"), room_cloud()
    with RobotBag(path, "db3") as bag:
        for stamp_ns in scattered().tolist():
            bag.cloud("/points", stamp_ns, table)

    report = ImportReport()
    found = BagRecording([path], None, settings=IngestSettings(), report=report)
    starts = np.array([item.t_ns[0] for item in found.read() if hasattr(item, "ring")])

    assert np.std(off_ms(starts)) < 1.6
    assert report.counts["clouds_evened"] > 70
    (said,) = [text for text in derivations(report) if "scatter" in text]
    assert said.startswith("/points: its stamps scatter by ")


def test_stamps_that_a_busy_computer_made_late_are_put_where_even_ones_would_be():
    held_up = np.random.default_rng(1).exponential(1.2e7, 80).astype(int)
    stamps_ns = EVEN_NS + held_up

    found = evened(stamps_ns, stamps_ns[:, None] + TURN_NS)

    assert np.std(off_ms(stamps_ns)) > 10.0
    assert np.std(off_ms(found)) < 3.0


def test_the_frames_of_a_folder_are_evened_counted_and_it_is_stated(tmp_path):
    late_ns = np.random.default_rng(1).exponential(8e6, 80).astype(int)
    (tmp_path / "walk").mkdir()
    for k, stamp_ns in enumerate((EVEN_NS + late_ns).tolist()):
        write_pcd(tmp_path / "walk" / f"{k:03d}.pcd", room_cloud())
        with (tmp_path / "walk" / "times.txt").open("a") as times:
            times.write(f"{stamp_ns}\n")

    store = run(tmp_path / "walk", out=tmp_path / "frames")

    assert np.ptp(1e-6 * late_ns[20:]) > 30.0
    assert np.std(off_ms(store.index["t_ns"])) < 1.6
    report = json.loads((tmp_path / "frames" / "report.json").read_text())
    assert report["counts"]["clouds_evened"] > 70
    assert "STAMPS-EVENED" in json.dumps(report["derived"])
