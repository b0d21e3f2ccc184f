"""One child process, on the server's side."""

from __future__ import annotations

import asyncio
import os
import secrets
import shutil
import signal
import stat
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from recon4.locales.coded import CodedText
from recon4.system.processes import ChildRegister
from recon4_app.compute_pool.messages import (
    FAILED,
    HEAD,
    RESULT,
    Call,
    ChildSetup,
    decode_error,
    decode_result,
    encode_request,
)
from recon4_app.compute_pool.model import FileAccess
from recon4_app.compute_pool.tuning import POOL_MESSAGES
from recon4_app.errors import ComputeFailed
from recon4_app.settings import worker_environment


class ChildFailed(RuntimeError):
    """A call failed by an error of the program; the message is the child's traceback."""


class ChildProcess:
    """A child, its scratch folder, and whether it is confined yet."""

    def __init__(
        self,
        process: asyncio.subprocess.Process,
        scratch: Path,
        lifeline: int,
        *,
        children: ChildRegister,
    ) -> None:
        self._process = process
        self._children = children
        children.add(process.pid)
        self._lifeline = lifeline
        self.scratch = scratch
        self._set_up = False

    @staticmethod
    async def start(
        scratch_of_all: Path,
        *,
        background: bool,
        children: ChildRegister,
        modules: Sequence[str] = (),
    ) -> ChildProcess:
        """Start a child; it imports ``modules`` and waits for its first call."""
        scratch = scratch_of_all / secrets.token_hex(8)
        scratch.mkdir(mode=0o700, parents=True)
        command = [sys.executable, "-P", "-m", "recon4_app.compute_pool.child"]
        watched, held = os.pipe()
        try:
            process = await asyncio.create_subprocess_exec(
                *command,
                str(scratch),
                str(watched),
                *(("--background",) if background else ()),
                *modules,
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                env=_environment(scratch),
                pass_fds=(watched,),
                start_new_session=True,
            )
        except BaseException:
            os.close(held)
            raise
        finally:
            os.close(watched)
        return ChildProcess(process, scratch, held, children=children)

    @property
    def alive(self) -> bool:
        """Whether the process runs."""
        return self._process.returncode is None

    async def call(self, call: Call, access: FileAccess) -> Any:
        """Send a call and return its result. A child serves one `FileAccess` only, its first.

        Raises:
            ComputeFailed: If the child died, or its response is malformed.
            ChildFailed: If the function failed by an error of the program.
            Recon4Error: Whatever the function raises.
        """
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        messages: list[ChildSetup | Call] = [call]
        if not self._set_up:
            messages.insert(0, ChildSetup(access, call.function.__module__))
            self._set_up = True
        try:
            for message in messages:
                self._process.stdin.write(encode_request(message))
            await self._process.stdin.drain()
            kind, size = HEAD.unpack(await self._process.stdout.readexactly(HEAD.size))
            if size > POOL_MESSAGES.max_result_bytes:
                raise ComputeFailed(
                    CodedText("result-too-large", limit=POOL_MESSAGES.max_result_bytes, size=size)
                )
            answer = await self._process.stdout.readexactly(size)
        except (OSError, asyncio.IncompleteReadError) as error:
            raise ComputeFailed(await self._death_message()) from error
        if kind == RESULT:
            return decode_result(call.function, answer)
        if kind == FAILED:
            raise ChildFailed(answer.decode("utf-8", "replace"))
        raise decode_error(answer)

    async def end(self) -> None:
        """Kill the process and remove its scratch folder."""
        if self.alive:
            self._process.kill()
        await self._process.wait()
        self._children.remove(self._process.pid)
        if self._lifeline >= 0:
            os.close(self._lifeline)
            self._lifeline = -1
        # Closes the pipes, which otherwise wait for the garbage collector.
        self._process._transport.close()  # type: ignore[attr-defined]
        await asyncio.to_thread(shutil.rmtree, self.scratch, ignore_errors=True)

    def keep(self, outputs: Mapping[str, Path]) -> None:
        """Move the output files of a call out of the scratch folder: name there -> path.

        Raises:
            ComputeFailed: If there is no such file, or it is a link or something else.
        """
        for name, place in outputs.items():
            made = self.scratch / name
            refuse_links(made)
            place.parent.mkdir(parents=True, exist_ok=True)
            _move(made, place)

    async def _death_message(self) -> CodedText:
        """Why the child did not respond."""
        try:
            async with asyncio.timeout(5.0):
                await self._process.wait()
        except TimeoutError:
            return CodedText("helper-silent")
        code = self._process.returncode or 0
        if code < 0:
            return CodedText("helper-killed", signal=signal.Signals(-code).name)
        return CodedText("helper-exited", status=code)


def refuse_links(path: Path) -> None:
    """Check that a path is a regular file, or a folder of only regular files.

    Raises:
        ComputeFailed: If it is not: a child that was taken over could make the server follow it.
    """
    found = [path]
    while found:
        one = found.pop()
        try:
            mode = one.lstat().st_mode
        except OSError as error:
            raise ComputeFailed(CodedText("helper-no-file", file=one.name)) from error
        if stat.S_ISDIR(mode):
            found += one.iterdir()
        elif not stat.S_ISREG(mode):
            raise ComputeFailed(CodedText("helper-no-regular-file", file=one.name))


def _move(made: Path, place: Path) -> None:
    """Rename durably; copy first across file systems."""
    if made.stat().st_dev != place.parent.stat().st_dev:
        near = place.with_name(f".tmp-{secrets.token_hex(6)}-{place.name}")
        (shutil.copytree if made.is_dir() else shutil.copyfile)(made, near)
        made = near
    if made.is_file():
        with made.open("rb") as file:
            os.fsync(file.fileno())
    os.replace(made, place)
    descriptor = os.open(place.parent, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _environment(scratch: Path) -> dict[str, str]:
    """The environment of workers, with a temporary folder of its own."""
    return {**worker_environment(), "TMPDIR": str(scratch)}
