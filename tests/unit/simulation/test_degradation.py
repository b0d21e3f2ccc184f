import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.model.rig import load_rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.packets.velodyne.models import MODELS
from recon4.recording.samples.csv_files import read_imu_csv
from recon4.simulation.degradation import KINDS, Degradation, parse_degradations
from recon4.simulation.families.families import pattern_of
from recon4.simulation.imu import ImuModel
from recon4.simulation.lidar import Firings, Lidar, LidarModel
from recon4.simulation.recorder import true_rig
from recon4.simulation.setup import models_with, prepare
from recon4.simulation.simulate import record, simulate
from recon4.units import STANDARD_GRAVITY_M_S2
from tests.unit.simulation.rooms import still, walls
from tests.unit.simulation.test_simulate import datagrams, hashes

RIG = load_rig("4recon")
VLP16 = pattern_of("VLP-16")


def degraded(*words):
    return Degradation.drawn(parse_degradations(words), lasers=[16, 16], seed=5)


def angle_deg(a, b):
    return np.rad2deg((a.inverse() @ b).angle())


def shots(packets=400):
    shape = (packets, 24, 16)
    return Firings(
        np.zeros(shape, np.int64),
        np.zeros(shape),
        np.full(shape, 2000, np.uint32),
        np.full(shape, 50, np.uint8),
        np.full(shape, 60, np.uint8),
    )


def imu_samples():
    rng = np.random.default_rng(1)
    t_ns = 10**18 + np.arange(200, dtype=np.int64) * 5_000_000
    return ImuSamples(t_ns, rng.normal(size=(200, 3)), rng.normal(size=(200, 3)))


def test_without_a_value_a_degradation_has_the_usual_one():
    assert parse_degradations(["extrinsics", "packet-loss=0.1"]) == {
        "extrinsics": KINDS["extrinsics"].usual,
        "packet-loss": 0.1,
    }


@pytest.mark.parametrize(
    ("word", "message"),
    [
        ("rain", "no degradation named 'rain'; there are: extrinsics"),
        ("extrinsics=much", "extrinsics: expected a number, got 'much'"),
        ("packet-loss=1", "packet-loss: expected more than 0 and at most 0.95, got 1"),
        ("lever-arm=nan", "lever-arm: expected more than 0"),
        ("dead-beams=-1", "dead-beams: expected more than 0"),
    ],
)
def test_a_wrong_degradation_is_refused(word, message):
    with pytest.raises(ConfigError, match=message):
        parse_degradations([word])


def test_the_rig_file_has_the_last_lidar_rotated():
    rig = degraded("extrinsics=1.4", "mount-shift=0.05").nominal_rig(RIG)

    assert angle_deg(rig.sensors[1].T_body_sensor, RIG.sensors[1].T_body_sensor) == pytest.approx(
        1.4
    )
    shift = rig.sensors[1].T_body_sensor.t - RIG.sensors[1].T_body_sensor.t
    assert np.linalg.norm(shift) == pytest.approx(0.05)
    assert rig.sensors[0] is RIG.sensors[0]


def test_the_rig_file_is_wrong_in_one_thing_only():
    swapped = degraded("swap-lidars").nominal_rig(RIG).sensors
    named = degraded("wrong-model").nominal_rig(RIG).sensors
    turned = degraded("imu-rotation=2").nominal_rig(RIG)
    moved = degraded("lever-arm=0.15").nominal_rig(RIG)

    for one, other in ((0, 1), (1, 0)):
        difference = swapped[one].T_body_sensor.inverse() @ RIG.sensors[other].T_body_sensor
        np.testing.assert_allclose(difference.matrix(), np.eye(4), atol=1e-12)
    assert [sensor.name for sensor in swapped] == [sensor.name for sensor in RIG.sensors]
    assert [sensor.model for sensor in named] == ["VLP-16", "HDL-32E"]
    assert angle_deg(turned.T_body_imu, RIG.T_body_imu) == pytest.approx(2.0)
    assert np.linalg.norm(moved.p_body_antenna - RIG.p_body_antenna) == pytest.approx(0.15)


def test_an_imu_can_be_wrong_in_unit_scale_axes_and_clock():
    true = imu_samples()
    in_g, scaled = degraded("imu-unit").imu(true), degraded("imu-scale=0.03").imu(true)
    swapped = degraded("imu-axes").imu(true)
    late = degraded("imu-clock=0.02", "imu-drift=1000").imu(true)

    np.testing.assert_allclose(in_g.accel_m_s2 * STANDARD_GRAVITY_M_S2, true.accel_m_s2)
    np.testing.assert_allclose(in_g.gyro_rad_s, true.gyro_rad_s)
    np.testing.assert_allclose(scaled.gyro_rad_s, 1.03 * true.gyro_rad_s)
    np.testing.assert_allclose(swapped.accel_m_s2[:, :2], true.accel_m_s2[:, [1, 0]])
    np.testing.assert_allclose(  # still right-handed
        np.cross(swapped.gyro_rad_s, swapped.accel_m_s2)[:, 2],
        -np.cross(true.gyro_rad_s, true.accel_m_s2)[:, 2],
    )
    assert late.t_ns[0] - true.t_ns[0] == 20_000_000
    assert late.t_ns[-1] - true.t_ns[-1] == 20_000_000 + round(1e-3 * (199 * 5_000_000))


def test_a_cheaper_imu_has_larger_errors_of_every_kind():
    model = degraded("imu-grade=5").imu_model(ImuModel())

    assert model.gyro_bias_rad_s == 5.0 * ImuModel().gyro_bias_rad_s
    assert model.accel_noise_m_s2_hz == 5.0 * ImuModel().accel_noise_m_s2_hz


def test_dead_lasers_return_nothing_and_the_others_all():
    found = degraded("dead-beams=6").degrade_firings(shots(), 0, 0, pattern=VLP16)

    per_laser = (found.distance > 0).mean(axis=(0, 1))
    assert sorted(per_laser) == [0.0] * 6 + [1.0] * 10
    assert np.array_equal(found.reflectivity > 0, found.distance > 0)


def test_each_laser_has_a_range_bias_of_its_own():
    degradation = degraded("beam-bias=0.03")
    found = degradation.degrade_firings(shots(), 1, 0, pattern=VLP16)

    off_m = 0.002 * (found.distance.astype(float) - 2000.0)
    np.testing.assert_allclose(off_m[0, 0], degradation.range_bias_m[1], atol=0.0021)
    np.testing.assert_allclose(off_m.mean(axis=(0, 1)), degradation.range_bias_m[1], atol=1e-4)
    assert np.std(degradation.range_bias_m) == pytest.approx(0.03, rel=0.4)
    nothing = replace_distance(shots(), 0)
    assert not degradation.degrade_firings(nothing, 1, 0, pattern=VLP16).distance.any()


def test_the_true_rig_corrects_what_the_beams_measure_wrong():
    """A room of planes: with the true corrections the points of all beams lie on them again."""
    words = ("beam-bias=0.05", "beam-angle=1")
    values = parse_degradations(words)
    models = models_with(values)
    perfect = replace(LidarModel.perfect(), beam_angle_sd_rad=models.lidar.beam_angle_sd_rad)
    surroundings = walls(6.0)
    lidars = [
        Lidar.drawn(sensor, VLP16, model=perfect, rng=np.random.default_rng([5, 1, row]))
        for row, sensor in enumerate(RIG.sensors)
    ]
    degradation = degraded(*words)
    firings = lidars[0].fire(range(76), still(), surroundings, rng=np.random.default_rng(1))
    fired = degradation.degrade_firings(firings, 0, 0, pattern=VLP16)
    xyz, ring = points_of(fired)
    setup = SimpleNamespace(lidars=lidars, rig=RIG)

    corrected, unknown = true_rig(setup, degradation).sensors[0].beams.apply(xyz, ring)

    ahead = np.abs(np.arctan2(xyz[:, 1], xyz[:, 0])) < 0.6
    assert ahead.sum() > 1000 and unknown == 0
    assert np.std(xyz[ahead, 0]) > 0.03
    assert np.std(corrected[ahead, 0]) < 0.004
    assert abs(corrected[ahead, 0].mean() - 6.0) < 0.002


def points_of(fired):
    """Points in the frame of the sensor, by the tables of the data sheet, and their rings."""
    tables, hit = MODELS["VLP-16"], fired.distance > 0
    up = np.broadcast_to(tables.elevation_rad, hit.shape)[hit]
    above = np.broadcast_to(tables.height_m, hit.shape)[hit]
    range_m, around = 0.002 * fired.distance[hit], fired.turn_rad[hit]
    flat = range_m * np.cos(up)
    z = range_m * np.sin(up) + above
    xyz = np.stack([flat * np.cos(around), -flat * np.sin(around), z], axis=1)
    return xyz, np.broadcast_to(tables.ring, hit.shape)[hit]


def test_the_angles_of_beams_must_be_those_the_rays_were_prepared_for(tmp_path):
    setup = prepare("office", seconds=5.0, seed=1)

    with pytest.raises(ConfigError, match=r"beam-angle: the rays were prepared for 0, got 0\.03"):
        simulate(setup, tmp_path / "x", degradations={"beam-angle": 0.03}, progress=Silent())


def replace_distance(firings, value):
    return replace(firings, distance=np.full_like(firings.distance, value))


def test_packets_are_lost_in_runs():
    marked = replace(shots(), t_ns=np.broadcast_to(np.arange(400)[:, None, None], (400, 24, 16)))
    kept = [
        degraded("packet-loss=0.25").degrade_firings(marked, 0, second, pattern=VLP16).t_ns[:, 0, 0]
        for second in range(40)
    ]

    assert sum(map(len, kept)) / (40 * 400) == pytest.approx(0.75, abs=0.03)
    runs = np.concatenate([np.diff(rows)[np.diff(rows) > 1] - 1 for rows in kept])
    assert runs.mean() == pytest.approx(6.0, rel=0.15)


@pytest.fixture(scope="module")
def recordings(tmp_path_factory):
    """Five seconds in the tunnel: as it should be, and with the last LiDAR's clock off."""
    root = tmp_path_factory.mktemp("degraded")
    setup = prepare("tunnel", seconds=5.0, seed=3)
    folders = {
        root / "clean": {},
        root / "clock": {"lidar-clock": 0.02, "lever-arm": 0.15, "no-imu": 1.0},
        root / "late": {"late-start": 1.5, "imu-clock": 0.02},
    }
    record(setup, folders, bag=False, progress=Silent())
    return root


@pytest.mark.study
def test_recordings_of_one_walk_differ_in_their_degradations_only(recordings, tmp_path):
    simulate(
        prepare("tunnel", seconds=5.0, seed=3), tmp_path / "alone", bag=False, progress=Silent()
    )
    clean, clock = hashes(recordings / "clean"), hashes(recordings / "clock")

    assert hashes(tmp_path / "alone") == clean
    assert {name for name in clean if clock.get(name) == clean[name]} == {
        "truth.tum", "model.ply", "markers.csv", "reflectivity.npz",
    }  # fmt: skip
    assert "imu.csv" not in clock


@pytest.mark.study
def test_the_stamps_of_one_lidar_are_ahead_and_arrivals_are_not(recordings):
    def packets(name, port):
        return [
            (t_s, int.from_bytes(payload[1200:1204], "little"))
            for t_s, _, to, payload in datagrams(recordings / name / "recording.pcap")
            if to == port
        ]

    for port, ahead_us in ((2368, 0), (2369, 20_000)):
        clean, clock = np.array(packets("clean", port)), np.array(packets("clock", port))
        assert np.array_equal(clean[:, 0], clock[:, 0])
        assert np.all(clock[:, 1] - clean[:, 1] == ahead_us)


def test_the_truth_names_the_degradations_and_the_rig_file_does_not(recordings):
    folder = recordings / "clock"
    named = json.loads((folder / "world.json").read_text())["degradations"]
    said, true = load_rig(folder / "rig.toml"), load_rig(folder / "rig_true.toml")

    assert named["lidar-clock"]["value"] == 0.02
    assert "clock of the last LiDAR" in named["lidar-clock"]["text"]
    off_m = 0.15 * np.array(named["lever-arm"]["direction_body"])
    np.testing.assert_allclose(said.p_body_antenna - true.p_body_antenna, off_m, atol=1e-12)
    np.testing.assert_allclose(true.p_body_antenna, RIG.p_body_antenna)
    assert said.sensors[1].time_offset_s == 0.0
    assert not (recordings / "clean" / "rig_true.toml").exists()
    assert read_tum(folder / "truth.tum").t_ns[0] == read_tum(
        recordings / "clean" / "truth.tum"
    ).t_ns[0]  # fmt: skip


def test_a_late_recording_has_nothing_from_before_it_began(recordings):
    def stamps(name):
        """Microseconds of the hour in data packets of both LiDARs, and arrivals of positions."""
        data, arrivals = {2368: [], 2369: []}, []
        for t_s, _, port, payload in datagrams(recordings / name / "recording.pcap"):
            if port in data:
                data[port].append(int.from_bytes(payload[1200:1204], "little"))
            else:
                arrivals.append(t_s)
        return data, arrivals

    (clean, clean_s), (late, late_s) = stamps("clean"), stamps("late")
    for port, sent in clean.items():
        assert sent[0] < 10_000  # the walk begins at the full hour
        assert late[port] == [us for us in sent if us >= 1_500_000]
    assert late_s == [t_s for t_s in clean_s if t_s % 3600.0 >= 2.0]
    start_ns = read_tum(recordings / "late" / "truth.tum").t_ns[0]
    imu = read_imu_csv(recordings / "late" / "imu.csv")
    assert imu.t_ns[0] == start_ns + 1_520_000_000


def test_a_late_recording_has_no_earlier_positions():
    t_ns = np.arange(50, dtype=np.int64) * 100_000_000
    column = np.arange(50, dtype=float)
    rows = np.zeros((50, 3))
    fixes = GnssSamples(t_ns, column, column, column, rows, np.zeros(50, np.uint8), rows)

    found = degraded("late-start=2", "gnss-clock=0.1").gnss(fixes)

    assert found.t_ns.tolist() == (t_ns[20:] + 100_000_000).tolist()
    assert found.lat_rad.tolist() == column[20:].tolist()
