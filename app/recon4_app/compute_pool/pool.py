"""The pool of child processes: queues of calls, reuse of children, limits."""

from __future__ import annotations

import asyncio
import shutil
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from recon4.locales.coded import CodedText
from recon4.system.processes import ChildRegister
from recon4_app.compute_pool.fair_queue import FairQueue
from recon4_app.compute_pool.messages import Call, declared
from recon4_app.compute_pool.model import QUOTAS, FileAccess, Lane, Quota, Terms
from recon4_app.compute_pool.process import ChildProcess
from recon4_app.compute_pool.tuning import POOL_TIMES
from recon4_app.errors import ComputeFailed

T = TypeVar("T")

INTERACTIVE_MODULES = (
    "recon4_app.slices.slice_work",
    "recon4_app.review.review_work",
    "recon4_app.map_view.map_work",
)


@dataclass(frozen=True, slots=True)
class _Permission:
    """The calls that a kept child may serve."""

    lane: Lane
    access: FileAccess
    files: tuple[tuple[int, int] | None, ...]
    """Device and number of each path: the child may open these, whatever their names are now."""

    @staticmethod
    def of(lane: Lane, access: FileAccess) -> _Permission:
        paths = (*access.read, *access.write)
        return _Permission(lane, access, tuple(_identity(path) for path in paths))


class ComputePool:
    """Runs functions of modules in confined children.

    Arguments must be picklable. Results are what the function's annotation declares, as JSON;
    `bytes` go as they are.
    """

    def __init__(
        self, scratch: Path, quotas: Mapping[Lane, Quota] = QUOTAS, *, children: ChildRegister
    ) -> None:
        """Create the pool; no child is started yet.

        Args:
            scratch: Folder for the working folders of children; it is emptied.
            quotas: Limits of each lane.
            children: Where the processes are registered.
        """
        self._scratch = scratch
        self._children = children
        shutil.rmtree(scratch, ignore_errors=True)
        self.queues = {lane: FairQueue(lane, quota) for lane, quota in quotas.items()}
        self._kept: OrderedDict[_Permission, list[ChildProcess]] = OrderedDict()
        self._spare: ChildProcess | None = None
        self._preparing: asyncio.TimerHandle | None = None
        self._tasks: set[asyncio.Task[Any]] = set()
        self._closed = False

    async def run_interactive(
        self, lane: Lane, terms: Terms, function: Callable[..., T], *args: object, **kwargs: object
    ) -> T:
        """Run ``function`` in a child while a person waits, and return its result.

        Its child is kept for the next call of the same lane with the same file access.

        Raises:
            TooMany: If too many calls wait already.
            ComputeFailed: If the child died or took longer than the limit.
            Recon4Error: Whatever the function raises.
        """
        return await self._run(lane, terms, Call(function, args, kwargs), background=False)

    async def run_background(
        self, lane: Lane, terms: Terms, function: Callable[..., T], *args: object, **kwargs: object
    ) -> T:
        """Run ``function`` that takes minutes or reads a file of unknown origin.

        It runs in a fresh child, behind interactive work, and ends at once with its request.

        Raises:
            TooMany, ComputeFailed, Recon4Error: As `run_interactive`.
        """
        return await self._run(lane, terms, Call(function, args, kwargs), background=True)

    async def close(self) -> None:
        """End all calls and children."""
        self._closed = True
        if self._preparing is not None:
            self._preparing.cancel()
        for task in self._tasks:
            if not task.cancelling():  # one that ends its child already is left to do so
                task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        kept = [child for children in self._kept.values() for child in children]
        self._kept.clear()
        spare, self._spare = self._spare, None
        for child in (*kept, *((spare,) if spare else ())):
            await child.end()

    async def _run(self, lane: Lane, terms: Terms, call: Call, *, background: bool) -> Any:
        declared(call.function)  # a function without a declared result is rejected before it waits
        slot = await self.queues[lane].acquire(terms.person, large=terms.large)
        if self._closed:
            self.queues[lane].release(slot)
            raise ComputeFailed(CodedText("server-stopping"))
        serving = self._start(self._serve(lane, terms, call, background=background))
        # Not in `_serve`: a task that is cancelled before its first step runs none of its code.
        serving.add_done_callback(lambda _: self.queues[lane].release(slot))
        try:
            return await asyncio.shield(serving)
        except asyncio.CancelledError:
            if background:
                serving.cancel()
            else:
                asyncio.get_running_loop().call_later(POOL_TIMES.grace_s, serving.cancel)
            serving.add_done_callback(_retrieved)
            raise

    async def _serve(self, lane: Lane, terms: Terms, call: Call, *, background: bool) -> Any:
        """Run a call in a child; when this returns, no child works on it."""
        usual_s = POOL_TIMES.background_limit_s if background else POOL_TIMES.interactive_limit_s
        limit_s = terms.limit_s or usual_s
        permission = _Permission.of(lane, terms.access)
        child: ChildProcess | None = None
        whole = False
        try:
            child = await self._child(permission, background=background)
            async with asyncio.timeout(limit_s):
                answer = await child.call(call, terms.access)
            await asyncio.to_thread(child.keep, terms.outputs)
            whole = True
            return answer
        except TimeoutError as error:
            raise ComputeFailed(CodedText("too-slow", seconds=f"{limit_s:.0f}")) from error
        except ComputeFailed:
            raise
        except Exception:
            whole = True  # the function failed, not its child
            raise
        finally:
            await self._put_away(permission, child, keep=whole and not background)

    async def _child(self, permission: _Permission, *, background: bool) -> ChildProcess:
        """A kept child that may open these files, else a fresh one; background always fresh."""
        if background:
            return await self._start_child(background=True)
        while kept := self._kept.get(permission):
            child = kept.pop()
            if not kept:
                del self._kept[permission]
            if child.alive:
                return child
            await child.end()
        spare, self._spare = self._spare, None
        self.prepare_spare()
        if spare is not None and spare.alive:
            return spare
        if spare is not None:
            await spare.end()
        return await self._start_child(background=False)

    async def _start_child(self, *, background: bool, modules: Sequence[str] = ()) -> ChildProcess:
        return await ChildProcess.start(
            self._scratch, background=background, children=self._children, modules=modules
        )

    async def _put_away(
        self, permission: _Permission, child: ChildProcess | None, *, keep: bool
    ) -> None:
        if child is None:
            return
        if not (keep and child.alive):
            await child.end()
            return
        self._kept.setdefault(permission, []).append(child)
        self._kept.move_to_end(permission)
        while sum(map(len, self._kept.values())) > POOL_TIMES.max_kept:
            oldest = next(iter(self._kept))
            gone = self._kept[oldest].pop(0)
            if not self._kept[oldest]:
                del self._kept[oldest]
            await gone.end()

    def prepare_spare(self) -> None:
        """Schedule the start of a spare child, so that the next map opens without delay.

        A server does so once it listens: its first map waited for the imports of a child.
        """
        if self._preparing is not None:
            self._preparing.cancel()
        if self._closed:
            return
        loop = asyncio.get_running_loop()
        self._preparing = loop.call_later(
            POOL_TIMES.spare_after_s, lambda: self._start(self._add_spare())
        )

    async def _add_spare(self) -> None:
        if self._spare is None:
            self._spare = await self._start_child(background=False, modules=INTERACTIVE_MODULES)

    def _start(self, work: Any) -> asyncio.Task[Any]:
        task = asyncio.ensure_future(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return task


def _identity(path: Path) -> tuple[int, int] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino


def _retrieved(task: asyncio.Task[Any]) -> None:
    """Retrieve the exception of a call without a waiting caller, to avoid a warning."""
    if not task.cancelled():
        task.exception()
