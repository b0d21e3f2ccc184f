"""Storage files of rosbag2 that are compressed as a whole."""

from __future__ import annotations

from pathlib import Path

from recon4.errors import CorruptFile
from recon4.recording.formats.limits import MAX_CHUNK_BYTES, MAX_RATIO, RATIO_FLOOR_BYTES

_PIECE = 4 << 20


def decompress_file(path: Path, folder: Path) -> Path:
    """Decompress a zstd file into a folder; a truncated file as far as possible.

    Raises:
        CorruptFile: If it becomes more than 200 times its size, or is no zstd file.
    """
    import zstandard

    most = max(RATIO_FLOOR_BYTES, MAX_RATIO * path.stat().st_size)
    copy = folder / path.stem
    decoder = zstandard.ZstdDecompressor(max_window_size=MAX_CHUNK_BYTES)
    written = 0
    with path.open("rb") as file, copy.open("wb") as out, decoder.stream_reader(file) as stream:
        try:
            while piece := stream.read(_PIECE):
                written += len(piece)
                if written > most:
                    raise CorruptFile(
                        f"{path.name}: expected {path.stat().st_size} compressed bytes to become "
                        f"at most {most}, got more"
                    )
                out.write(piece)
        except zstandard.ZstdError as error:
            if not written:
                raise CorruptFile(f"{path.name}: no readable zstd file: {error}") from error
    return copy
