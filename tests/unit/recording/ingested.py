"""Runs of the stage ``frames`` for tests, and the files they read."""

from recon4.progress import Silent
from recon4.recording.ingest import ingest
from recon4.recording.samples.csv_files import IMU_HEADER
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.store.frames import FrameStore
from tests.builders import T0_NS, noisy, room_cloud, write_pcd


def run(*paths, out, rig=None, imu=None, gnss=None, progress=None, **options):
    sources = Sources(paths, rig, imu, gnss)
    ingest(sources, out, settings=IngestSettings(**options), progress=progress or Silent())
    return FrameStore.open(out)


def imu_csv(path, *, start_ns=T0_NS, count=100, accel=9.8):
    rows = [[*noisy([0, 0, 0.1], k), *noisy([0, 0, accel], k)] for k in range(count)]
    lines = [
        ",".join([str(start_ns + k * 10_000_000), *map(str, row)]) for k, row in enumerate(rows)
    ]
    path.write_text("\n".join([",".join(IMU_HEADER), *lines]) + "\n")
    return path


def frame_folder(folder, names, **options):
    folder.mkdir()
    for name in names:
        write_pcd(folder / name, room_cloud(**options))
    return folder
