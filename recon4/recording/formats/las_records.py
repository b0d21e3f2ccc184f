"""Points of LAS and LAZ files of unknown origin, piece by piece.

Sizes are checked before a decoder sees them (`recon4.recording.formats.las_check`), but the decoder
of LAZ is not ours.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from recon4.errors import CorruptFile, Recon4Error, RecordingError
from recon4.locales.coded import CodedText
from recon4.recording.formats.las_check import LasHeader, check_las
from recon4.untrusted.bounded import open_regular

CHUNK = 1_000_000
MAX_POINTS = 400_000_000
MAX_POINTS_A_BYTE, FREE_POINTS = 40, 5_000_000
"""Most points a byte of a compressed file, beyond some."""


def las_header(path: Path) -> LasHeader:
    """The header of a file whose sizes fit its length.

    Raises:
        CorruptFile: If they do not.
        RecordingError: If it has absurdly many points.
    """
    with open_regular(path) as raw:
        header = check_las(raw, path.name)
    refuse_many(header.points, path.name)
    if header.compressed:
        refuse_promise(path, header.points)
    return header


def las_points(path: Path, *, most: int | None = None) -> Iterator[Any]:
    """The points of a file, `CHUNK` at a time, as records of laspy.

    Args:
        path: The file.
        most: Only the first ones; None = all.

    Raises:
        CorruptFile: If the bytes do not match the format.
        RecordingError: If there are absurdly many points.
    """
    import laspy

    promised, got = las_header(path).points, 0
    wanted = promised if most is None else min(most, promised)
    with (
        open_regular(path) as raw,
        _decoding(path.name),
        laspy.open(raw, laz_backend=laspy.LazBackend.Lazrs, read_evlrs=False) as file,
    ):
        for points in file.chunk_iterator(min(CHUNK, max(1, wanted))):
            got += len(points)
            yield points
            if got >= wanted:
                break
    if got < wanted:
        raise CorruptFile(CodedText("points-cut", file=path.name, promised=promised, got=got))


@contextmanager
def _decoding(name: str) -> Iterator[None]:
    """Convert errors of a decoder over damaged bytes to `CorruptFile`.

    laspy and lazrs document no errors for them; a panic of Rust is no ``Exception``.
    """
    try:
        yield
    except (Recon4Error, MemoryError, GeneratorExit, KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:
        raise CorruptFile(f"{name}: not a sound LAS/LAZ file: {error!r}"[:400]) from error


def refuse_many(points: int, name: str) -> None:
    """Refuse more points than a computer holds.

    Raises:
        RecordingError: If there are more than `MAX_POINTS`.
    """
    if points > MAX_POINTS:
        raise RecordingError(
            CodedText("las-points-many", name=name, max_points=MAX_POINTS, points=points)
        )


def refuse_promise(path: Path, promised: int) -> None:
    """Refuse more points than a compressed file of this size has unless all are the same.

    A measured point takes a byte or more, a repeated one next to nothing.

    Raises:
        CorruptFile: If there are more.
    """
    size = path.stat().st_size
    most = max(FREE_POINTS, MAX_POINTS_A_BYTE * size)
    if promised > most:
        raise CorruptFile(
            CodedText("laz-expansion", file=path.name, most=most, size=size, promised=promised)
        )
