"""Frame files whose clock was set back while they were written, and those where it was not."""

import numpy as np
import pytest

from recon4.recording.frame_files.clock import clock_by_order, clock_by_time
from recon4.recording.frame_files.folders import list_frames
from recon4.recording.info.describe import describe
from tests.builders import T0_NS, room_cloud, write_pcd
from tests.unit.recording.ingested import run
from tests.warned import K, kinds, warned

STEP_NS = 100_000_000


def stamps(count=40):
    return T0_NS + STEP_NS * np.arange(count)


def set_back(seconds, *, at=20, count=40):
    """Stamps of a clock that goes back before the frame ``at``."""
    return stamps(count) - round(seconds * 1e9) * (np.arange(count) >= at)


def by_time(t_ns, sizes=None):
    """The order of recording that is found in sorted times; None = no two clocks are in them."""
    order = np.argsort(t_ns, kind="stable")
    clock = clock_by_time(t_ns[order], lambda: [1] * len(t_ns) if sizes is None else sizes)
    return None if clock is None else order[clock.order].tolist()


@pytest.mark.parametrize("back_s", [0.12, 0.33, 0.499, 0.501, 0.55, 1.03])
def test_frames_of_a_clock_that_was_set_back_follow_those_before(back_s):
    assert by_time(set_back(back_s)) == list(range(40))


def test_a_clock_may_be_set_back_twice_or_forward_again():
    twice = set_back(0.53, at=12)
    twice[28:] -= 730_000_000
    forward = set_back(1.53)
    forward[28:] = stamps()[28:]

    assert by_time(twice) == by_time(forward) == list(range(40))


def test_missing_frames_do_not_mix_two_clocks():
    assert by_time(np.delete(set_back(1.03), [12, 15, 25])) == list(range(37))


@pytest.mark.parametrize("left", [0.55, 0.7, 0.95])
def test_missing_frames_are_no_second_clock(left):
    rng = np.random.default_rng(4)
    for _ in range(40):
        rows = np.sort(rng.permutation(200)[: int(200 * left)])
        noise = rng.normal(0.0, 3e6, len(rows)).astype(np.int64)
        assert by_time(stamps(200)[rows] + noise) is None


def test_a_sensor_that_turns_faster_for_a_while_is_no_second_clock():
    fast = STEP_NS // 2 * np.arange(1, 15)
    t_ns = np.concatenate([stamps(20), stamps(20)[-1] + fast, stamps(48)[27:]])
    sizes = np.where(np.isin(np.arange(len(t_ns)), np.arange(20, 34)), 500, 1000)

    assert by_time(t_ns, sizes.tolist()) is None
    assert by_time(t_ns) is not None


@pytest.mark.parametrize("back_s", [0.03, 0.08, 0.5, 0.53, 1.9, 5.0, 3600.0])
def test_frames_that_are_numbered_keep_their_order(back_s):
    clock = clock_by_order(set_back(back_s))

    assert clock.order.tolist() == list(range(40))
    assert np.all(np.diff(set_back(back_s) + clock.shift_ns) == STEP_NS)
    assert [step.back_ns for step in clock.steps] == [round(back_s * 1e9)]


def test_steps_that_are_shorter_for_another_reason_are_no_clock_set_back():
    rng = np.random.default_rng(5)
    late = stamps() + rng.exponential(8e6, 40).astype(np.int64)
    held_up = stamps() + np.where(np.arange(40) == 19, 60_000_000, 0)
    faster = np.concatenate([stamps(20), stamps(20)[-1] + STEP_NS // 2 * np.arange(1, 15)])

    for t_ns in (late, held_up, faster, stamps()[[0, 1, 2, 3, 10, 11, 12, 13, 30, 31]]):
        assert clock_by_order(t_ns) is None


def test_parts_that_are_given_in_another_order_are_no_clock_set_back():
    assert clock_by_order(np.concatenate([stamps()[20:], stamps()[:20]])) is None
    assert clock_by_order(np.concatenate([stamps()[30:], stamps()[10:30], stamps()[:10]])) is None
    assert clock_by_order(stamps()) is None


@pytest.mark.parametrize("named", ["stamp", "number", "list"])
@pytest.mark.parametrize("absolute", [False, True], ids=["relative", "absolute"])
@pytest.mark.parametrize("back_s", [0.08, 0.53])
def test_a_folder_goes_on_where_its_clock_was_set_back(tmp_path, named, absolute, back_s):
    folder = tmp_path / "f"
    folder.mkdir()
    for k, t in enumerate(set_back(back_s, at=8, count=16).tolist()):
        cloud = room_cloud(columns_per_turn=36)
        cloud["intensity"] = np.full_like(cloud["intensity"], k)
        if absolute:
            cloud["timestamp"] = t / 1e9 + np.linspace(0.0, 0.099, len(cloud["x"]))
        name = {"stamp": f"{t}", "number": f"{k:04d}_{t}", "list": f"{k:04d}"}[named]
        write_pcd(folder / f"{name}.pcd", cloud)
    if named == "list":
        listed = set_back(back_s, at=8, count=16)
        (folder / "times.txt").write_text("".join(f"{t}\n" for t in listed))

    store, found = run(folder, out=tmp_path / "o"), describe(folder)

    assert [int(np.median(frame.intensity)) for frame in store] == list(range(16))
    assert np.allclose(np.diff(store.index["t_ns"]), STEP_NS, atol=1_000_000)
    assert max(frame.dt_ns.max() for frame in store) < STEP_NS
    assert store.report["counts"]["clock_jumps_back"] == 1
    assert kinds(store.report).count(K.CLOCK_BACK) == 1
    assert K.TIME_GAP not in kinds(store.report)
    assert K.FRAMES_OVERLAP not in kinds(store.report)
    assert warned(found, K.CLOCK_BACK, seconds=back_s)
    assert [gap.seconds for gap in found.gaps] == [-back_s]


def test_frames_of_two_sensors_in_one_folder_are_no_clock_set_back(tmp_path):
    folder = tmp_path / "f"
    folder.mkdir()
    for k, t in enumerate(stamps(16).tolist()):
        write_pcd(folder / f"left_{t}.pcd", room_cloud(columns_per_turn=36))
        if 4 < k < 12:
            write_pcd(folder / f"top_{t + 30_000_000}.pcd", room_cloud(columns_per_turn=36))

    assert list_frames(folder).clock is None
