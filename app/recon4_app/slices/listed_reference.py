"""A reference of a project as pages see it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.recording.tables.column_names import Meaning, Unit
from recon4.slices.reference import ReferenceFacts, alignment_text


@dataclass(frozen=True, slots=True, kw_only=True)
class ListedReference:
    """A reference of a project; `ReferenceFacts` with its id, or the problem with its files."""

    id: str
    name: str
    file: str = ""
    frame: Literal["map", "crs"] = "map"
    T_map_reference: list[list[float]] | None = None
    alignment: str = ""
    """How it was aligned with the map."""
    fit: str = ""
    """How well it lies on the map after its last alignment; empty = not compared."""
    fits: bool | None = None
    """Whether it does; null = not compared, or not judged."""
    can_undo: bool = False
    kind: Literal["mesh", "cloud", "damaged"]
    points: int = 0
    triangles: int = 0
    columns: tuple[Meaning, ...] = ()
    unit: Unit | Literal[""] = ""
    notes: tuple[str, ...] = ()
    problem: str = ""
    """Why it cannot be used; empty if it can."""

    @staticmethod
    def of(reference_id: str, facts: ReferenceFacts, language: str) -> ListedReference:
        """A reference whose files are all right."""
        return ListedReference(
            id=reference_id,
            name=facts.name,
            file=facts.file,
            frame=facts.frame,
            T_map_reference=facts.T_map_reference,
            alignment=alignment_text(facts.alignment, language),
            fit=" ".join(one.said(language) for one in facts.fit),
            fits=facts.fits,
            can_undo=facts.earlier is not None,
            kind=facts.kind,
            points=facts.points,
            triangles=facts.triangles,
            columns=facts.columns,
            unit=facts.unit,
            notes=tuple(one.said(language) for one in facts.notes),
        )
