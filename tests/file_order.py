"""The order of the files of tests where several processes share the processor."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import groupby, islice
from pathlib import Path
from typing import TypeVar

Test = TypeVar("Test")

WAITING = ("security", "service")
"""Folders whose tests wait for other processes, clocks and sockets half of their time."""
BETWEEN = 4
"""Files that compute after each that waits: both kinds take about the same time in all, and the
tests of the browser, which wait too, end before them."""


def mixed(tests: Iterable[Test], path_of: Callable[[Test], Path]) -> list[Test]:
    """The tests with files that wait spread among those that compute; else the order stays.

    Beside each other, those that wait leave the processor idle; later, those that compute take it
    from each other. What comes before the first file that waits stays first: whole walks are long.

    Args:
        tests: In the order of their files.
        path_of: The file of a test.
    """
    files = [list(group) for _, group in groupby(tests, key=path_of)]
    waits = [not set(WAITING).isdisjoint(path_of(file[0]).parts) for file in files]
    first = waits.index(True) if any(waits) else len(files)
    rest = list(zip(waits[first:], files[first:], strict=True))
    waiting = iter([file for waits, file in rest if waits])
    computing = iter([file for waits, file in rest if not waits])
    order = files[:first]
    while more := [*islice(waiting, 1), *islice(computing, BETWEEN)]:
        order += more
    return [test for file in order for test in file]
