"""Limits of what projects are made from, and of their list."""

from __future__ import annotations

from msgspec import Struct


class FolderNameLimits(Struct, frozen=True, kw_only=True):
    """Names of folders."""

    longest: int = 60
    """Characters; leaves space for the number of a repeated title."""


FOLDER_NAMES = FolderNameLimits()


class ImportFolderLimits(Struct, frozen=True, kw_only=True):
    """Folders that recordings may come from."""

    max_entries: int = 2000
    """A longer folder listing is cut."""


IMPORT_FOLDERS = ImportFolderLimits()


class InspectionLimits(Struct, frozen=True, kw_only=True):
    """Looking into a recording."""

    max_beside: int = 50
    """In folders with more files, no IMU or GNSS file is searched for."""


INSPECTION = InspectionLimits()


class LookTimes(Struct, frozen=True, kw_only=True):
    """How long a look may take."""

    look_limit_s: float = 60.0
    """At a recording [s]."""
    compared_within_s: float = 0.3
    """The page of a project waits this long for the comparison with its signature [s]."""


LOOKS = LookTimes()


class ProjectListLimits(Struct, frozen=True, kw_only=True):
    """The list of projects."""

    max_problem: int = 400
    """A longer description of a project's problem is cut [characters]."""
    large: int = 1 << 53
    """Greater numbers are not plausible, and not exact in a browser."""
    max_tags: int = 20
    max_tag: int = 40
    """Characters."""


PROJECT_LIST = ProjectListLimits()


class ThumbnailLimits(Struct, frozen=True, kw_only=True):
    """Thumbnails."""

    max_points: int = 3_000_000
    """Points of a map that are enough for a thumbnail."""


THUMBNAILS = ThumbnailLimits()


class UnlistedLimits(Struct, frozen=True, kw_only=True):
    """Folders that are no projects."""

    max_shown: int = 3
    """Names that are shown."""


UNLISTED = UnlistedLimits()
