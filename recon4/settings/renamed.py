"""Settings that were renamed, so that files and commands of earlier versions are understood."""

RENAMED = {
    ("odometry", "lost_share"): "lost_match_ratio",
    ("scans", "min_share"): "min_inlier_ratio",
    ("scans", "sure_share"): "confident_inlier_ratio",
    ("graph", "drift_share"): "drift_ratio",
    ("graph", "min_share"): "min_match_ratio",
}
"""Group and name in format 1 -> name now."""


def current_name(group: str, name: str) -> str:
    """Today's name of a setting that a file of any version names."""
    return RENAMED.get((group, name), name)
