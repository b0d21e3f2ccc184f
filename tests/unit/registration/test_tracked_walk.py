"""How a walk reads the multiframes of a recording."""

from threading import Event

import numpy as np

from recon4.registration.segments import sample_segments
from recon4.registration.tracked_walk import _views


def test_one_multiframe_is_read_and_sampled_while_the_one_before_is_fitted(frames):
    read, second_is_read = [], Event()

    class Watched:
        rig = frames.rig

        def __iter__(self):
            for k in range(4):
                read.append(k)
                if k == 1:
                    second_is_read.set()
                yield frames[k]

    views = _views(Watched())

    first = next(views)
    assert second_is_read.wait(60.0)
    assert read == [0, 1]
    later = list(views)
    assert [view.frame.frame_id for view in (first, *later)] == [frames[k].frame_id for k in read]
    segments = sample_segments(frames[3], frames.rig)
    assert np.array_equal(later[-1].segments.a_body, segments.a_body)
