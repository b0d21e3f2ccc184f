"""The page of a calibration, and the slices in it."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.slices import slice_points
from recon4.model.calibration_figures import CalibrationFigures, ParameterFigures
from recon4.report.calibration_page import CalibrationPage, CloudSlice, write_calibration_page
from recon4.store.frames import FrameStore, FrameWriter
from tests.unit.calibration.conftest import mounted

pytestmark = pytest.mark.usefixtures("drawn")


def distance_m(slices):
    """Mean distance of the second LiDAR's points from the nearest ones of the first."""
    (_, first), (_, second) = slices
    return cKDTree(first).query(second)[0].mean()


def test_a_wrong_mount_shows_two_walls_where_the_right_one_shows_one(dance, tmp_path):
    with FrameWriter(tmp_path, dance.rig) as writer:
        for frame in dance:
            writer.append(frame)
    frames = FrameStore.open(tmp_path)
    walk = RecordedWalk(frames, dance.truth, *np.zeros((2, len(frames)), bool))
    wrong = mounted(dance.rig, 1, shift_m=(0.3, -0.2, 0.0))

    right = slice_points(walk, dance.rig, thickness_m=0.2)
    off = slice_points(walk, wrong, thickness_m=0.2)

    assert [name for name, _ in right] == [sensor.name for sensor in dance.rig.sensors]
    assert all(200 < len(p) <= 12_000 for _, p in right)
    assert distance_m(off) > 2.0 * distance_m(right)


def test_the_page_has_parameters_slices_and_escaped_texts(tmp_path):
    row = ParameterFigures(
        sensor="<b>",
        quantity="clock",
        axis="",
        unit="s",
        change=0.005,
        sd=0.0001,
        status="off",
    )
    points = (("one", np.zeros((9, 2))), ("two", np.ones((9, 2))))
    page = CalibrationPage(
        title="rig <1>",
        method="joint",
        outcome="written",
        figures=CalibrationFigures(parameters=(row,)),
        slices=(CloudSlice("rig file", points), CloudSlice("calibrated", points)),
    )

    write_calibration_page(tmp_path / "page.html", page)

    text = (tmp_path / "page.html").read_text()
    assert "rig &lt;1&gt;" in text and "rig <1>" not in text
    assert "+5.000 ± 0.100 ms" in text
    assert "&lt;b&gt; clock" in text and "<b> clock" not in text
    assert all(f'data-name="{name}"' in text for name in ("rig-s", "slice-rig file"))
    assert not any(tag in text for tag in ("<script", "<link", "<iframe", 'src="http'))
