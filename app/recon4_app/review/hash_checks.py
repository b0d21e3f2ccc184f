"""Compares approved artifacts with their signed hashes, in the background of the requests.

Comparing a map of tens of gigabytes takes a minute the first time; later only changed files are
read again (`recon4.store.checked`). The page gets a response at once, with the state of the check.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor, TimeoutError
from dataclasses import replace
from pathlib import Path

from recon4.errors import Recon4Error
from recon4.locales.coded import CodedText, text_of
from recon4.review.approval_state import ApprovalState, altered, approval_state
from recon4.review.approved import Approval, approval_of
from recon4.store.checked import Altered
from recon4_app.review.tuning import CHECKS


class ApprovalChecks:
    """Compares approved artifacts and issued files with their hashes, one project at a time."""

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, "approval")
        self._lock = threading.Lock()
        self._running: dict[tuple[Path, str], Future[str]] = {}
        self._altered: dict[tuple[Path, str], str] = {}

    def state(
        self, root: Path, keys: Mapping[str, str], *, within_s: float = CHECKS.answer_within_s
    ) -> ApprovalState:
        """The approval of results, with the outcome of the comparison of every byte.

        Args:
            root: The project folder.
            keys: Stage -> key of its artifact.
            within_s: Time to wait; later than that it is ``checking`` [s].
        """
        found = approval_state(root, keys)
        return self.compared(root, keys, found, within_s=within_s) if found.hash else found

    def compared(
        self, root: Path, keys: Mapping[str, str], found: ApprovalState, *, within_s: float
    ) -> ApprovalState:
        """A state that was read just now, with the outcome of the comparison."""
        key = (root, found.hash)
        with self._lock:
            run = self._running.get(key)
            if run is None:
                run = self._running[key] = self._pool.submit(compare, root, dict(keys))
        try:
            why = run.result(within_s)
        except TimeoutError:
            return replace(found, checking=True)
        with self._lock:
            if self._running.get(key) is run:
                del self._running[key]  # the next request compares files changed since
            self._altered[key] = why
        return altered(found, why) if why else found

    def known(self, root: Path, found: ApprovalState) -> ApprovalState:
        """A state with the outcome of the last comparison, if there was one; nothing is read."""
        with self._lock:
            why = self._altered.get((root, found.hash), "") if found.hash else ""
        return altered(found, why) if why else found

    def close(self) -> None:
        """Start no further comparison."""
        self._pool.shutdown(wait=False, cancel_futures=True)


def compare(root: Path, keys: Mapping[str, str]) -> str:
    """Compare artifacts and issued files with what was signed; what differs, empty = nothing."""
    try:
        approval = approval_of(root, keys)
        if approval is None:
            raise Altered(CodedText("approved-gone"))
        _compare_bytes(root, approval)
    except Recon4Error as error:
        return text_of(error)
    return ""


def _compare_bytes(root: Path, approval: Approval) -> None:
    evidence = approval.evidence
    for stage, key in approval.artifacts.items():
        evidence.artifact(stage, root / "artifacts" / key).check_all()
    approval.check_issued()
