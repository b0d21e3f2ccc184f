"""Progress for a person at a terminal: bars, or plain lines when the output goes elsewhere."""

from __future__ import annotations

import json
import re
import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, TextIO

from recon4.errors import ConfigError, Recon4Error
from recon4.locales.coded import CodedText, coded, said
from recon4.locales.languages import of_terminal
from recon4.locales.numbers import localized
from recon4.locales.texts import Shown

if TYPE_CHECKING:
    from rich.progress import ProgressColumn, Task, TaskID

    from recon4.model.events import Event, StageChanged
    from recon4.review.approval_state import ApprovalState

_LINE_EVERY_S = 5.0
_HASH = "hash "
"""Before the name of a file, in the name of a piece of work."""


def write(text: str, end: str = "\n") -> None:
    """Say something on standard output."""
    sys.stdout.write(text + end)


def say(code: str, /, **values: Shown) -> None:
    """Say a text in the language of the terminal on standard output."""
    write(worded(code, **values))


def say_approval(state: ApprovalState) -> None:
    """Say the line that stands beside every file of the results."""
    write(state.line.said(of_terminal()))


def worded(code: str, /, **values: Shown) -> str:
    """A text in the language of the terminal, if that is known; so is what it quotes."""
    return in_terminal(CodedText(code, **values))


def in_terminal(text: str) -> str:
    """A text, if it has a code in the language of the terminal."""
    return said(text, of_terminal())


def write_json(value: object) -> None:
    """Write records, lists and mappings as JSON for programs; what is not finite is null."""
    from recon4.model.plain import to_plain

    write(json.dumps(to_plain(value), indent=1, ensure_ascii=False))


def complaint_of(error: Recon4Error) -> str:
    """The message of an error in the language of the terminal, if that is known."""
    try:
        return coded(error).said(of_terminal())
    except ConfigError:  # of the language itself
        return str(error)


class PlainLines:
    """A line when a piece of work begins, every five seconds and when it ends."""

    def __init__(self, out: TextIO) -> None:
        self._out = out
        self._what, self._unit = "", ""
        self._done, self._total = 0, 0
        self._began_s, self._said_s = 0.0, 0.0

    def start(self, what: str, total: int, unit: str) -> None:
        """Begin a piece of work."""
        self._finish()
        self._what, self._unit, self._done, self._total = what, unit, 0, total
        self._began_s = self._said_s = time.monotonic()

    def advance(self, done: int = 1) -> None:
        """Count; a line now and then."""
        self._done += done
        if time.monotonic() - self._said_s >= _LINE_EVERY_S:
            self._say(self._line())
            self._said_s = time.monotonic()

    def event(self, event: Event) -> None:
        """A line for what a person should know."""
        text = describe_event(event)
        if text:
            self._finish()
            self._say(text)

    def __enter__(self) -> PlainLines:
        return self

    def __exit__(self, *_: object) -> None:
        self._finish()

    def _finish(self) -> None:
        if self._what:
            self._say(self._line())
        self._what = ""

    def _line(self) -> str:
        seconds = time.monotonic() - self._began_s
        return describe_progress(
            self._what, self._done, self._total, unit=self._unit, seconds=seconds
        )

    def _say(self, text: str) -> None:
        self._out.write(f"{text}\n")
        self._out.flush()


class Bars:
    """A bar for each piece of work: percent, count, rate with its unit, time left."""

    def __init__(self, out: TextIO) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, TextColumn
        from rich.progress import Progress as RichProgress

        self._rich = RichProgress(
            TextColumn("{task.description:<28}"),
            BarColumn(bar_width=24),
            _figures_column(),
            console=Console(file=out),
        )
        self._task: TaskID | None = None

    def start(self, what: str, total: int, unit: str) -> None:
        """Begin a piece of work."""
        self._finish()
        self._task = self._rich.add_task(what, total=total or None, unit=unit)

    def advance(self, done: int = 1) -> None:
        """Move the bar."""
        if self._task is not None:
            self._rich.advance(self._task, done)

    def event(self, event: Event) -> None:
        """A line above the bars for what a person should know."""
        text = describe_event(event)
        if text:
            self._rich.console.print(text, markup=False, highlight=False)

    def __enter__(self) -> Bars:
        self._rich.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        if error is None:
            self._finish()
        self._rich.stop()

    def _finish(self) -> None:
        if self._task is not None:
            (task,) = [t for t in self._rich.tasks if t.id == self._task]
            self._rich.update(self._task, total=task.completed or 1, completed=task.completed or 1)
        self._task = None


def watcher(out: TextIO | None = None) -> PlainLines | Bars:
    """What suits the place the progress is written to; a context manager and a `Progress`.

    Args:
        out: Where to write; None = standard error.
    """
    out = out or sys.stderr
    return Bars(out) if out.isatty() else PlainLines(out)


def describe_progress(what: str, done: int, total: int, *, unit: str, seconds: float) -> str:
    """One line: percent, count, rate with unit, time left."""
    total = max(total, done) if total else 0  # totals are estimates at times
    share = (
        f"{100 * done // total:3d} %  {_count(done, unit)}/{_count(total, unit)}" if total else ""
    )
    named = worded("progress-unit", unit=unit)
    parts = [_padded(_step(what)), share or _count(done, unit), named if unit != "B" else ""]
    if done and seconds > 0.0:
        rate = done / seconds
        per_s = f"{_count(rate, unit)}/s" if unit == "B" else f"{_number(rate)} {named}/s"
        left_s = (total - done) / rate
        left = worded("seconds-left", seconds=left_s) if left_s > 0.0 else f"{_number(seconds)} s"
        parts += [per_s, left]
    return "  ".join(part for part in parts if part)


def is_progress(line: str) -> bool:
    """Whether a line of `PlainLines` counts how far a piece of work is, and says nothing else."""
    return re.match(rf".{{{len(_padded(''))},}}?  +\d", line) is not None


def _step(what: str) -> str:
    if what.startswith(_HASH):
        return worded("step-hash", file=what.removeprefix(_HASH))
    return worded("progress-step", step=what)


def _padded(what: str) -> str:
    return f"{what:<28}"


def describe_event(event: Event) -> str:
    """A line for a person; empty for events that are in the results only."""
    from recon4.findings.wording import whole_text
    from recon4.model.events import ArtifactDamaged, Remarked, StageChanged, Warned

    match event:
        case StageChanged():
            return _describe_stage(event)
        case Warned(text=text):
            return worded("warning", text=text)
        case Remarked(finding=finding):
            return worded("warning", text=whole_text(finding, of_terminal()))
        case ArtifactDamaged(stage=stage, moved_to=moved_to, files=files):
            found = "; ".join(map(in_terminal, files))
            return worded("artifact-was-damaged", stage=stage, moved_to=moved_to, files=found)
    return ""


def _describe_stage(event: StageChanged) -> str:
    match event.state:
        case "reused":
            return worded("stage-was-reused", stage=event.stage)
        case "done":
            return worded("stage-was-done", stage=event.stage, seconds=event.seconds or 0.0)
    return ""


def _figures_column() -> ProgressColumn:
    from rich.progress import ProgressColumn
    from rich.text import Text

    class FiguresColumn(ProgressColumn):
        def render(self, task: Task) -> Text:
            line = describe_progress(
                "",
                int(task.completed),
                int(task.total or 0),
                unit=task.fields["unit"],
                seconds=task.elapsed or 0.0,
            )
            return Text(line.strip())

    return FiguresColumn()


def _count(number: float, unit: str) -> str:
    return worded("stored-size", bytes=number) if unit == "B" else f"{number:.0f}"


def _number(value: float) -> str:
    return localized(f"{value:.1f}", of_terminal())
