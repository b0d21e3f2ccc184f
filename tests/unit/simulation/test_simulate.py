import hashlib
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from recon4.errors import Cancelled, ConfigError, StoreError
from recon4.geometry.raycast import Scene
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.frames import simulate_frames
from recon4.simulation.setup import EPOCH_NS, Models, prepare
from recon4.simulation.simulate import simulate
from recon4.simulation.worlds import build_world
from recon4.store.frames import FrameStore

SECONDS = 5.0
NO_MODEL = replace(
    load_rig("single-vlp16"),
    sensors=(replace(load_rig("single-vlp16").sensors[0], model="generic"),),
)


@pytest.fixture(scope="module")
def perfect(tmp_path_factory):
    """Five seconds of staircase by sensors without errors."""
    out = tmp_path_factory.mktemp("perfect") / "out"
    setup = prepare("staircase", seconds=SECONDS, seed=1, models=Models.perfect())
    simulate(setup, out, progress=Silent())
    return out


def datagrams(path):
    """(time [s], source address, port, payload) of a capture file, read by hand."""
    raw, at = path.read_bytes(), 24
    assert raw[:4] == b"\x4d\x3c\xb2\xa1"
    while at < len(raw):
        seconds, nanoseconds, length = np.frombuffer(raw, "<u4", 3, at)
        frame = raw[at + 16 : at + 16 + int(length)]
        at += 16 + int(length)
        source = ".".join(str(part) for part in frame[26:30])
        port = int.from_bytes(frame[36:38], "big")
        yield int(seconds) + 1e-9 * int(nanoseconds), source, port, frame[42:]


def hashes(folder: Path):
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in files
    }


def off_the_model(folder, store, world):
    """Distances of some points of a store, placed by the truth, to the true model [m]."""
    truth, scene = read_tum(folder / "truth.tum"), Scene(build_world(world).mesh)
    parts = []
    for frame in (store[k].take(slice(k % 7, None, 7)) for k in range(0, len(store), 6)):
        T_map_body = truth.at(frame.t_ns + frame.dt_ns.astype(np.int64))
        mounts = store.rig.T_body_sensor[frame.sensor.astype(int)]
        parts.append(scene.distance(T_map_body @ (mounts @ frame.xyz.astype(float))))
    return np.concatenate(parts)


def test_everything_promised_is_there(perfect):
    assert {path.name for path in perfect.iterdir()} == {
        "recording.pcap", "rosbag2", "rig.toml", "imu.csv", "truth.tum", "model.ply",
        "reflectivity.npz", "markers.csv", "world.json",
    }  # fmt: skip
    header, first = (perfect / "imu.csv").read_text().splitlines()[:2]
    assert header == "t_ns,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2"
    assert first.startswith(f"{EPOCH_NS},")
    world = json.loads((perfect / "world.json").read_text())
    assert (world["world"], world["seed"], world["seconds"]) == ("staircase", 1, 5.0)
    truth = read_tum(perfect / "truth.tum")
    assert len(truth) == 1001 and truth.t_ns[0] == EPOCH_NS
    assert load_rig(perfect / "rig.toml").sensors[1].address == "192.168.1.202"


def test_an_independent_decoder_puts_the_points_onto_the_model(perfect):
    velodyne_decoder = pytest.importorskip("velodyne_decoder")
    rig, truth = load_rig(perfect / "rig.toml"), read_tum(perfect / "truth.tum")
    scene = Scene(build_world("staircase").mesh)
    config = velodyne_decoder.Config(model=velodyne_decoder.Model.VLP16, min_range=0.0)
    for sensor in rig.sensors:
        decoder = velodyne_decoder.StreamDecoder(config)
        packets = [
            (t_s, payload)
            for t_s, source, port, payload in datagrams(perfect / "recording.pcap")
            if (source, port) == (sensor.address, sensor.port)
        ]
        scans = [decoder.decode(t_s, payload) for t_s, payload in packets]
        clouds = [scan for scan in [*scans, decoder.finish()] if scan is not None]
        points = np.concatenate([cloud for _, cloud in clouds])
        # Device stamps as floats of 1.8e9 s are good to 0.2 µs.
        t_ns = np.concatenate(
            [(1e9 * (stamp.device - 1_780_308_000)) + 1e9 * cloud[:, 4] for stamp, cloud in clouds]
        )
        t_ns = EPOCH_NS + np.rint(t_ns).astype(np.int64)

        assert len(points) > 500_000
        some = np.arange(0, len(points), 23)

        placed = truth.at(t_ns[some]) @ (sensor.T_body_sensor @ points[some, :3].astype(float))
        error = scene.distance(placed)

        assert np.quantile(error, 0.999) < 0.002
        assert error.max() < 0.01


@pytest.mark.study
def test_our_readers_get_the_same_points_from_capture_bag_and_frames(perfect, tmp_path):
    settings = IngestSettings(min_range_m=0.0)
    for name in ("recording.pcap", "rosbag2"):
        sources = Sources((perfect / name,), load_rig(perfect / "rig.toml"))
        ingest(sources, tmp_path / name, settings=settings, progress=Silent())
    staircase = prepare("staircase", seconds=SECONDS, seed=1, models=Models.perfect())
    simulate_frames(staircase, tmp_path / "direct")
    pcap, bag, direct = (
        FrameStore.open(tmp_path / name) for name in ("recording.pcap", "rosbag2", "direct")
    )

    assert abs(len(pcap) - 50) <= 1 and pcap.points > 2_500_000
    assert abs(bag.points - pcap.points) < 0.01 * pcap.points
    assert abs(direct.points - pcap.points) < 0.02 * pcap.points
    assert bag.imu is not None and len(bag.imu) > 980
    for store in (pcap, bag, direct):
        error = off_the_model(perfect, store, "staircase")
        assert np.quantile(error, 0.999) < 0.002


def test_reflectivity_has_a_value_for_every_return_of_every_packet(perfect):
    truth = np.load(perfect / "reflectivity.npz")
    for row, port in enumerate((2368, 2369)):
        payloads = [p for _, _, to, p in datagrams(perfect / "recording.pcap") if to == port]
        blocks = np.frombuffer(b"".join(payloads), np.uint8).reshape(-1, 1206)[:, :1200]
        returns = blocks.reshape(-1, 12, 100)[:, :, 4:].reshape(-1, 24, 16, 3)
        distance = returns[..., 0] + 256 * returns[..., 1].astype(int)

        assert truth[f"sensor{row}"].shape == distance.shape
        assert np.array_equal(truth[f"sensor{row}"] > 0, distance > 0)


@pytest.mark.study
def test_the_same_seed_gives_the_same_bytes_and_another_does_not(tmp_path):
    for name, seed in (("a", 3), ("b", 3), ("c", 4)):
        simulate(prepare("field", seconds=SECONDS, seed=seed), tmp_path / name, progress=Silent())

    a, b, c = (hashes(tmp_path / name) for name in "abc")

    assert a == b
    assert {name for name in a if a[name] != c[name]} >= {
        "recording.pcap", "rosbag2/rosbag2.db3", "imu.csv", "gnss.csv", "truth.tum",
        "reflectivity.npz", "world.json",
    }  # fmt: skip
    assert a["model.ply"] == c["model.ply"]


def geocentric(lat, lon, height):
    """WGS 84 latitude, longitude [rad] and height [m] to geocentric x, y, z [m], by the book."""
    a, f = 6_378_137.0, 1.0 / 298.257223563
    e2 = f * (2.0 - f)
    n = a / np.sqrt(1.0 - e2 * np.sin(lat) ** 2)
    return np.stack(
        [
            (n + height) * np.cos(lat) * np.cos(lon),
            (n + height) * np.cos(lat) * np.sin(lon),
            (n * (1.0 - e2) + height) * np.sin(lat),
        ],
        axis=-1,
    )


def test_gnss_positions_are_those_of_the_antenna(tmp_path):
    setup = prepare("field", seconds=6.0, seed=2, models=Models.perfect(), rig=load_rig("4recon"))
    simulate(setup, tmp_path / "out", progress=Silent(), bag=False)
    rows = np.genfromtxt(tmp_path / "out" / "gnss.csv", delimiter=",", names=True)
    truth = read_tum(tmp_path / "out" / "truth.tum")
    origin = json.loads((tmp_path / "out" / "world.json").read_text())["origin"]
    lat0, lon0 = np.deg2rad(origin["lat_deg"]), np.deg2rad(origin["lon_deg"])

    lat, lon = np.deg2rad(rows["lat_deg"]), np.deg2rad(rows["lon_deg"])
    xyz = geocentric(lat, lon, rows["ellipsoidal_height_m"])
    offset = xyz - geocentric(lat0, lon0, origin["height_m"])
    east = [-np.sin(lon0), np.cos(lon0), 0.0]
    up = [np.cos(lat0) * np.cos(lon0), np.cos(lat0) * np.sin(lon0), np.sin(lat0)]
    enu = offset @ np.stack([east, np.cross(up, east), up], axis=1)
    T_map_body = truth.at(rows["t_ns"].astype(np.int64))
    lever = load_rig("4recon").p_body_antenna

    assert len(rows) == 61 and np.all(rows["quality"] == 4)
    np.testing.assert_allclose(enu, T_map_body @ np.tile(lever, (61, 1)), atol=2e-5)
    ahead = T_map_body.R[:, :, 0]
    heading = np.rad2deg(np.arctan2(ahead[:, 0], ahead[:, 1])) % 360.0
    np.testing.assert_allclose(rows["heading_deg"], heading, atol=1e-4)
    np.testing.assert_allclose(np.sin(np.deg2rad(rows["pitch_deg"])), ahead[:, 2], atol=1e-6)
    assert not (tmp_path / "out" / "rosbag2").exists()


def test_position_packets_tell_the_time_and_outdoors_the_place(perfect):
    sentences = [
        payload[206:].split(b"\0")[0].decode()
        for _, _, port, payload in datagrams(perfect / "recording.pcap")
        if port == 8308
    ]

    assert len(sentences) == 10
    assert sentences[0].startswith("$GPRMC,100000,V,") and ",010626," in sentences[0]
    assert sentences[-1].startswith("$GPRMC,100004,V,")


@pytest.mark.study
def test_a_rig_with_clock_offsets_stamps_its_packets_with_them(tmp_path):
    rig = load_rig("single-vlp16")
    late = replace(rig, sensors=(replace(rig.sensors[0], time_offset_s=0.25),))
    for name, used in (("on", rig), ("off", late)):
        setup = prepare("office", seconds=SECONDS, seed=1, rig=used)
        simulate(setup, tmp_path / name, progress=Silent(), bag=False)

    stamps = [
        next(
            int.from_bytes(payload[1200:1204], "little")
            for _, _, port, payload in datagrams(tmp_path / name / "recording.pcap")
            if port == 2368
        )
        for name in ("on", "off")
    ]

    assert (stamps[0] - stamps[1]) % 3_600_000_000 == 250_000


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"world": "moon"}, "no world named 'moon'"),
        ({"seconds": 4.0}, "a walk takes 5 s to 1e6 s, got 4"),
        ({"seconds": float("nan")}, "a walk takes 5 s to 1e6 s, got NaN"),
        ({"seed": -1}, "the seed must not be negative, got -1"),
        ({"rig": NO_MODEL}, "a LiDAR 'generic' is not simulated; simulated: VLP-16, "),
    ],
)
def test_what_cannot_be_simulated_is_refused(change, message):
    asked = {"world": "office", "seconds": SECONDS, "seed": 1} | change
    with pytest.raises(ConfigError, match=message):
        prepare(asked.pop("world"), **asked)


def test_a_folder_with_something_in_it_is_left_alone(tmp_path):
    (tmp_path / "mine.txt").write_text("keep")

    with pytest.raises(StoreError, match="exists already; give a new folder"):
        simulate(prepare("office", seconds=SECONDS, seed=1), tmp_path, progress=Silent())

    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_a_cancelled_simulation_leaves_nothing(tmp_path):
    class Impatient(Silent):
        def advance(self, done=1):
            raise Cancelled("stop")

    with pytest.raises(Cancelled):
        simulate(prepare("office", seconds=SECONDS, seed=1), tmp_path / "out", progress=Impatient())

    assert list(tmp_path.iterdir()) == []
