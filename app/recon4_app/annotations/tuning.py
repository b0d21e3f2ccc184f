"""Limits of notes and saved views."""

from __future__ import annotations

from msgspec import Struct


class AnnotationLimits(Struct, frozen=True, kw_only=True):
    """What people may pin to a map."""

    format: int = 1
    """Of the files."""
    max_file_bytes: int = 16 << 20
    """A larger file was not written by us."""
    max_notes: int = 5000
    """Notes of a project."""
    max_note_characters: int = 500
    max_photos: int = 100
    """Photos of a project: all of them go into one BCF file."""
    max_sent_characters: int = 900_000
    """Longest photo in a request, as base64."""
    max_pixels: int = 50_000_000
    """Of a photo before it is made smaller."""
    photo_px: int = 2048
    """Longer side of a kept photo [px]."""
    photo_quality: int = 85
    """Of its JPEG file, of 100."""
    max_views: int = 200
    """Saved views of a project."""
    max_query_characters: int = 8000
    """State of a view, as in the address of the page."""


ANNOTATIONS = AnnotationLimits()
