"""Requests and responses about files that become references."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, Field

from recon4.recording.tables.column_names import Meaning, Unit
from recon4.recording.tables.coordinates import ColumnChoice, TablePreview
from recon4.recording.tables.tuning import SHOWN_TABLE
from recon4.slices.reference_import import ReadAs
from recon4_app.names import Name
from recon4_app.slices.model import Strict


class ReferenceFile(Strict):
    """A file on this computer, and what a person says of it."""

    path: str = Field(min_length=1, max_length=4096)
    frame: Literal["auto", "map", "crs"] = "auto"
    """Frame of its coordinates: as the file says, the map frame, or the CRS of the map."""
    columns: tuple[Meaning, ...] = Field(default=(), max_length=SHOWN_TABLE.columns)
    """Meaning of each column of a text, from the left; empty = as the table says."""
    unit: Unit | None = None
    """Unit of its coordinates; None = as the file says, else meters."""

    @property
    def choice(self) -> ColumnChoice:
        """Columns and unit."""
        return ColumnChoice(self.columns, self.unit)

    @property
    def read_as(self) -> ReadAs:
        """Frame, columns and unit."""
        return ReadAs(self.frame, self.choice)


class AddReference(ReferenceFile):
    """Request to import a file on this computer as a reference."""

    name: Name = Field(default="", max_length=100)


class ReferencePreview(BaseModel):
    """What is known of a file before it is imported."""

    table: TablePreview | None
    """First rows and columns; None = the file is no text."""
