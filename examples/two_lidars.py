"""Map with two LiDARs: a rig file says where each sensor is mounted.

Each `[[sensor]]` is recognized by its UDP port (in a bag by its `topic`). The mount is the pose of
the sensor in the body frame: x forward, y left, z up. Every run compares the rig file with the
recording; `"calibration.mode": "auto"` corrects one that is wrong.
"""

from pathlib import Path

from recon4 import api

RIG = """
name = "my backpack"

[[sensor]]
name = "horizontal"
model = "VLP-16"
port = 2368
xyz_m = [0.0, 0.0, 0.25]

[[sensor]]
name = "vertical"
model = "VLP-16"
port = 2369
xyz_m = [-0.12, 0.0, 0.0]
rpy_deg = [0.0, 90.0, 0.0]

[imu]
xyz_m = [0.0, 0.0, 0.0]
"""


def main() -> None:
    """Map the recording with a rig of our own, and count what each LiDAR adds to the map."""
    Path("my_rig.toml").write_text(RIG, "utf-8")
    rig = api.load_rig("my_rig.toml")
    sources = api.Sources.of("recording/recording.pcap", imu="recording/imu.csv", rig=rig)
    project = api.process(sources, "two_lidars", settings={"map.voxel_m": 0.05})

    tiles = project.tiles
    rows = [tile.read(["sensor"])["sensor"] for tile in tiles]
    for number, sensor in enumerate(rig.sensors):
        points = sum(int((row == number).sum()) for row in rows)
        print(f"{sensor.name}: {points} of {len(tiles)} points of the map")
    print(f"verdict: {project.summary.verdict.usability}")


if __name__ == "__main__":
    main()
