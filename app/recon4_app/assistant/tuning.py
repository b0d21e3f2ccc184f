"""Limits of the tools for assistants."""

from __future__ import annotations

from msgspec import Struct


class AssistantLimits(Struct, frozen=True, kw_only=True):
    """How much a tool returns, and how long it may wait."""

    connect_s: float = 10.0
    """For a connection to the server [s]."""
    answer_s: float = 300.0
    """For the next bytes of a response [s]; exports and images of large maps take minutes."""
    most_projects: int = 200
    """Projects in one answer; a longer list is searched."""
    most_pairs: int = 100
    """Pairs of the review queue in one answer."""
    longest_wait_s: float = 600.0
    """One call that watches a job [s]; hosts end longer ones."""
    chunk_bytes: int = 1 << 20
    """Piece of a download that is written at a time."""
    waiting_pieces: int = 16
    """Pieces of a response within this process that wait to be read."""
    max_message_bytes: int = 256 << 10
    """Largest message of an assistant over HTTP; a job with all settings takes 20 kB."""
    image_px: int = 1000
    """Usual width of an image of a slice."""
    eye_m: float = 1.2
    """Usual height of a horizontal slice over the floor [m]: above tables, below lamps."""


ASSISTANT = AssistantLimits()
