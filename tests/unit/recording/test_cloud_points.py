"""Fields of clouds to shots: aliases, units, and what is worked out."""

import numpy as np
import pytest

from recon4.errors import UnknownFormat
from recon4.model.import_notes import CLOUDS_UNTIMED
from recon4.recording.clouds.cloud_points import CloudDecoder, model_of_points
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS, room_cloud, spin
from tests.unit.recording.packet_builders import sensor
from tests.warned import K, derivations, warned

PERIOD_NS = 100_000_000


def decode(table, *, model="generic", t_ns=T0_NS, **options):
    report = ImportReport()
    decoder = CloudDecoder(0, sensor(model=model), report=report, **options)
    return decoder.decode(table, t_ns=t_ns, period_ns=PERIOD_NS), report


def without(table, *names):
    return {key: column for key, column in table.items() if key not in names}


def with_field(name, values):
    return without(room_cloud(), "time") | {name: values}


TRUE = spin(seconds=0.1)
REL_NS = TRUE.t_ns - TRUE.t_ns[0]


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("time", (REL_NS * 1e-9).astype(np.float32)),
        ("t", REL_NS.astype(np.uint32)),
        ("offset_time", REL_NS.astype(np.uint32)),
        ("timestamp", (T0_NS // 10**9 + (REL_NS + T0_NS % 10**9) * 1e-9).astype(np.float64)),
        ("timestamp", TRUE.t_ns.astype(np.uint64)),
        ("time_stamp", (REL_NS // 1000).astype(np.uint32)),
        ("time", (REL_NS * 1e-6).astype(np.float64)),
    ],
    ids=["s", "ns", "livox ns", "absolute s", "absolute ns", "us", "ms"],
)
def test_every_spelling_of_time_gives_the_same_times(name, values):
    shots, report = decode(with_field(name, values))

    np.testing.assert_allclose(shots.t_ns - T0_NS, REL_NS, atol=1500)
    assert not any("time" in text for text in derivations(report))


def test_points_come_in_order_of_time():
    table = {key: column[::-1].copy() for key, column in room_cloud().items()}

    shots, _ = decode(table)

    assert (np.diff(shots.t_ns) >= 0).all()


def test_time_is_worked_out_from_azimuth_in_firing_order():
    shots, report = decode(without(room_cloud(start_turn=0.3), "time"))

    np.testing.assert_allclose(shots.t_ns - T0_NS, REL_NS, atol=1e6)
    assert warned(report, K.POINTS_TIMED_BY_AZIMUTH, order="firing")


def test_the_order_of_firing_is_seen_without_the_sector_of_the_carrier():
    seen = REL_NS < 0.66 * PERIOD_NS
    table = without(room_cloud(start_turn=0.3), "time")

    shots, report = decode({key: column[seen] for key, column in table.items()})

    np.testing.assert_allclose(shots.t_ns - T0_NS, REL_NS[seen], atol=1e6)
    assert warned(report, K.POINTS_TIMED_BY_AZIMUTH, order="firing")


def test_a_turn_of_few_points_is_timed_too():
    few = np.linspace(0, len(REL_NS) - 1, 24).astype(int)
    table = without(room_cloud(), "time")

    shots, report = decode({key: column[few] for key, column in table.items()})

    np.testing.assert_allclose(shots.t_ns - T0_NS, REL_NS[few], atol=5e6)
    assert warned(report, K.POINTS_TIMED_BY_AZIMUTH, order="firing")


def test_time_is_worked_out_from_azimuth_ring_by_ring():
    table = without(room_cloud(), "time")
    order = np.argsort(table["ring"], kind="stable")

    shots, report = decode({key: column[order] for key, column in table.items()})

    assert warned(report, K.POINTS_TIMED_BY_AZIMUTH, order="from-rear")
    np.testing.assert_allclose(shots.t_ns - T0_NS, REL_NS, atol=1e6)
    quarter = np.searchsorted(shots.t_ns - T0_NS, 26_000_000)
    assert shots.xyz[quarter, 1] > 2.9  # clockwise from the rear: the left side comes first


def test_times_that_make_no_sense_are_not_used_and_said():
    shots, report = decode(with_field("time", np.full(len(REL_NS), 7.0)))

    np.testing.assert_allclose(shots.t_ns - T0_NS, REL_NS, atol=1e6)
    assert any("1 of 1 clouds" in text and "have the time 7" in text for text in report.lost())


def test_times_that_are_nearly_equal_are_not_used_and_said():
    table = room_cloud()
    table["time"] = np.linspace(0.0, 1e-5, len(table["x"]))

    shots, report = decode(table)

    assert np.ptp(shots.t_ns) > 50_000_000
    assert any("'time': the points of a revolution are within" in t for t in report.lost())


def test_a_clock_of_its_own_is_tied_to_the_stamps():
    other = (REL_NS + 55_000_000_000_000_000 * 30).astype(np.uint64)

    shots, report = decode(with_field("t", other))

    np.testing.assert_array_equal(shots.t_ns - T0_NS, REL_NS)
    assert any("not the stamps' clock" in text for text in derivations(report))


def test_ring_is_worked_out_from_elevation():
    table = room_cloud()

    shots, report = decode(without(table, "ring"))

    np.testing.assert_array_equal(shots.ring, table["ring"])
    assert any("ring is taken from the elevation" in text for text in derivations(report))


@pytest.mark.parametrize("value", [0, 7])
def test_a_ring_that_is_the_same_everywhere_is_worked_out_from_elevation(value):
    table = room_cloud()

    shots, report = decode(table | {"ring": np.full_like(table["ring"], value)}, model="VLP-16")

    assert np.array_equal(shots.ring, decode(table, model="VLP-16")[0].ring)
    assert any(f"lidar: ring is {value} everywhere. The" in one for one in derivations(report))


def test_one_beam_has_one_ring_without_a_word():
    table = room_cloud()
    beam = {name: column[table["ring"] == 3] for name, column in table.items()}

    shots, report = decode(beam)

    assert set(shots.ring.tolist()) == {3}
    assert not any("everywhere" in text for text in derivations(report))


@pytest.mark.parametrize("value", [0.0, 100.0, np.nan])
def test_an_intensity_that_is_the_same_everywhere_is_said(value):
    table = room_cloud()
    spread = np.linspace(0, 90, len(table["x"])).astype(np.float32)

    _, report = decode(table | {"intensity": np.full_like(spread, value)})
    _, fine = decode(table | {"intensity": spread})

    said = "no number" if np.isnan(value) else f"{value:g}"
    assert derivations(report) == [
        f"lidar: intensity is {said} in all points of a cloud: it was not measured."
    ]
    assert not any("not measured" in text for text in derivations(fine))


def test_rings_counted_from_the_top_are_turned_around():
    table = room_cloud()

    shots, report = decode(table | {"ring": (15 - table["ring"]).astype(np.uint8)})

    np.testing.assert_array_equal(shots.ring, table["ring"])
    assert any("renumbered" in text for text in derivations(report))


def test_lasers_in_the_order_of_firing_are_put_in_order_of_elevation():
    table = room_cloud()
    shuffled = np.random.default_rng(3).permutation(16)

    shots, _ = decode(table | {"ring": shuffled[table["ring"]].astype(np.uint16)})

    np.testing.assert_array_equal(shots.ring, table["ring"])


def test_invalid_points_are_dropped_and_counted():
    table = room_cloud()
    table["x"][:10] = np.nan
    table["y"][10:15] = np.inf
    for axis in "xyz":
        table[axis][15:35] = 0.0

    shots, report = decode(table)

    assert len(shots) == len(table["x"]) - 35
    assert report.counts["points_invalid"] == 35


def test_a_share_of_one_is_an_intensity_of_255():
    table = room_cloud() | {"intensity": np.linspace(0, 1, len(REL_NS), dtype=np.float32)}

    shots, report = decode(table)

    assert shots.intensity.max() == 255
    assert any("0..1" in text for text in derivations(report))


def test_intensities_too_large_are_clipped_and_counted():
    values = np.full(len(REL_NS), 70000.0, np.float32)

    shots, report = decode(room_cloud() | {"intensity": values})

    assert set(shots.intensity.tolist()) == {65535}
    assert report.counts["intensity_clipped"] == len(values)


def test_an_empty_cloud_gives_nothing():
    shots, _ = decode({key: column[:0] for key, column in room_cloud().items()})

    assert len(shots) == 0


def test_a_cloud_without_z_is_refused():
    with pytest.raises(UnknownFormat, match="needs x, y and z"):
        decode(without(room_cloud(), "z"))


def test_the_model_is_known_by_its_beams():
    assert model_of_points(room_cloud()) == "VLP-16"
    rng = np.random.default_rng(2)
    noise = {axis: rng.normal(size=5000) for axis in "xyz"}
    assert model_of_points(noise) == "generic"


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_a_cloud_without_points_does_not_accuse_the_times_of_the_others(value):
    table = room_cloud()
    table |= {axis: np.full(len(table["x"]), value, np.float32) for axis in "xyz"}

    shots, report = decode(table)

    assert len(shots) == 0
    assert report.findings == []
    assert report.counts["points_invalid"] == len(table["x"])


@pytest.mark.parametrize(
    ("table", "deskewed", "untimed"),
    [
        (room_cloud(), False, 0),
        (room_cloud(), True, 1),
        (without(room_cloud(), "time"), False, 1),
        ({key: column[:0] for key, column in room_cloud().items()}, True, 0),
    ],
    ids=["times of points", "undistorted", "times from azimuths", "empty"],
)
def test_clouds_whose_points_have_no_times_are_counted(table, deskewed, untimed):
    _, report = decode(table, settings=IngestSettings(deskewed=deskewed))

    assert report.counts[CLOUDS_UNTIMED] == untimed
