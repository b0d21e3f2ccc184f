"""The IMU in a LiDAR is on the clock of that LiDAR, wherever its samples come from."""

import json
from dataclasses import replace

import numpy as np
import pytest

from recon4.calibration.parameters import Parameters
from recon4.geometry.se3 import SE3
from recon4.model.rig import format_rig, parse_rig
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.recording.info.describe import describe
from recon4.recording.ingest import ingest
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.report import ImportReport
from recon4.recording.samples.clean import join
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.bag import open_bag
from recon4.simulation.degradation import Degradation
from recon4.simulation.families.families import family_of
from recon4.simulation.packets import Packets, pack, pack_imu, put_imu, stamped, write_packets
from recon4.simulation.setup import imu_samples, prepare, rig_of_lidars
from recon4.store.frames import FrameStore
from tests.warned import derivations

OFFSET_S, SECONDS = 0.25, 0.4


class ShortWalk:
    """The first packets of a walk with one LiDAR whose clock is late."""

    def __init__(self, model):
        rig = rig_of_lidars([model])
        late = replace(rig.sensors[0], time_offset_s=OFFSET_S)
        self.setup = setup = prepare(
            "office", seconds=5.0, seed=1, rig=replace(rig, sensors=(late,))
        )
        self.lidar = setup.lidars[0]
        samples = imu_samples(setup)
        rows = samples.t_ns < setup.epoch_ns + SECONDS * 1e9
        self.imu = ImuSamples(
            samples.t_ns[rows], samples.gyro_rad_s[rows], samples.accel_m_s2[rows]
        )
        self.exact = Degradation.drawn({}, lasers=[self.lidar.pattern.lasers], seed=1)
        count = self.lidar.packets_before(round(SECONDS * 1e9))
        firings = self.lidar.fire(range(count), setup.walk, setup.surroundings, rng=setup.rng(3))
        self.data = pack(firings, 0, setup, degradation=self.exact, rng=setup.rng(4))
        put_imu(self.data, self.imu, setup, degradation=self.exact)

    def capture(self, folder, *beside):
        folder.mkdir()
        own = pack_imu(self.imu, 0, self.setup, degradation=self.exact)
        with PcapWriter(folder / "walk.pcap") as file:
            write_packets(file, [self.data, *([own] if own else []), *beside], self.setup)
        for name, content in family_of(self.lidar.sensor.model).companions(self.lidar).items():
            (folder / name).write_bytes(content)
        return sorted(folder.iterdir())

    def bag(self, folder):
        with open_bag(folder, self.setup.rig) as bag:
            bag.packets(0, self.data.t_arrival_ns, self.data.payloads)
            bag.imu(stamped(self.imu, 0, self.setup, degradation=self.exact))
        return folder


@pytest.fixture(scope="module")
def walks():
    return {model: ShortWalk(model) for model in ("JT128", "Airy")}


def ingested(paths, rig, out):
    ingest(Sources(tuple(paths), rig), out, settings=IngestSettings(), progress=Silent())
    return FrameStore.open(out)


@pytest.mark.parametrize(("model", "named"), [("JT128", True), ("Airy", True), ("Airy", False)])
def test_points_and_imu_of_a_late_clock_are_moved_alike(walks, model, named, tmp_path):
    walk = walks[model]
    rig = walk.setup.rig
    if not named:
        rig = replace(rig, imu_sensor="", T_body_imu=SE3.identity())

    store = ingested(walk.capture(tmp_path / "walk"), rig, tmp_path / "store")

    off_ns = store.imu.t_ns[0] - walk.imu.t_ns[0]
    assert 0 <= off_ns < 10_000_000  # a sample in a data packet is that of its packet
    assert 0 <= store.index["t_ns"][0] - walk.setup.epoch_ns < 110_000_000
    assert store.rig.imu_sensor == rig.sensors[0].name
    np.testing.assert_allclose(store.rig.T_body_imu.R, walk.setup.rig.T_body_imu.R, atol=1e-9)
    later = replace(store.rig.sensors[0], time_offset_s=OFFSET_S + 0.01)
    moved = store.with_rig(replace(store.rig, sensors=(later,)))
    assert moved.imu.t_ns[0] - store.imu.t_ns[0] == 10_000_000


def test_an_imu_beside_the_one_that_the_rig_names_is_not_mixed_with_it(walks, tmp_path):
    walk = walks["Airy"]
    rig = walk.setup.rig
    keys = ("gx_rad_s", "gy_rad_s", "gz_rad_s", "ax_m_s2", "ay_m_s2", "az_m_s2")
    texts = [json.dumps({"t_ns": int(t)} | dict.fromkeys(keys, 5.0)) for t in walk.imu.t_ns]
    payloads = np.array([list(text.encode()) for text in texts], np.uint8)
    paths = walk.capture(tmp_path / "walk", Packets(0, walk.imu.t_ns, payloads, rig.imu_port))

    store = ingested(paths, rig, tmp_path / "store")

    assert len(store.imu) == len(walk.imu)
    assert store.report["counts"]["imu_samples_not_read"] == len(walk.imu)
    assert any("as the rig says, not" in text for text in derivations(store.report))


def test_a_calibration_moves_lidar_and_imu_by_what_it_found():
    rig = rig_of_lidars(["VLP-16", "Mid-360"])
    parameters = Parameters.of(rig, reference=0, lidars=(1,), imu=True)
    delta = 0.01 * np.random.default_rng(1).normal(size=len(parameters))

    after = parameters.changed(rig, delta)
    again = parse_rig(format_rig(after), where="rig")

    np.testing.assert_allclose(parameters.between(rig, after), delta, atol=1e-12)
    np.testing.assert_allclose(parameters.between(rig, again), delta, atol=1e-9)
    assert again.imu_clock_offset_s == pytest.approx(delta[parameters.of_imu][6])


def read(path, rig, **settings):
    report = ImportReport()
    recording = open_recording(OpenRequest((path,), rig, IngestSettings(**settings), report))
    return join([one for one in recording.read() if isinstance(one, ImuSamples)]), report


def test_samples_of_packets_and_of_a_topic_are_not_mixed(walks, tmp_path):
    walk = walks["JT128"]
    rig = walk.setup.rig
    path = walk.bag(tmp_path / "bag")

    in_packets, report = read(path, replace(rig, sensors=(replace(rig.sensors[0], topic=""),)))
    of_topic, _ = read(path, rig, imu_topic="/imu/data")
    unnamed, _ = read(path, replace(rig, imu_sensor=""))

    assert 0 < len(in_packets) < len(walk.imu) + 2
    assert (np.diff(in_packets.t_ns) > 0).all()
    assert any("is read, as the rig says, not /imu/data" in text for text in derivations(report))
    assert len(of_topic) == len(unnamed) == len(walk.imu)
    np.testing.assert_array_equal(of_topic.gyro_rad_s, unnamed.gyro_rad_s)


def test_the_first_rig_of_an_airy_has_its_imu_and_says_what_is_not_certain(walks, tmp_path):
    paths = walks["Airy"].capture(tmp_path / "walk")
    found = describe(next(path for path in paths if path.suffix == ".pcap"))

    rig = parse_rig(found.first_rig, where="rig")
    assert rig.imu_sensor == rig.sensors[0].name
    np.testing.assert_allclose(rig.T_body_imu.R, [[0, -1, 0], [-1, 0, 0], [0, 0, -1]], atol=1e-9)
    assert "# Uncertain: the IMU of an Airy is taken as turned" in found.first_rig
    assert "IMU in the packets of the LiDAR" in found.samples
