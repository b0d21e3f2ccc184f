"""Storage files of rosbag2 that are compressed as a whole."""

from __future__ import annotations

from pathlib import Path

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.formats.limits import MAX_CHUNK_BYTES, Budget

_PIECE = 4 << 20


def decompress_file(path: Path, folder: Path, budget: Budget) -> Path:
    """Decompress a zstd file into a folder; a truncated file as far as possible.

    Args:
        path: The file.
        folder: Gets the copy.
        budget: Of all files of the bag.

    Raises:
        CorruptFile: If it is no zstd file, or the files become too many bytes.
    """
    import zstandard

    copy = folder / path.stem
    decoder = zstandard.ZstdDecompressor(max_window_size=MAX_CHUNK_BYTES)
    written = 0
    with path.open("rb") as file, copy.open("wb") as out, decoder.stream_reader(file) as stream:
        try:
            while piece := stream.read(_PIECE):
                written += len(piece)
                budget.charge(len(piece), path.name)
                out.write(piece)
        except zstandard.ZstdError as error:
            if not written:
                raise CorruptFile(
                    CodedText("zstd-unreadable", file=path.name, why=str(error))
                ) from error
    return copy
