"""Single damaged lines of a text file: dropped and counted, up to a limit."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.errors import CorruptFile, Recon4Error
from recon4.locales.coded import CodedText, text_of
from recon4.recording.report import ImportReport

MAX_RATIO = 0.05
"""A file with more damaged lines than this is something else than it seems, and is refused."""


def wrong_row(name: str, number: int, row: str, *, why: Exception | str) -> CodedText:
    """What is wrong with a row of a file, and what it is."""
    reason = text_of(why) if isinstance(why, Exception) else why
    return CodedText("line-wrong", name=name, line=number, row=row.strip()[:80], why=reason)


@dataclass(slots=True)
class DamagedLines:
    """The damaged lines of one file."""

    report: ImportReport
    count: str
    """Name under which they are counted."""
    number: int = 0
    first: str = ""
    """The first one: file, line, what was expected and found."""

    def add(self, error: Recon4Error) -> None:
        """Drop a line."""
        self.first = self.first or text_of(error)
        self.number += 1

    def check(self, sound: int) -> None:
        """Refuse the file if too many of its lines are damaged.

        Args:
            sound: Number of the other lines so far.

        Raises:
            CorruptFile: With the first damaged line, and how many there are.
        """
        total = sound + self.number
        if self.number > MAX_RATIO * total:
            raise CorruptFile(
                CodedText(
                    "lines-damaged-many",
                    first=self.first,
                    number=self.number,
                    total=total,
                    max_ratio=100 * MAX_RATIO,
                )
            )

    def finish(self, sound: int) -> None:
        """Check, and report what was dropped.

        Raises:
            CorruptFile: As `check`.
        """
        self.check(sound)
        if self.number:
            self.report.count(self.count, self.number)
            self.report.details[self.count] = CodedText("detail-first", problem=self.first)
