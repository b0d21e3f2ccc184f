"""Steps of a walk in columns are the steps that were added, and their poses one trajectory."""

from dataclasses import fields, replace

import numpy as np
import pytest
from msgspec import structs

from recon4.geometry.se3 import SE3
from recon4.registration import walk_steps as module
from recon4.registration.step import OdometryStep
from recon4.registration.walk_steps import WalkSteps, dense_trajectory

FRAME_NS = 100_000_000
ENDS = ("t_ns", "T_dense")


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "DENSE", structs.replace(module.DENSE, block=3))


def step(k: int) -> OdometryStep:
    """A multiframe with other numbers in each field; its first pose repeats the last time."""
    rng = np.random.default_rng(k)
    t_ns = FRAME_NS * k + np.arange(0, FRAME_NS + 1, 10_000_000)
    T_dense = SE3.exp(1e-6 * rng.standard_normal((len(t_ns), 6)))
    lost, stationary, bridged = k % 3 == 1, k % 4 == 1, k % 5 == 1
    one, two, three, four, five, *rest = rng.random(9).tolist()
    return OdometryStep(
        k, FRAME_NS * k + FRAME_NS // 2, T_dense[5], t_ns, T_dense, one, two, k % 5, k % 2 > 0,
        three, four, lost, rng.random((6, 6)), rng.random(3), five, rng.random(6),
        *rest[:3], stationary, bridged, k // 4, rest[3],
    )  # fmt: skip


def test_a_step_is_read_as_it_was_added() -> None:
    made = [step(k) for k in range(8)]

    steps = WalkSteps(made)

    assert len(steps) == 8
    for before, after in zip(made, steps, strict=True):
        for name in (field.name for field in fields(OdometryStep) if field.name not in ENDS):
            one, other = (getattr(each, name) for each in (before, after))
            pairs = (
                [(one.R, other.R), (one.t, other.t)] if name == "T_odom_body" else [(one, other)]
            )
            for a, b in pairs:
                np.testing.assert_array_equal(a, b)
                assert type(a) is type(b)
        np.testing.assert_array_equal(after.t_ns, before.t_ns[[0, -1]])
        np.testing.assert_array_equal(after.T_dense.t, before.T_dense.t[[0, -1]])
    np.testing.assert_array_equal(steps.column("motion_cov"), [each.motion_cov for each in made])
    np.testing.assert_array_equal(steps.T_odom_body.R, [each.T_odom_body.R for each in made])


def test_a_step_is_replaced_and_its_neighbors_stay() -> None:
    steps = WalkSteps(step(k) for k in range(8))
    read = steps[4]

    steps.update([(4, replace(read, weak_sd_m=9.0))])

    assert np.flatnonzero(steps.column("weak_sd_m") == 9.0).tolist() == [4]
    assert read.weak_sd_m < 1.0
    with pytest.raises(IndexError):
        steps[8]


def test_the_trajectory_has_the_newest_pose_of_each_time() -> None:
    made = [replace(step(k), lost=True) for k in range(8)]  # which nothing smooths
    made[5] = replace(made[5], t_ns=made[5].t_ns - 35_000_000)  # begins within the one before

    dense = dense_trajectory(iter(made))

    newest = {t: each.T_dense[k] for each in made for k, t in enumerate(each.t_ns.tolist())}
    assert (np.diff(dense.t_ns) > 0).all()
    assert dense.t_ns[0] == made[0].t_ns[0] and dense.t_ns[-1] == made[-1].t_ns[-1]
    for t_ns, T in zip(dense.t_ns.tolist(), dense.T_a_b, strict=True):
        np.testing.assert_array_equal(T.R, newest[t_ns].R)
        np.testing.assert_array_equal(T.t, newest[t_ns].t)
    assert len(dense) == 79
