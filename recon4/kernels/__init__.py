"""Hot loops, compiled by Numba."""

from recon4.kernels.processor import choose_instructions

choose_instructions()
