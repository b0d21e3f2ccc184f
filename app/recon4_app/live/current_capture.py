"""Manages the capture of this computer: one at a time, because there is one set of ports."""

from __future__ import annotations

import asyncio
import logging
from pathlib import Path
from typing import Any

import msgspec

from recon4.errors import ConfigError, CorruptFile, StoreError
from recon4.live.ipc.line_client import is_listening
from recon4.live.project_files import begin
from recon4.live.protocol import Mark, Stop
from recon4.live.session import CaptureSession, load_session
from recon4.locales.coded import CodedText
from recon4.model.rig import Rig, load_rig
from recon4.store.json_files import parse_object
from recon4.untrusted.bounded import read_text_limited
from recon4.untrusted.typed import as_type
from recon4_app.errors import CAPTURE, Conflict, NotFound
from recon4_app.live.capture import Capture, unfinished
from recon4_app.live.power import Power, read_battery
from recon4_app.live.tuning import MARKS
from recon4_app.network.streams import StreamLimits, Streams

log = logging.getLogger(__name__)

LIVE_STREAM_LIMITS = StreamLimits(
    max_streams=32, max_per_person=8, max_per_address=16, reserved_for_capture=4
)


class CurrentCapture:
    """Starts captures and keeps the running or the last one."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._capture: Capture | None = None
        self._rig: Rig | None = None
        self._starting = asyncio.Lock()
        self.streams = Streams("live streams", LIVE_STREAM_LIMITS)
        """Streams of the connected phones."""
        self.power = Power(read_battery)
        """Battery of this computer."""

    @property
    def newest(self) -> Capture | None:
        """The running or the last capture; None if there was none."""
        return self._capture

    def capture(self) -> Capture:
        """The capture that runs, or the last one.

        Raises:
            NotFound: If there was none since the server started.
        """
        if self._capture is None:
            raise NotFound(CodedText("capture-none"))
        return self._capture

    @property
    def rig(self) -> Rig:
        """What is on the backpack of `capture`."""
        assert self._rig is not None
        return self._rig

    async def start(self, project: str, rig: Rig, **how: Any) -> Capture:
        """Start a capture.

        Args:
            project: Name of its folder, checked.
            rig: The sensors.
            how: Fields of `CaptureSession`.

        Raises:
            Conflict: If one runs, or the recorder cannot start.
            ConfigError: If the rig is wrong.
            StoreError: If the folder cannot be used.
        """
        async with self._starting:
            if self._capture is not None and not self._capture.over:
                raise Conflict(
                    CodedText("capture-running", project=self._capture.project), remedy=CAPTURE
                )
            session = await asyncio.to_thread(begin, self._root / project, rig, **how)
            capture = Capture(session)
            await capture.start()
            self._capture, self._rig = capture, rig
            return capture

    async def adopt(self) -> None:
        """Follow the capture an earlier server started; if its recorder died, complete its map."""
        found: list[tuple[bool, float, CaptureSession, Rig]] = []
        for project in unfinished(self._root):
            try:
                session = load_session(project)
                rig = load_rig(session.rig)
            except (StoreError, ConfigError) as error:
                log.warning("%s", error)
                continue
            began_s = session.rig.stat().st_mtime
            found.append((await is_listening(session.socket("recorder")), began_s, session, rig))
        if not found:
            return
        alive, _, session, rig = max(found, key=lambda one: one[:2])
        capture = Capture(session)
        capture.stream.restore_marks(await asyncio.to_thread(marks_of, session))
        await capture.follow()
        self._capture, self._rig = capture, rig
        what = "still runs and is followed again" if alive else "died: its map is completed"
        log.warning("%s: its recorder %s", session.project.name, what)

    async def stop(self) -> Capture:
        """Stop recording; the map of what was recorded is completed.

        Raises:
            NotFound, Conflict: If nothing is being captured.
        """
        capture = self.capture()
        await capture.request(Stop())
        return capture

    async def leave(self) -> None:
        """Stop following; recorder and mapper continue."""
        if self._capture is not None:
            await self._capture.leave()


def marks_of(session: CaptureSession) -> list[Mark]:
    """Read the marks of a session; skips a line that was being written at a power failure."""
    try:
        if not session.marks.exists():
            return []
        lines = read_text_limited(session.marks, MARKS.max_marks_bytes).splitlines()
    except CorruptFile as error:
        log.warning("%s", error)
        return []
    marks = []
    for line in lines:
        try:
            marks.append(as_type(parse_object(line, "a mark") | {"kind": "mark"}, Mark))
        except (StoreError, msgspec.ValidationError):
            log.warning("%s: a line is damaged", session.marks)
    return marks
