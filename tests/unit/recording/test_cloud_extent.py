"""Clouds that are empty, in another unit, or in coordinates of a map."""

import numpy as np
import pytest

from recon4.errors import EmptyRecording
from recon4.recording.info.describe import describe
from tests.builders import T0_NS, bag_path, room_cloud, write_pcd
from tests.robot_bags import RobotBag
from tests.unit.recording.ingested import run


def moved_cloud(scale=1.0, shift=(0.0, 0.0, 0.0)):
    """The room in another unit, from another origin."""
    cloud = room_cloud()
    return cloud | {
        axis: (scale * cloud[axis] + d).astype(np.float32)
        for axis, d in zip("xyz", shift, strict=True)
    }


def written(folder, cloud, *, as_bag):
    if not as_bag:
        folder.mkdir()
        for k in range(3):
            write_pcd(folder / f"{T0_NS + k * 100_000_000}.pcd", cloud)
        return folder
    folder.mkdir()
    with RobotBag(bag_path(folder, "mcap"), "mcap") as bag:
        for k in range(12):
            bag.cloud("/points", T0_NS + k * 100_000_000, cloud)
    return bag_path(folder, "mcap")


FAULTS = [
    (moved_cloud(1000.0), "ingest.points_unit_m=0.001"),
    (moved_cloud(1.0, (636_000.0, 849_000.0, 410.0)), "coordinates of a map or of the earth"),
    (moved_cloud(60.0), "a larger ingest.max_range_m"),
    (moved_cloud(200.0), "ingest.points_unit_m=0.001"),
]


@pytest.mark.parametrize("as_bag", [False, True], ids=["folder", "bag"])
@pytest.mark.parametrize(("cloud", "remedy"), FAULTS, ids=["millimeters", "map", "far", "small"])
def test_clouds_without_a_usable_point_are_said_with_extent_and_remedy(
    tmp_path, cloud, remedy, as_bag
):
    path = written(tmp_path / "walk", cloud, as_bag=as_bag)

    with pytest.raises(EmptyRecording, match="no usable points") as caught:
        run(path, out=tmp_path / "frames")
    text = "\n".join(describe(path).lines())

    assert remedy in str(caught.value)
    assert remedy in text
    assert "No usable points" in text


@pytest.mark.parametrize("as_bag", [False, True], ids=["folder", "bag"])
def test_the_remedy_for_millimeters_reads_them(tmp_path, as_bag):
    path = written(tmp_path / "walk", moved_cloud(1000.0), as_bag=as_bag)

    store = run(path, out=tmp_path / "frames", points_unit_m=0.001)

    far_m = np.linalg.norm(store[0].xyz, axis=1).max()
    cloud = room_cloud()
    assert far_m == pytest.approx(np.linalg.norm([cloud[a] for a in "xyz"], axis=0).max(), rel=1e-4)


def test_info_says_that_clouds_are_empty(tmp_path):
    empty = {name: column[:0] for name, column in room_cloud().items()}

    text = "\n".join(describe(written(tmp_path / "walk", empty, as_bag=False)).lines())

    assert "No usable points" in text


def test_clouds_of_a_room_are_not_accused(tmp_path):
    text = "\n".join(describe(written(tmp_path / "walk", room_cloud(), as_bag=True)).lines())

    assert "farther" not in text and "No usable" not in text
