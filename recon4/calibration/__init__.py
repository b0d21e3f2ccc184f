"""Calibration of a rig from a walk: mounts, clocks and beams of its sensors."""
