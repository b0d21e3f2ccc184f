"""The list of what an installation compiles."""

from graphlib import TopologicalSorter

from numba.types import NamedTuple

from recon4.kernels.signatures import SIGNATURES, kernels, spelled


def test_what_is_read_is_what_the_file_says():
    lines = {
        f"{name} of({', '.join(map(spelled, signature))})"
        for name, kernel in kernels().items()
        for signature in kernel.signatures
    }

    assert lines == set(SIGNATURES.read_text("ascii").splitlines())


def test_records_of_the_file_have_the_fields_of_their_classes():
    types = [one for kernel in kernels().values() for types in kernel.signatures for one in types]
    records = [one for one in types if isinstance(one, NamedTuple)]

    assert len(records) > 20
    assert [one for one in records if len(one.types) != len(one.instance_class._fields)] == []


def test_a_kernel_comes_after_those_it_calls_itself_or_through_inlined_ones():
    calls = {name: kernel.calls for name, kernel in kernels().items()}
    order = list(TopologicalSorter(calls).static_order())

    assert "eigen.eigen_sym3" in calls["planes._fit"]
    assert order.index("planes._fit") < order.index("planes.accumulate")


def test_the_decoders_of_all_usual_makes_are_compiled():
    assert {"spinning.decode", "ouster.decode", "livox.decode"} <= kernels().keys()


def test_what_only_longer_walks_call_is_compiled():
    """Places that are left behind, and loops that are searched and rejected."""
    called = {"planes.empty_beyond", "planes.rehash", "scans.count_from_above"}

    assert called | {"paths.mark_affected"} <= kernels().keys()
