"""Times of points: in which clock they are, and what single damaged ones do."""

import numpy as np
import pytest

from recon4.model.tuning import LOSSES
from recon4.recording.clocks.names import described, known_offset_s
from recon4.recording.clouds.cloud_points import CloudDecoder
from recon4.recording.report import ImportReport
from tests.builders import T0_NS, room_cloud
from tests.unit.recording.packet_builders import sensor
from tests.unit.recording.test_cloud_points import PERIOD_NS, REL_NS, decode, with_field
from tests.warned import K, derivations, warned

HOUR_NS = 3_600_000_000_000
BOOT_NS = 5_321_200_000_000
ROWS = [5, 700, 2000]


def damaged(values, wrong):
    out = values.copy()
    out[ROWS] = wrong
    return out


@pytest.mark.parametrize(
    ("name", "values", "wrong"),
    [
        ("t", REL_NS.astype(np.uint32), 3_604_361_924),
        ("time", (REL_NS * 1e-9).astype(np.float32), np.nan),
        ("time", (REL_NS * 1e-9).astype(np.float32), np.inf),
        ("time", (REL_NS * 1e-9).astype(np.float64), -1e30),
        ("timestamp", (REL_NS + T0_NS).astype(np.uint64), 0),
        ("timestamp", (REL_NS + T0_NS).astype(np.uint64), 2**64 - 1),
        ("timestamp", (REL_NS + T0_NS) * 1e-9, 4e9),
        ("time_stamp", (REL_NS // 1000).astype(np.int32), -2_000_000_000),
    ],
)
def test_single_damaged_times_are_dropped_and_the_others_used(name, values, wrong):
    shots, report = decode(with_field(name, damaged(values, wrong)))

    kept = np.delete(REL_NS, ROWS)
    np.testing.assert_allclose(shots.t_ns - T0_NS, kept, atol=1500)
    assert report.counts["points_wrong_time"] == 3
    assert report.counts["clouds_wrong_times"] == 0
    assert not report.findings


def test_many_damaged_times_are_a_field_that_is_not_used_with_numbers():
    values = REL_NS.astype(np.uint32)
    values[::3] = 3_604_361_924

    shots, report = decode(with_field("t", values))

    assert len(shots) == len(REL_NS)
    number = len(REL_NS[::3])
    assert any(f"{number} of {len(REL_NS)} points of a cloud" in text for text in report.lost())
    report.warn_of_losses()
    assert warned(report, K.DATA_LOST, number=1, total=1)
    assert number / len(REL_NS) > LOSSES.warned_ratio


@pytest.mark.parametrize(
    "values",
    [
        (REL_NS + BOOT_NS) * 1e-9,
        (REL_NS + BOOT_NS) * 1e-6,
        REL_NS + BOOT_NS,
        ((REL_NS + BOOT_NS) // 1000).astype(np.int64),
    ],
    ids=["s", "ms", "ns", "us"],
)
def test_times_since_power_on_are_those_of_stamps_since_power_on(values):
    shots, report = decode(with_field("timestamp", values), t_ns=BOOT_NS)

    np.testing.assert_allclose(shots.t_ns - BOOT_NS, REL_NS, atol=3000)
    assert not report.lost() and not report.findings
    assert not any("clock" in text for text in derivations(report))


@pytest.mark.parametrize(
    ("offset_s", "name"),
    [(18.0, "GPS time against UTC"), (37.0, "TAI against UTC"), (-1.6e9, "power-on")],
)
def test_a_constant_offset_of_the_clocks_is_said_with_its_number(offset_s, name):
    ahead_ns = round(offset_s * 1e9)

    shots, report = decode(with_field("t", REL_NS + T0_NS + ahead_ns))

    np.testing.assert_array_equal(shots.t_ns - T0_NS, REL_NS)
    found = next(text for text in derivations(report) if "not the stamps' clock" in text)
    assert f"ahead by {offset_s:+.3f} s" in found and name in found
    assert not report.lost()


def test_times_since_power_on_with_stamps_in_utc_start_at_the_stamp():
    shots, report = decode(with_field("timestamp", (REL_NS + BOOT_NS) * 1e-9))

    np.testing.assert_allclose(shots.t_ns - T0_NS, REL_NS, atol=2000)
    assert any("not the stamps' clock" in text for text in derivations(report))


def test_dates_of_points_go_on_while_a_driver_repeats_its_stamps():
    report = ImportReport()
    decoder = CloudDecoder(0, sensor(), report=report)
    starts = T0_NS + PERIOD_NS * np.arange(9)

    found = [
        decoder.decode(
            with_field("timestamp", (REL_NS + start) * 1e-9),
            t_ns=int(starts[k - k % 4]),
            period_ns=PERIOD_NS,
        ).t_ns
        for k, start in enumerate(starts)
    ]

    np.testing.assert_allclose([t[0] for t in found], starts, atol=500)
    assert not report.findings and not any("clock" in text for text in derivations(report))


@pytest.mark.parametrize("period_ns", [PERIOD_NS, PERIOD_NS // 2])
def test_times_from_0_to_1_are_parts_of_the_time_to_the_next_cloud(period_ns):
    values = (REL_NS / PERIOD_NS).astype(np.float32)
    report = ImportReport()
    decoder = CloudDecoder(0, sensor(), report=report)

    shots = decoder.decode(with_field("time", values), t_ns=T0_NS, period_ns=period_ns)

    expected = REL_NS * period_ns // PERIOD_NS
    np.testing.assert_allclose(shots.t_ns - T0_NS, expected, atol=100)
    assert any("from 0 to 1" in text for text in derivations(report))
    assert not report.lost()


def test_times_from_0_to_1_may_lack_the_sector_of_the_carrier():
    seen = REL_NS < 0.66 * PERIOD_NS
    table = {key: column[seen] for key, column in with_field("time", REL_NS / PERIOD_NS).items()}

    shots, report = decode(table)

    np.testing.assert_allclose(shots.t_ns - T0_NS, REL_NS[seen], atol=100)
    assert any("from 0 to 1" in text for text in derivations(report))


@pytest.mark.parametrize("start_ns", [1_234_500_000_000, HOUR_NS - 40_000_000])
def test_times_within_the_hour_take_the_hour_of_the_stamp(start_ns):
    stamp_ns = T0_NS // HOUR_NS * HOUR_NS + start_ns
    values = ((REL_NS + start_ns) % HOUR_NS) * 1e-9

    shots, report = decode(with_field("time", values), t_ns=stamp_ns)

    np.testing.assert_allclose(shots.t_ns - stamp_ns, REL_NS, atol=2000)
    assert any("begin again every 3600 s" in text for text in derivations(report))
    assert not report.lost()


def test_a_counter_of_32_bits_that_wrapped_before_is_continued_by_the_stamps():
    values = ((REL_NS + BOOT_NS) // 1000 % (1 << 32)).astype(np.uint32)

    shots, report = decode(with_field("t", values), t_ns=BOOT_NS)

    np.testing.assert_allclose(shots.t_ns - BOOT_NS, REL_NS, atol=2000)
    assert any("begin again every 4294.97 s" in text for text in derivations(report))


@pytest.mark.parametrize("unit", [1, 1000])
def test_a_counter_of_32_bits_may_wrap_inside_a_cloud(unit):
    wrap = 1 << 32
    values = ((REL_NS // unit + wrap - 30_000_000 // unit) % wrap).astype(np.uint32)

    shots, report = decode(with_field("t", values))

    np.testing.assert_allclose(shots.t_ns - T0_NS, REL_NS, atol=2000)
    assert report.counts["points_wrong_time"] == 0 and not report.lost()


def test_times_before_the_stamp_stay_before_it():
    shots, _ = decode(with_field("time", (REL_NS - REL_NS[-1]) * 1e-9))

    np.testing.assert_allclose(shots.t_ns - T0_NS, REL_NS - REL_NS[-1], atol=1500)


def test_dates_in_32_bit_floats_are_too_coarse_and_said():
    values = ((REL_NS + T0_NS) * 1e-9).astype(np.float32)

    _, report = decode(with_field("time", values))

    assert report.counts["clouds_wrong_times"] == 1


def test_single_damaged_intensities_do_not_change_the_scale_of_the_others():
    table = with_field("t", REL_NS.astype(np.uint32))
    table["intensity"] = np.linspace(0.0, 1.0, len(REL_NS)).astype(np.float32)
    table["intensity"][ROWS] = [np.nan, np.inf, 1e30]

    shots, report = decode(table)

    assert np.median(shots.intensity) == pytest.approx(127, abs=2)
    assert report.counts["intensity_wrong"] == 2 and report.counts["intensity_clipped"] == 1


@pytest.mark.parametrize("wrong", [np.nan, -5.0, 4000.0])
def test_single_damaged_rings_are_those_of_their_elevation(wrong):
    table = with_field("t", REL_NS.astype(np.uint32))
    true = table["ring"].copy()
    table["ring"] = damaged(true.astype(np.float32), wrong)

    shots, report = decode(table)

    np.testing.assert_array_equal(shots.ring, true)
    assert report.counts["rings_wrong"] == 3


def test_offsets_have_names():
    assert known_offset_s(-17.99) == -18.0
    assert described(-18.012) == "-18.012 s (GPS time against UTC)"
    assert described(7200.1).endswith("(whole hours, as of a time zone)")
    assert described(3.25) == "+3.250 s"


PART_NS = 25_000_000
UNITS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}


def part(first, last):
    """The points between two times of a revolution [ns], with these times."""
    rows = (first <= REL_NS) & (last > REL_NS)
    table = {name: column[rows] for name, column in room_cloud().items()}
    return table, REL_NS[rows]


@pytest.mark.parametrize("few_first", [False, True])
@pytest.mark.parametrize("from_start", [False, True], ids=["of the message", "of the revolution"])
@pytest.mark.parametrize(
    ("unit", "kind"),
    [("ns", "u4"), ("us", "u4"), ("us", "i4"), ("us", "f4"), ("ms", "f4"), ("s", "f4")],
)
def test_times_of_a_part_of_a_revolution_are_in_the_unit_that_fits_it(
    unit, kind, from_start, few_first
):
    report = ImportReport()
    decoder = CloudDecoder(0, sensor(model="generic"), report=report)
    sizes = [2_000_000, PART_NS] if few_first else [PART_NS, 300_000]
    for k, size_ns in enumerate(sizes):
        start_ns = k * PART_NS
        table, since_ns = part(start_ns + PART_NS - size_ns, start_ns + PART_NS)
        stamp_ns = 0 if from_start else start_ns
        table["time"] = ((since_ns - stamp_ns) / UNITS[unit]).astype(kind)

        shots = decoder.decode(table, t_ns=T0_NS + stamp_ns, period_ns=PART_NS)

        np.testing.assert_allclose(shots.t_ns - T0_NS, np.sort(since_ns), atol=5000)
    assert report.findings == []
    assert not report.counts["clouds_wrong_times"]
