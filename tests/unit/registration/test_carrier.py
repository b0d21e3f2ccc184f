"""The prior on a carrier's motion: without weight where scans observe it, decisive where not."""

import numpy as np
import pytest
from msgspec import structs

from recon4.geometry.se3 import SE3, Array
from recon4.registration.carrier import CarrierPrior
from recon4.registration.scan_chain import ScanChain
from recon4.registration.scan_registration import Scan, make_scan, register_scans, search_scans
from tests.unit.registration.test_scan_registration import SCANS, apart, room, scan

TENTH_NS = 100_000_000


def tunnel(seed: int = 1) -> Array:
    """What a sensor sees of a tunnel of 4 m by 3 m without any end."""
    rng = np.random.default_rng(seed)
    u = rng.uniform(size=(12_000, 3)) * [30.0, 4.0, 3.0] - [15.0, 2.0, 1.5]
    side = rng.integers(0, 4, len(u))
    for kind, (axis, value) in enumerate(((1, -2.0), (1, 2.0), (2, -1.5), (2, 1.5))):
        u[side == kind, axis] = value
    return np.asarray(u + 0.02 * rng.standard_normal(u.shape))


def tunnel_scan(seed: int = 1) -> Scan:
    return make_scan(tunnel(seed), SCANS)


def test_a_speed_is_kept_for_seconds_and_then_forgotten() -> None:
    velocity = np.array([1.2, 0.0, 0.1])
    soon, late = CarrierPrior.after(0.1, velocity), CarrierPrior.after(30.0, velocity)

    assert soon.t_m == pytest.approx(0.1 * velocity, rel=0.02)
    assert soon.sd_m == pytest.approx(0.021, abs=0.002)
    assert np.linalg.norm(late.t_m) < 2.0
    assert late.sd_m == pytest.approx(45.0, rel=0.01)


def test_no_motion_is_impossible() -> None:
    prior = CarrierPrior.after(0.1, np.zeros(3))

    far = SE3(np.eye(3), np.array([14.0, 0.0, 0.0]))
    over = SE3.from_rpy(0.0, 0.0, np.pi, t=[0.0, 0.0, 0.0])
    assert prior.plausibility(SE3(np.eye(3), prior.t_m)) == 1.0
    assert 0.0 < prior.plausibility(far) < 0.01
    assert prior.plausibility(over) < 0.2
    later = CarrierPrior.after(20.0, np.zeros(3))
    assert later.plausibility(far) > 0.8
    assert later.plausibility(over) > 0.99


def test_a_tube_cannot_turn_the_body_over() -> None:
    """A tube without any end observes neither the turn about its axis nor the motion along it."""
    rng = np.random.default_rng(1)

    def tube() -> Array:
        x, angle = rng.uniform(-15.0, 15.0, 12_000), rng.uniform(-np.pi, np.pi, 12_000)
        side = 2.0 * np.stack([np.cos(angle), np.sin(angle)], 1)
        return np.column_stack([x, side]) + 0.02 * rng.standard_normal((12_000, 3))

    prior = CarrierPrior.after(0.1, np.array([1.2, 0.0, 0.0]))
    turned = SE3.from_rpy(0.5, 0.0, 0.0, t=[0.0, 0.0, 0.0])
    found = register_scans(
        make_scan(tube(), SCANS),
        make_scan(tube(), SCANS),
        initial=turned,
        settings=SCANS,
        prior=prior,
    )

    assert found.T_target_source.angle() < 0.1


def test_along_a_tunnel_the_prior_says_where_the_body_is() -> None:
    prior = CarrierPrior.after(0.1, np.array([3.0, 0.0, 0.0]))
    wrong = SE3(np.eye(3), np.array([0.6, 0.0, 0.0]))
    a, b = tunnel_scan(), tunnel_scan(2)

    alone = register_scans(a, b, initial=wrong, settings=SCANS)
    found = register_scans(a, b, initial=wrong, settings=SCANS, prior=prior)

    assert abs(alone.T_target_source.t[0] - 0.3) > 0.2
    assert found.T_target_source.t == pytest.approx([0.3, 0.0, 0.0], abs=0.04)


@pytest.mark.parametrize(("seconds", "is_taken"), [(0.1, False), (20.0, True)])
def test_a_far_overlay_of_ground_plans_is_taken_once_it_is_plausible(
    seconds: float, is_taken: bool
) -> None:
    """A room is nearly its own mirror image: both overlays fit, one of them 2.7 m away."""
    T_true = SE3.from_rpy(0.0, 0.0, 2.2, t=[2.5, 1.0, 0.0])
    doubtful = structs.replace(SCANS, confident_inlier_ratio=0.99)
    prior = CarrierPrior.after(seconds, np.zeros(3))

    found = search_scans(
        scan(), scan(T_true, seed=2), initial=SE3.identity(), settings=doubtful, prior=prior
    )

    assert (apart(found.T_target_source, T_true) < 0.05) is is_taken


@pytest.mark.parametrize("speed_m_s", [0.0, 14.0])
def test_in_a_room_a_wrong_prior_has_no_weight(speed_m_s: float) -> None:
    T_true = SE3.from_rpy(0.02, -0.03, 0.15, t=[0.4, -0.2, 0.1])
    prior = CarrierPrior.after(0.1, np.array([speed_m_s, 0.0, 0.0]))

    found = register_scans(
        scan(), scan(T_true, seed=2), initial=SE3.identity(), settings=SCANS, prior=prior
    )

    assert found.converged
    assert apart(found.T_target_source, T_true) < 0.03


def test_the_chain_expects_the_speed_it_had() -> None:
    """Into a tunnel at 1.5 m/s: nothing is seen of the motion, so it goes on."""
    chain = ScanChain(SCANS)
    chain.locate(room(), 0)
    chain.keep(SE3.identity(), 0)
    T_first = SE3(np.eye(3), np.array([0.15, 0.0, 0.0]))
    chain.locate(tunnel(), TENTH_NS)
    chain.keep(T_first, TENTH_NS)

    found = chain.locate(tunnel(2), 2 * TENTH_NS)

    assert found is not None
    assert found.t == pytest.approx([0.15, 0.0, 0.0], abs=0.03)
