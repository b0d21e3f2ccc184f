"""Fixtures every test may use."""

from __future__ import annotations

import gc
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Generator, Iterator
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import pytest
from hypothesis import settings

from recon4.locales.languages import ENVIRONMENT
from recon4.system.tuning import PROCESSES
from tests.chromium import CHROMIUM, FLAGS
from tests.file_order import mixed
from tests.made_once import made_once
from tests.short_capture import cut_capture, process_short

if TYPE_CHECKING:
    from playwright.sync_api import Browser

ROOT = Path(__file__).parents[1]
os.environ["PYTHONPATH"] = str(ROOT)  # children do not look into the working folder
DATA = Path(os.environ.get("RECON4_DATA") or ROOT.parent / "shared" / "data")

CAPTURE = "recording.pcap"

settings.register_profile("untimed", deadline=None)  # else a busy machine fails an example
settings.load_profile("untimed")


class HasFileno(Protocol):
    """An open file, for calls that take one or its descriptor."""

    def fileno(self) -> int: ...


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Import no file, nor a conftest, without a test that is asked for: all take ten seconds."""
    asked = config.option.markexpr
    if not asked:
        return None
    one = collection_path.suffix == ".py"
    files = iter((collection_path,) if one else collection_path.rglob("test_*.py"))
    first = next(files, None)
    return (first is not None and all(_left_out(file, asked) for file in (first, *files))) or None


@cache
def _left_out(path: Path, asked: str) -> bool:
    """Whether no test of a file is asked for; False if it is not sure."""
    text = path.read_text("utf-8")
    for mark in ("e2e", "study"):
        whole = re.search(rf"^pytestmark = .*pytest\.mark\.{mark}\b", text, re.MULTILINE)
        if whole if f"not {mark}" in asked else mark in asked and mark[:4] not in text:
            return True
    return False


def pytest_configure() -> None:
    """What a shell ignores for a run in the background, programs under test do not inherit."""
    for number in (signal.SIGINT, signal.SIGHUP):
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, lambda *_: None)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """What is loaded here stays: the garbage collector need not look at it again and again."""
    gc.disable()
    collected = yield
    gc.collect()
    gc.freeze()
    gc.set_threshold(PROCESSES.collected_after)  # as in programs of recon4
    gc.enable()
    return collected


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Workers of a run take the files in an order that keeps the processor busy."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        items[:] = mixed(items, lambda item: item.path.relative_to(ROOT))


@pytest.fixture(scope="session", autouse=True)
def _no_keys_of_this_person(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Commands trust no key that the person who runs the tests trusts."""
    os.environ["XDG_CONFIG_HOME"] = str(tmp_path_factory.mktemp("config"))


@pytest.fixture(autouse=True)
def _in_english(monkeypatch: pytest.MonkeyPatch) -> None:
    """No language of this person, nor of a test before: ``--language`` sets it for the process."""
    monkeypatch.setenv(ENVIRONMENT, "")


@pytest.fixture(scope="session", autouse=True)
def _nothing_waits_for_the_disk() -> Iterator[None]:
    """This process waits for no disk, which would leave processors idle.

    Only a power cut would show it, and what survives one is tested on a model of the disk
    (`tests/power_cut`). Programs that tests start sync as ever; a descriptor has to be open.
    """

    def looked_at(file: int | HasFileno) -> None:
        os.fstat(file if isinstance(file, int) else file.fileno())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", looked_at)
        yield


@pytest.fixture(scope="session", autouse=True)
def _libraries_stay_in_memory() -> Iterator[None]:
    """This process keeps what it has read of libraries: finding it is an eighth of a short run.

    Programs that tests start return it as ever.
    """
    from recon4.sandbox import freed_memory

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(freed_memory, "_unwritten", lambda: iter(()))
        yield


@pytest.fixture(scope="session")
def data() -> Callable[[str], Path]:
    """``data("packets/mrpt")`` is that set of real recordings, or the test is skipped.

    Where the sets are supposed to be (``CI=true`` and the folder is there) a missing one fails.
    """

    def find(name: str) -> Path:
        path = DATA / name
        if path.exists():
            return path
        if os.environ.get("CI") == "true" and DATA.exists():
            pytest.fail(f"real data {name} is missing in {DATA}")
        pytest.skip(f"needs real data {name} in {DATA} (set RECON4_DATA)")

    return find


@pytest.fixture(scope="session")
def office_recording(tmp_path_factory) -> Path:
    """Files of six seconds of a simulated walk through the office: capture, IMU, rig, truth."""
    from recon4.progress import Silent
    from recon4.simulation.setup import prepare
    from recon4.simulation.simulate import simulate

    def make(folder: Path) -> None:
        simulate(prepare("office", seconds=6.0, seed=3), folder, bag=False, progress=Silent())

    return made_once(tmp_path_factory, "office-recording", make)


@pytest.fixture(scope="session")
def short_recording(office_recording, tmp_path_factory) -> Path:
    """The first two and a half seconds of it, for tests of runs whatever they map."""

    def make(folder: Path) -> None:
        folder.mkdir()
        cut_capture(office_recording / CAPTURE, folder / CAPTURE, seconds=2.5)
        for name in ("imu.csv", "rig.toml"):
            shutil.copyfile(office_recording / name, folder / name)

    return made_once(tmp_path_factory, "short-recording", make)


@pytest.fixture(scope="session")
def short_project(short_recording, tmp_path_factory) -> Path:
    """The finished project of that short recording, by the command line; tests only read it."""

    def make(folder: Path) -> None:
        command = [sys.executable, "-m", "recon4", *process_short(short_recording, folder)]
        subprocess.run(command, check=True)

    return made_once(tmp_path_factory, "short-project", make)


@pytest.fixture(scope="session", autouse=True)
def undrawn() -> Iterator[Callable[..., str]]:
    """Charts are empty in reports that this process writes: they take a third of a short run.

    Programs that tests start draw them, and files of tests that ask for `drawn`.
    """
    from recon4.report.figures import Chart

    draw = Chart.svg
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Chart, "svg", lambda *_, **__: '<svg class="chart"></svg>')
        yield draw


@pytest.fixture(scope="module")
def drawn(undrawn: Callable[..., str]) -> Iterator[None]:
    """Charts are drawn from here to the end of a file."""
    from recon4.report.figures import Chart

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Chart, "svg", undrawn)
        yield


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One browser for all tests of pages: Playwright can be started once only."""
    from playwright.sync_api import sync_playwright

    if not CHROMIUM.exists():
        pytest.skip(f"needs Chromium at {CHROMIUM} (set RECON4_CHROMIUM)")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
        yield browser
        browser.close()
