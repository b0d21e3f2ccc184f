"""Collects what happened and posts it, until each receiver took it."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

from recon4.errors import Recon4Error
from recon4.locales.coded import CodedText, StoredText, text_of
from recon4.review.decisions import DecisionKind
from recon4.review.journal import read_rows
from recon4.review.newest_approval import APPROVALS
from recon4_app.access.audit import AuditLog
from recon4_app.errors import AppError
from recon4_app.jobs.model import Job
from recon4_app.jobs.store import JobStore
from recon4_app.settings import Network, ServerSettings
from recon4_app.threads import in_thread
from recon4_app.webhooks.addresses import NotReachable, target_of
from recon4_app.webhooks.model import EventKind, Waiting, WebhookEvent
from recon4_app.webhooks.post import post
from recon4_app.webhooks.signing import signed_headers
from recon4_app.webhooks.store import WebhookStore
from recon4_app.webhooks.tuning import WEBHOOKS

log = logging.getLogger(__name__)


class Webhooks:
    """The webhooks of a server, and the task that serves them."""

    def __init__(
        self, store: WebhookStore, jobs: JobStore, log: AuditLog, *, settings: ServerSettings
    ) -> None:
        self.store = store
        self.networks: Sequence[Network] = settings.webhook_networks
        """Networks besides the internet that may be called."""
        self._jobs, self._log = jobs, log
        self._root, self._records = settings.root, settings.state / APPROVALS
        self._seen_ns: dict[str, int] = {}
        """Record of an approval -> its modification time when it was collected."""
        self._loop: asyncio.AbstractEventLoop | None = None
        self._wake = asyncio.Event()
        jobs.on_ended = self.wake

    def wake(self) -> None:
        """Look for news now. Thread-safe."""
        if self._loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop is closed: the next server looks
                self._loop.call_soon_threadsafe(self._wake.set)

    async def run(self) -> None:
        """Collect and deliver until cancelled."""
        self._loop = asyncio.get_running_loop()
        while True:
            self._wake.clear()
            pause_s = WEBHOOKS.look_every_s
            try:
                await in_thread(self.collect)
                await self.deliver()
                next_s = await in_thread(self.store.next_due_s)
                pause_s = pause_s if next_s is None else min(next_s, pause_s)
            except Exception:
                log.exception("webhooks: trying again")
                pause_s = WEBHOOKS.first_retry_s
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(pause_s):
                    await self._wake.wait()

    def collect(self) -> None:
        """Keep what happened for the webhooks that take it."""
        ended = self._jobs.ended()
        for job in ended:
            self.store.keep(_ended_event(job))
        if ended:
            self._jobs.forget_ended([job.id for job in ended])
        if self.store.wants(EventKind.APPROVAL_SIGNED):
            self._collect_approvals()

    async def deliver(self) -> None:
        """Post what is due; the receivers do not wait for each other."""
        by_webhook: dict[str, list[Waiting]] = defaultdict(list)
        for one in await in_thread(self.store.due):
            by_webhook[one.webhook].append(one)
        await asyncio.gather(
            *(self._deliver_all(waiting[: WEBHOOKS.batch]) for waiting in by_webhook.values())
        )

    def _collect_approvals(self) -> None:
        for record in self._records.glob("*.json") if self._records.is_dir() else ():
            folder, changed_ns = self._root / record.stem, record.stat().st_mtime_ns
            if "@" in record.stem or self._seen_ns.get(record.stem) == changed_ns:
                continue
            try:
                event = _approval_event(folder)
            except (Recon4Error, OSError) as error:
                log.warning("the approval of %s is not posted: %s", folder.name, error)
                continue
            if event is not None:
                self.store.keep(event)
            self._seen_ns[record.stem] = changed_ns

    async def _deliver_all(self, waiting: Sequence[Waiting]) -> None:
        for one in waiting:
            await self._deliver(one)

    async def _deliver(self, one: Waiting) -> None:
        target = target_of(one.url)
        headers = signed_headers(one.secret, one.event, one.body, now_s=time.time())
        try:
            status = await post(target, one.body, headers, networks=self.networks)
            problem = "" if 200 <= status < 300 else _status_problem(status)
        except NotReachable as error:
            problem = text_of(error)
        await in_thread(self._note, one, problem)

    def _note(self, one: Waiting, problem: str) -> None:
        if problem:
            grown_s = WEBHOOKS.first_retry_s * WEBHOOKS.growth ** min(one.attempts, WEBHOOKS.batch)
            self.store.failed(
                one.number, StoredText.of(problem), again_s=min(grown_s, WEBHOOKS.longest_retry_s)
            )
        else:
            self.store.delivered(one.number)
        if one.attempts and problem:
            return  # the first failure is in the log
        what = f"{one.kind} {one.event} to {target_of(one.url).authority}"  # paths hold secrets
        outcome = "failed" if problem else "done"
        with contextlib.suppress(AppError):  # a full disk; the server's log has it
            self._log.add("server", "", action="post webhook", what=what, outcome=outcome)


def trial_event(webhook_id: str, number: str, *, time: str) -> WebhookEvent:
    """What an admin sends to try a webhook."""
    return WebhookEvent(
        id=f"test-{number}", kind=EventKind.TEST, time=time, data={"webhook": webhook_id}
    )


def _ended_event(job: Job) -> WebhookEvent:
    data = {
        "job": job.id,
        "project": job.project,
        "state": str(job.state),
        "note": job.note,
        "created": job.created,
        "started": job.started,
        "finished": job.finished,
    }
    time = job.finished or job.created
    return WebhookEvent(id=f"job-{job.id}", kind=EventKind.JOB_FINISHED, time=time, data=data)


def _approval_event(project: Path) -> WebhookEvent | None:
    """The newest approval of a project; None if its journal has none."""
    rows = [row for row in read_rows(project) if row.kind == DecisionKind.APPROVE]
    if not rows:
        return None
    row, version = rows[-1], len(rows)
    data: dict[str, str | int] = {"project": project.name, "version": version}
    data |= {"who": row.who, "time": row.time}
    event = f"approval-{row.sealed()[:32]}"
    return WebhookEvent(id=event, kind=EventKind.APPROVAL_SIGNED, time=row.time, data=data)


def _status_problem(status: int) -> CodedText:
    code = "host-moved" if 300 <= status < 400 else "host-refused"
    return CodedText(code, status=str(status))
