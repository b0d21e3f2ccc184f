"""Tuning of reviews, and limits of what people give to them."""

from __future__ import annotations

from msgspec import Struct


class AcknowledgmentLimits(Struct, frozen=True, kw_only=True):
    """Notes of a reviewer."""

    head_bytes: int = 1 << 20
    """The block with the approval is within the first bytes of a report."""


ACKNOWLEDGMENTS = AcknowledgmentLimits()


class StampLimits(Struct, frozen=True, kw_only=True):
    """Approvals in files."""

    ply_line_bytes: int = 900
    """Of an approval in a PLY: rply, of Open3D and CloudCompare, refuses lines above 1024."""
    escape_bytes: int = 12
    """Of a character in JSON in ASCII, at most."""


STAMPS = StampLimits()


class ChangeTuning(Struct, frozen=True, kw_only=True):
    """What a decision changes."""

    changed_m: float = 0.1
    """Translation between the pose the reviewer saw and the edge that is reported [m]."""
    changed_rad: float = 0.02
    """Rotation that is reported [rad]."""


CHANGES = ChangeTuning()


class InfluenceTuning(Struct, frozen=True, kw_only=True):
    """How far an edge moves the map."""

    nothing: float = 1e-12
    """Weight of structural entries, as a fraction of the largest information."""
    gauge: float = 1e9
    """Information that fixes the first node."""


INFLUENCE = InfluenceTuning()


class ReviewPairTuning(Struct, frozen=True, kw_only=True):
    """Points and poses of a pair."""

    max_points: int = 30_000
    """Limit for each multiframe of the pair."""
    max_reach: int = 10
    """Largest number of multiframes shown before and after each one."""
    voxel_m: float = 0.04
    """Edge of the voxels to which points are thinned [m]."""
    max_range_m: float = 60.0
    """Points farther from the sensor are not shown [m]."""
    min_spread_m: float = 0.1
    """Smallest extent of picked points across their principal line [m]."""


REVIEW_PAIRS = ReviewPairTuning()


class PreviewTuning(Struct, frozen=True, kw_only=True):
    """Preview of decisions."""

    remembered: int = 6
    """Solved graphs that are kept."""


PREVIEW = PreviewTuning()


class QueueTuning(Struct, frozen=True, kw_only=True):
    """The review queue."""

    max_paths: int = 60
    """Largest number of alternative paths listed for a pair, the worst first."""


QUEUE = QueueTuning()


class ReviewSolveTuning(Struct, frozen=True, kw_only=True):
    """What a solved review reports."""

    max_moves: int = 10
    """Nodes whose shift is reported."""
    apart_nodes: int = 5
    """Nodes closer than this along the trajectory count as one move."""
    min_move_m: float = 1e-4
    """Smaller shifts are not reported [m]."""
    named_pairs: int = 5
    """Pairs that a message names."""
    same_chi2: float = 1e-9
    """A solve whose chi-square is larger by no more than this, relatively, has the same minimum."""


REVIEW_SOLVE = ReviewSolveTuning()


class ApprovalLimits(Struct, frozen=True, kw_only=True):
    """Approvals."""

    min_reason_characters: int = 10
    """A shorter text is no reason to approve a map in spite of its verdict."""


APPROVALS = ApprovalLimits()


class ApprovalNameLimits(Struct, frozen=True, kw_only=True):
    """Names in an approval."""

    max_name: int = 60
    """A longer name of a signer is cut [characters]."""
    max_detail: int = 800
    """A longer reason why an approval does not count is cut [characters]."""


APPROVAL_NAMES = ApprovalNameLimits()


class NewestApprovalLimits(Struct, frozen=True, kw_only=True):
    """Records of newest approvals."""

    max_record_bytes: int = 64 << 10
    """Largest record."""


NEWEST_APPROVALS = NewestApprovalLimits()


class SummaryLimits(Struct, frozen=True, kw_only=True):
    """Summaries that are read."""

    max_summary_bytes: int = 16 << 20
    """Largest summary."""


SUMMARIES = SummaryLimits()


class TrustedKeyLimits(Struct, frozen=True, kw_only=True):
    """Keys whose signatures count."""

    max_name_characters: int = 100
    """Longest name of a key."""
    max_key_file_bytes: int = 64 << 10
    """Largest file of a key."""


KEY_LIMITS = TrustedKeyLimits()


class CertificateTuning(Struct, frozen=True, kw_only=True):
    """Certificates of signing keys."""

    days: int = 10_950
    """Validity [d]: a report is kept as long as a building stands."""


CERTIFICATES = CertificateTuning()


class CorrectionFileTuning(Struct, frozen=True, kw_only=True):
    """Lists of corrections of classes."""

    max_bytes: int = 4 << 20
    most: int = 1000
    """Corrections in a list."""
    columns: frozenset[str] = frozenset(
        ("shape", "to", "only", "why", "x", "y", "z", "dx", "dy", "dz", "yaw_deg", "radius")
    ) | {"polygon", "path", "low", "high", "alike"}
    """Of a table."""


CORRECTION_FILES = CorrectionFileTuning()


class AnnotationFiles(Struct, frozen=True, kw_only=True):
    """What people pin to a map (`annotations.py`); the server writes it."""

    notes: str = "annotations/notes.json"
    views: str = "annotations/views.json"
    """Below the project folder."""
    format: int = 1
    max_bytes: int = 16 << 20
    """A larger file was not written by us."""


ANNOTATION_FILES = AnnotationFiles()
