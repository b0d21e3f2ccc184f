"""Points of multiframes that later stages do not see."""

from dataclasses import replace

import numpy as np

from recon4.model.hidden_points import HiddenPoints
from recon4.model.multiframe import Multiframe


def frame(frame_id: int, count: int) -> Multiframe:
    column = np.arange(count)
    return Multiframe(
        frame_id=frame_id,
        t_ns=0,
        duration_ns=1,
        xyz=np.repeat(column[:, None], 3, axis=1).astype(np.float32),
        intensity=column.astype(np.uint16),
        ring=np.zeros(count, np.uint8),
        sensor=np.zeros(count, np.uint8),
        echo=np.zeros(count, np.uint8),
        dt_ns=np.zeros(count, np.int32),
    )


def test_each_multiframe_is_seen_without_its_own_hidden_points() -> None:
    first, third = np.zeros(11, bool), np.zeros(3, bool)
    first[[0, 10]] = third[1] = True

    hidden = HiddenPoints.of([first, None, third])

    assert hidden.seen(frame(0, 11)).intensity.tolist() == list(range(1, 10))
    assert hidden.seen(frame(1, 5)).intensity.tolist() == [0, 1, 2, 3, 4]
    assert hidden.seen(frame(2, 3)).intensity.tolist() == [0, 2]
    assert hidden.count == 3


def test_a_multiframe_without_mask_is_the_same_object() -> None:
    whole = replace(frame(0, 4), t_ns=7)

    assert HiddenPoints.of([None]).seen(whole) is whole
