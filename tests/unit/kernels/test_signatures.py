"""The list of what an installation compiles."""

from graphlib import TopologicalSorter

from recon4.kernels.signatures import SIGNATURES, kernels, spelled


def test_what_is_read_is_what_the_file_says():
    lines = {
        f"{name} of({', '.join(map(spelled, signature))})"
        for name, kernel in kernels().items()
        for signature in kernel.signatures
    }

    assert lines == set(SIGNATURES.read_text("ascii").splitlines())


def test_a_kernel_comes_after_those_it_calls_itself_or_through_inlined_ones():
    calls = {name: kernel.calls for name, kernel in kernels().items()}
    order = list(TopologicalSorter(calls).static_order())

    assert "planes._eigen_sym3" in calls["planes._fit"]
    assert order.index("planes._fit") < order.index("planes.accumulate")


def test_the_decoders_of_all_usual_makes_are_compiled():
    assert {"spinning.decode", "ouster.decode", "livox.decode"} <= kernels().keys()


def test_what_only_longer_walks_call_is_compiled():
    """Places that are left behind, and loops that are searched and rejected."""
    called = {"planes.empty_beyond", "planes.rehash", "scans.count_from_above"}

    assert called | {"paths.mark_affected"} <= kernels().keys()
