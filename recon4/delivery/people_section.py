"""What people pinned to a map and measured in it, for the report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from recon4.report.client import Section, Table
from recon4.report.client_front import shown
from recon4.report.client_words import Words
from recon4.report.tuning import CLIENT_REPORT
from recon4.review.annotations import pinned_notes, saved_measurements


def people_section(root: Path, words: Words) -> Section:
    """Notes and measurements of a project, each with who made it and when.

    Raises:
        Altered: If a file was changed by another program.
        StoreError: If one is damaged.
    """
    most = CLIENT_REPORT.most_notes
    notes, measured = pinned_notes(root), saved_measurements(root)
    of_notes: list[tuple[str, ...]] = [
        (
            shown(one.text),
            words.term(one.status),
            _place(one.p_map, words),
            shown(one.who),
            one.time[:10],
        )
        for one in notes[:most]
    ]
    of_measurements: list[tuple[str, ...]] = [
        (
            shown(one.name or one.view.name),
            words.term(shown(one.kind)),
            words.decimal(one.text),
            _place(one.points[0], words),
            shown(one.view.who),
            one.view.time[:10],
        )
        for one in measured[:most]
    ]
    left = max(0, len(notes) - most) + max(0, len(measured) - most)
    names = (("note", "status"), ("name", "kind", "value"))
    tables = tuple(
        Table(
            head=tuple(words(f"people.{name}") for name in (*own, "place", "who", "date")),
            rows=tuple(rows),
            texts=tuple(range(1, len(own) + 3)),
            title=words(f"people.{title}"),
        )
        for title, own, rows in zip(
            ("notes", "measurements"), names, (of_notes, of_measurements), strict=True
        )
        if rows
    )
    more = (words("people.more", count=str(left)),) if left else ()
    return Section(title=words("section.people"), text=(words("text.people"), *more), tables=tables)


def _place(p_map: Sequence[float], words: Words) -> str:
    return ", ".join(words.number(value) for value in p_map)
