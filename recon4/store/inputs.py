"""External files, such as recordings, as inputs of stages: keyed by their content."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from recon4.errors import RecordingError
from recon4.locales.coded import CodedText
from recon4.progress import Progress
from recon4.store.hashing import files_below, hash_json, hash_shown
from recon4.store.ledger import Ledger
from recon4.store.stage import Input
from recon4.untrusted.names import is_unnameable, visible


def input_file(path: Path, ledger: Ledger, progress: Progress) -> Input:
    """Input of one file or folder, keyed by its content; the value is its path.

    A folder (a bag, a folder of frames) is keyed by the names and contents of its files.

    Raises:
        RecordingError: If there is no such file or it cannot be read.
    """
    return Input(_hash_of(path, ledger, progress), path)


def input_files(paths: Sequence[Path], ledger: Ledger, progress: Progress) -> Input:
    """Input of several files or folders, in order; the value is the tuple of paths.

    Raises:
        RecordingError: If one is missing or cannot be read.
    """
    hashes = [_hash_of(path, ledger, progress) for path in paths]
    return Input(hash_json(hashes), tuple(paths))


def _hash_of(path: Path, ledger: Ledger, progress: Progress) -> str:
    try:
        _check_text(path.name)
        if path.is_dir():
            names = files_below(path)
            _check_text(*names)
            return hash_json({n: _hash_file(path / n, ledger, progress) for n in names})
        return _hash_file(path, ledger, progress)
    except OSError as error:
        raise RecordingError(
            CodedText("cannot-read", file=str(path), why=str(error.strerror))
        ) from error


def _check_text(*names: str) -> None:
    """Names stand in reports and in JSON, which are UTF-8 text."""
    wrong = next((name for name in names if is_unnameable(name)), None)
    if wrong is not None:
        raise RecordingError(CodedText("name-no-utf8", wrong=visible(wrong)))


def _hash_file(path: Path, ledger: Ledger, progress: Progress) -> str:
    known = ledger.cached_hash(path)
    if known is not None:
        return known
    found = hash_shown(path, progress)
    ledger.remember_hash(path, found)
    return found
