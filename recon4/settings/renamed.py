"""Renamed settings, so that files and commands of earlier versions stay readable."""

RENAMED = {
    ("odometry", "lost_share"): "lost_match_ratio",
    ("scans", "min_share"): "min_inlier_ratio",
    ("scans", "sure_share"): "confident_inlier_ratio",
    ("graph", "drift_share"): "drift_ratio",
    ("graph", "min_share"): "min_match_ratio",
}
"""Group and name in format 1 -> current name."""


def current_name(group: str, name: str) -> str:
    """Current name of a setting in a file of any version."""
    return RENAMED.get((group, name), name)
