"""Compares approved artifacts with their signed hashes, in the background of the requests.

Comparing a map of tens of gigabytes takes a minute the first time; later only changed files are
read again (`recon4.store.checked`). The page gets a response at once, with the state of the check.
"""

from __future__ import annotations

import threading
from concurrent.futures import Future, ThreadPoolExecutor, TimeoutError
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from recon4.errors import Recon4Error
from recon4.review.approved import Approval

ANSWER_WITHIN_S = 2.0
"""A request waits this long for a comparison [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckState:
    """State of the comparison of an approved map with its signature."""

    state: Literal["checked", "checking", "altered"]
    message: str = ""
    """Of ``altered``: which file, what was expected, what was found."""


class ApprovalChecks:
    """Compares approved artifacts and issued files with their hashes, one project at a time."""

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, "approval")
        self._lock = threading.Lock()
        self._running: dict[tuple[Path, str], Future[CheckState]] = {}

    def state(self, root: Path, approval: Approval) -> CheckState:
        """Compare every byte of the approved files; ``checking`` while that is not finished.

        Args:
            root: The project folder.
            approval: Approval of its results.
        """
        key = (root, approval.hash)
        with self._lock:
            run = self._running.get(key)
            if run is None:
                run = self._running[key] = self._pool.submit(compare, root, approval)
        try:
            found = run.result(ANSWER_WITHIN_S)
        except TimeoutError:
            return CheckState(state="checking")
        with self._lock:
            if self._running.get(key) is run:
                del self._running[key]  # the next request compares files changed since
        return found

    def close(self) -> None:
        """Start no further comparison."""
        self._pool.shutdown(wait=False, cancel_futures=True)


def compare(root: Path, approval: Approval) -> CheckState:
    """Compare the artifacts and the issued files of an approval with what was signed."""
    evidence = approval.evidence
    try:
        for stage, key in approval.artifacts.items():
            evidence.artifact(stage, root / "artifacts" / key).check_all()
        approval.check_issued()
    except Recon4Error as error:
        return CheckState(state="altered", message=str(error))
    return CheckState(state="checked")
