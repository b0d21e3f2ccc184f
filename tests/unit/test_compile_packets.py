"""Decoders of packets are compiled before a confined process needs them."""

from recon4.kernels import livox, ouster, spinning
from recon4.system.compile_packets import compile_packets


def test_the_decoders_of_all_usual_makes_are_compiled():
    compile_packets()

    for kernel in (spinning.decode, ouster.decode, livox.decode):
        assert kernel.signatures, kernel
