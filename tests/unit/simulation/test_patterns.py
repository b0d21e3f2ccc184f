"""Every model fires by its own pattern, and its packets say what the rays met."""

import json

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.se3 import SE3
from recon4.model.lidars import lidar_model
from recon4.model.rig import load_rig
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.recording.ingest import ingest
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import Companion, PacketSensor
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.degradation import Degradation
from recon4.simulation.families.families import family_of, pattern_of, simulated_models
from recon4.simulation.lidar import Firings, Lidar, LidarModel
from recon4.simulation.packets import pack_imu
from recon4.simulation.setup import imu_row, prepare, rig_of_lidars
from recon4.simulation.simulate import simulate
from recon4.store.frames import FrameStore
from tests.unit.recording.ouster_packets import datagrams_of
from tests.unit.simulation.rooms import PERFECT, around, still

MODELS = simulated_models()
START_NS = 1_780_308_000_000_000_000
HALF_M = np.array([9.0, 7.0, 5.0])
"""Halves of a closed room around the sensor [m]; no pillar, so that every shot returns."""
PACKETS = 12


def closed_room():
    builder = MeshBuilder()
    for axis in range(3):
        u, v = np.roll(np.diag(2.0 * HALF_M), -axis - 1, axis=0)[:2]
        for sign in (-1.0, 1.0):
            corner = -HALF_M.copy()
            corner[axis] *= -sign
            builder.quad(corner, u, v, reflectivity=0.5)
    return around(builder)


def lidar_of(model, errors=PERFECT, seed=3):
    sensor = rig_of_lidars([model]).sensors[0]
    return Lidar.drawn(sensor, pattern_of(model), model=errors, rng=np.random.default_rng(seed))


def fired(lidar, packets=PACKETS):
    height_m = -float(lidar.sensor.T_body_sensor.t[2])  # puts the sensor into the middle
    walk = still(height_m=height_m)
    return lidar.fire(range(packets), walk, closed_room(), rng=np.random.default_rng(7))


def packets_of(lidar, firings):
    start_ns = firings.t_ns[:, 0, 0] - lidar.pattern.offset_ns[0, 0]
    return family_of(lidar.pattern.model).data_packets(lidar, firings, START_NS + start_ns)


def packet_sensor(lidar, payloads, report):
    """What the reader knows of a sensor."""
    files = family_of(lidar.pattern.model).companions(lidar).items()
    return PacketSensor(
        row=0,
        sensor=lidar.sensor,
        head=datagrams_of(payloads, port=lidar.sensor.port),
        companions=[Companion(name, content) for name, content in files],
        settings=IngestSettings(min_range_m=0.0, max_range_m=900.0),
        report=report,
    )


def opened(lidar, payloads, report):
    """The reader's side of a sensor."""
    family = next(f for f in FAMILIES if f.name == lidar_model(lidar.pattern.model).maker)
    return family.open(packet_sensor(lidar, payloads, report))


@pytest.mark.parametrize("model", ["VLP-16", "OS0-32", "XT32", "JT128", "Mid-360", "Airy"])
def test_a_second_of_which_all_packets_are_lost_has_none(model):
    lidar = lidar_of(model)
    shape = (0, *lidar.pattern.offset_ns.shape)
    firings = Firings(
        np.empty(shape, np.int64),
        np.empty(shape),
        np.empty(shape, np.uint32),
        *np.empty((2, *shape), np.uint8),
    )

    assert len(packets_of(lidar, firings)) == 0
    imu = family_of(model).imu(model)
    none = ImuSamples(np.empty(0, np.int64), *np.empty((2, 0, 3)))
    assert imu is None or imu.packets is None or len(imu.packets(none)) == 0


@pytest.mark.parametrize("model", MODELS)
def test_the_reader_gets_every_shot_where_and_when_it_ended(model):
    lidar, report = lidar_of(model), ImportReport()
    firings = fired(lidar)
    payloads = packets_of(lidar, firings)
    reader = opened(lidar, payloads, report)

    assert reader.sound(payloads).all()
    stamps_ns = reader.stamps_ns(payloads)
    shots = reader.decode(stamps_ns, payloads)

    assert len(shots) == np.count_nonzero(firings.distance)
    off_m = np.abs(np.abs(shots.xyz) - HALF_M).min(axis=1)
    assert np.quantile(off_m, 0.99) < 0.005
    assert off_m.max() < 0.02
    expected_ns = np.sort(firings.t_ns[firings.distance > 0])
    since_ns = np.sort(shots.t_ns) - shots.t_ns.min()
    assert np.abs(since_ns - (expected_ns - expected_ns[0])).max() < 2000  # stamps are in µs
    assert abs(np.median(np.diff(stamps_ns)) - lidar.pattern.packet_ns) < 1000
    assert reader.packet_s == pytest.approx(1e-9 * lidar.pattern.packet_ns, rel=1e-3)


@pytest.mark.parametrize("model", MODELS)
def test_a_pattern_fills_the_field_of_view_of_the_data_sheet(model):
    pattern, facts = pattern_of(model), lidar_model(model)
    turn = 2.0 * np.pi * pattern.turn_hz * np.arange(0.0, 2.0, 2e-5)
    laser = np.arange(len(turn)) % pattern.lasers

    found = pattern.motion.directions(turn, laser)

    elevation = np.rad2deg(found.elevation_rad)
    low, high = facts.elevation_deg
    assert elevation.min() > low - 1.0 and elevation.max() < high + 1.0
    assert np.ptp(elevation) > 0.75 * (high - low)  # tables of one unit may leave out the ends
    around_deg = np.rad2deg(np.mod(found.azimuth_rad + np.pi, 2.0 * np.pi) - np.pi)
    assert np.ptp(around_deg) == pytest.approx(facts.azimuth_deg, abs=1.5)
    assert len(np.unique(pattern.ring)) <= pattern.lasers


@pytest.mark.parametrize("model", ["Mid-360", "Avia"])
def test_a_rosette_covers_more_of_its_view_the_longer_it_looks(model):
    pattern = pattern_of(model)

    def covered(seconds, since_s=0.0):
        t_s = since_s + np.arange(0.0, seconds, 1e-4 / 8)
        laser = np.arange(len(t_s)) % pattern.lasers
        seen = pattern.motion.directions(2.0 * np.pi * pattern.turn_hz * t_s, laser)
        azimuth = np.mod(np.rad2deg(seen.azimuth_rad), 360.0)
        cells = np.stack([azimuth, np.rad2deg(seen.elevation_rad)]) // 0.25
        return {tuple(cell) for cell in cells.T.tolist()}

    tenth, later, second = covered(0.1), covered(0.1, since_s=0.5), covered(1.0)

    assert len(second) > 1.5 * len(tenth)
    assert len(later - tenth) > 0.2 * len(later)


def test_errors_grow_and_shrink_as_the_data_sheets_say():
    own = LidarModel()
    vlp16, mid360 = own.of(pattern_of("VLP-16")), own.of(pattern_of("Mid-360"))
    facts = lidar_model("Mid-360")

    assert vlp16 == own
    assert mid360.range_sd_m == pytest.approx(facts.range_sd_m)
    assert mid360.min_range_m == pytest.approx(facts.min_range_m)
    assert mid360.weakest_signal == pytest.approx(0.1 / facts.range_m**2)
    assert LidarModel.perfect().of(pattern_of("Mid-360")).range_sd_m == 0.0


def test_a_rig_names_the_lidar_whose_imu_is_simulated():
    rig = rig_of_lidars(["VLP-16", "Avia"])

    assert rig.imu_sensor == rig.sensors[1].name
    assert imu_row(rig) == 1
    assert imu_row(rig_of_lidars(["JT128", "Avia"])) == 0  # both have one
    assert rig_of_lidars(["XT32"]).imu_sensor == ""


def imu_models():
    made = {model: family_of(model).imu(model) for model in MODELS}
    return [model for model, imu in made.items() if imu is not None and imu.packets is not None]


@pytest.mark.parametrize("model", imu_models())
def test_the_imu_of_a_lidar_is_read_as_it_measured(model):
    lidar, report = lidar_of(model), ImportReport()
    firings = fired(lidar, packets=300)
    payloads = packets_of(lidar, firings)
    reader = opened(lidar, payloads, report)
    stamps_ns = reader.stamps_ns(payloads)
    clock = SensorClock("lidar", packet_s=reader.packet_s, report=report)
    clock.push_ns(stamps_ns, stamps_ns)
    rng, at_ns = np.random.default_rng(1), stamps_ns[0] + np.arange(10) * 10_000_000
    samples = ImuSamples(at_ns, rng.normal(size=(10, 3)), rng.normal(9.0, 1.0, size=(10, 3)))

    sent = family_of(model).imu(model).packets(samples)
    found = reader.samples(datagrams_of(sent, t_ns=at_ns), clock).imu

    coarse = {"JT16": (3e-4, 1e-3), "Airy": (6e-4, 3e-3)}  # half a number of their packets
    gyro, accel = coarse.get(model, (1e-4, 1e-3))
    np.testing.assert_allclose(found.t_ns, at_ns, atol=2000)
    np.testing.assert_allclose(found.gyro_rad_s, samples.gyro_rad_s, atol=gyro)
    np.testing.assert_allclose(found.accel_m_s2, samples.accel_m_s2, atol=accel)


def test_the_imu_of_a_jt128_is_in_its_data_packets():
    lidar, report = lidar_of("JT128"), ImportReport()
    payloads = packets_of(lidar, fired(lidar, packets=300))
    reader = opened(lidar, payloads, report)
    t_ns = reader.stamps_ns(payloads)
    rng, at_ns = np.random.default_rng(1), t_ns[3] + np.arange(6) * 5_000_000 + 1_000
    samples = ImuSamples(at_ns, rng.normal(size=(6, 3)), rng.normal(9.0, 1.0, size=(6, 3)))
    clock = SensorClock("lidar", packet_s=reader.packet_s, report=report)
    clock.push_ns(t_ns, t_ns)

    family_of("JT128").imu("JT128").within(payloads, samples)
    found = reader.samples(datagrams_of(payloads, t_ns=t_ns), clock).imu

    assert reader.sound(payloads).all()  # sums are right
    late_ns = found.t_ns[1:] - at_ns[1:]
    assert (late_ns > -1e9 * reader.packet_s).all() and (late_ns <= 1e9 * reader.packet_s).all()
    np.testing.assert_allclose(found.gyro_rad_s, samples.gyro_rad_s, atol=np.deg2rad(0.071))
    np.testing.assert_allclose(found.accel_m_s2, samples.accel_m_s2, atol=0.0025)


def test_the_imu_of_an_airy_has_a_port_and_axes_of_its_own():
    setup = prepare("office", seconds=5.0, seed=1, rig=rig_of_lidars(["Airy"]))
    samples = ImuSamples(setup.epoch_ns + np.arange(3), *np.zeros((2, 3, 3)))

    sent = pack_imu(samples, 0, setup, degradation=Degradation.drawn({}, lasers=[96], seed=1))

    assert sent.port == 6688
    turned = setup.rig.sensors[0].T_body_sensor.inverse() @ setup.rig.T_body_imu
    np.testing.assert_allclose(turned.R, [[0, -1, 0], [-1, 0, 0], [0, 0, -1]], atol=1e-12)


def test_a_rig_of_two_makes_has_ports_of_both_and_the_imu_that_is_in_one():
    rig = rig_of_lidars(["VLP-16", "Mid-360"])
    both = rig_of_lidars(["VLP-16", "VLP-16"])

    assert [(s.model, s.port) for s in rig.sensors] == [("VLP-16", 2368), ("Mid-360", 56301)]
    assert imu_row(rig) == 1
    in_lidar = SE3(np.eye(3), np.array([0.011, 0.02329, -0.04412]))
    off = (rig.sensors[1].T_body_sensor @ in_lidar).inverse() @ rig.T_body_imu
    np.testing.assert_allclose(off.matrix(), np.eye(4), atol=1e-12)
    assert [s.port for s in both.sensors] == [2368, 2369]
    assert imu_row(both) is None


def test_a_model_that_is_not_simulated_is_refused_with_those_that_are():
    with pytest.raises(ConfigError, match=r"'generic' is not simulated; simulated: VLP-16, "):
        rig_of_lidars(["generic"])
    with pytest.raises(ConfigError, match="expected one or two LiDARs, got 3"):
        rig_of_lidars(["VLP-16"] * 3)


def test_the_drawn_sensors_of_a_walk_are_those_of_the_rig():
    setup = prepare("office", seconds=5.0, seed=1, rig=rig_of_lidars(["Mid-360", "VLP-32C"]))

    assert [lidar.pattern.model for lidar in setup.lidars] == ["Mid-360", "VLP-32C"]
    assert setup.imu_row == 0 and setup.models.imu.rate_hz == 200


@pytest.mark.parametrize(
    ("degradations", "message"),
    [
        ({"dead-beams": 6.0}, "dead-beams: at most 4 of a LiDAR here, got 6"),
        ({"wrong-model": 1.0}, "wrong-model: only possible if the last LiDAR is a Velodyne"),
    ],
)
def test_what_a_model_does_not_have_is_refused(degradations, message, mid360, tmp_path):
    with pytest.raises(ConfigError, match=message):
        simulate(mid360, tmp_path / "out", progress=Silent(), degradations=degradations)


@pytest.fixture(scope="module")
def mid360():
    return prepare("office", seconds=5.0, seed=1, rig=rig_of_lidars(["Mid-360"]))


def test_a_recorded_walk_has_all_returns_and_the_imu_of_the_lidar(mid360, tmp_path):
    simulate(mid360, tmp_path / "walk", progress=Silent())
    sources = Sources(
        (tmp_path / "walk" / "recording.pcap",), load_rig(tmp_path / "walk" / "rig.toml")
    )

    ingest(sources, tmp_path / "store", settings=IngestSettings(), progress=Silent())

    store = FrameStore.open(tmp_path / "store")
    returns = np.load(tmp_path / "walk" / "reflectivity.npz")["sensor0"] > 0
    counts = store.report["counts"]
    outside = sum(counts.get(f"points_{where}", 0) for where in ("near", "far"))
    assert store.points + outside == np.count_nonzero(returns) > 500_000
    assert store.imu is not None and len(store.imu) == pytest.approx(1000, abs=2)
    assert not (tmp_path / "walk" / "imu.csv").exists()
    world = json.loads((tmp_path / "walk" / "world.json").read_text())
    assert [lidar["model"] for lidar in world["lidars"]] == ["Mid-360"]
