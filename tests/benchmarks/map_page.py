"""The page *Map* beside the viewer of viser, on the same map, in Chromium without a graphics card.

``python -m tests.benchmarks.map_page FOLDER PROJECT [IMAGE]`` serves a folder of projects and
prints the figures of ``docs/studies/map-viewer.md``; IMAGE shows both side by side. Frames are
counted while a mouse turns the map for some seconds, in CPU time of the browser too: the machine
may be shared.
"""

from __future__ import annotations

import io
import sys
import time
from pathlib import Path

import psutil
from PIL import Image
from playwright.sync_api import Frame, Page, sync_playwright

from tests.chromium import CHROMIUM, FLAGS
from tests.service.running import Running, server_thread

TURN_S = 8.0
OPENED_S = 240.0
AGAIN = 5
OURS = "window.recon4Map?.run.canvas?.drawn"
FIRST = """(function look() {
  const drawn = window.recon4Map?.run.canvas?.drawn;
  if (!drawn) return requestAnimationFrame(look);
  let frames = drawn.frames;
  const set = (value) => {
    if (value > frames && drawn.points > 10000) window.firstPoints ??= performance.now();
    frames = value;
  };
  Object.defineProperty(drawn, "frames", { get: () => frames, set });
})()"""
"""Notes when the first image with points is complete, since the page was asked for [ms]: in the
frame that finds it so, as that frame may have the next image drawn."""
VISER = "window.__viserTestpoints?.rendererInfo?.render"


def main(folder: str, project: str, image: str = "") -> None:
    """Measure both, and keep an image."""
    with server_thread(Path(folder)) as server, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        own = _own(page, server, project)
        page.goto("about:blank")
        other = _viser(page, server, project)
        browser.close()
    if image:
        sheet = Image.new("RGB", (own.width + other.width, own.height))
        sheet.paste(other, (0, 0))
        sheet.paste(own, (other.width, 0))
        sheet.resize((sheet.width * 2 // 3, sheet.height * 2 // 3)).save(image, quality=82)


def _own(page: Page, server: Running, project: str) -> Image.Image:
    page.add_init_script(FIRST)
    for name in ("first", *["again"] * AGAIN):
        page.goto("about:blank")
        cpu = _cpu_s()
        page.goto(f"{server.url}/projects/{project}/map/", wait_until="commit")
        _until(page.main_frame, "window.firstPoints")
        first_s, used = page.evaluate("window.firstPoints") / 1000, _cpu_s() - cpu
        print(f"Map, opened {name}: first points after {first_s:.2f} s, {used:.2f} s of processor")
    _until(page.main_frame, f"{OURS}?.rested")
    print(f"Map at rest: {page.evaluate(f'{OURS}.points')} points")
    image = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    _turned(page, page.main_frame, f"[{OURS}.frames, {OURS}.points]", "Map")
    began = time.perf_counter()
    _until(page.main_frame, f"{OURS}.points > 600000")
    print(f"Map: drawn with more points {time.perf_counter() - began:.2f} s after the turn")
    pace = page.evaluate("({...window.recon4Map.run.canvas.pace})")
    print(f"Map: pace {pace}")
    return image


def _viser(page: Page, server: Running, project: str) -> Image.Image:
    began = time.perf_counter()
    page.goto(f"{server.url}/projects/{project}/viewer/")
    _until(page.main_frame, f"{VISER}?.points > 10000")
    print(f"viser: first points after {time.perf_counter() - began:.2f} s")
    page.wait_for_timeout(20_000)
    print(f"viser at rest: {page.evaluate(f'{VISER}.points')} points")
    image = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    _turned(page, page.main_frame, f"[{VISER}.frame, {VISER}.points]", "viser")
    return image


def _turned(page: Page, frame: Frame, counted: str, name: str) -> None:
    """Print frames and points while the map is turned by the mouse."""
    page.mouse.move(500, 500)
    page.mouse.down()
    before, cpu, began = frame.evaluate(counted)[0], _cpu_s(), time.perf_counter()
    points, step = [], 0
    while time.perf_counter() - began < TURN_S:
        step += 1
        page.mouse.move(500 + step % 60 * 6, 500)
        points.append(frame.evaluate(counted)[1])
    seconds = time.perf_counter() - began
    frames, used = frame.evaluate(counted)[0] - before, _cpu_s() - cpu
    page.mouse.up()
    print(
        f"{name} while turning: {frames / seconds:.1f} frames/s, {sorted(points)[len(points) // 2]}"
        f" points, {used / max(frames, 1):.3f} s of processor a frame"
    )


def _until(frame: Frame, expression: str) -> None:
    end = time.perf_counter() + OPENED_S
    while not frame.evaluate(expression):
        if time.perf_counter() > end:
            raise TimeoutError(expression)
        frame.page.wait_for_timeout(50)


def _cpu_s() -> float:
    """Processor time of the browser's processes so far [s]."""
    children = psutil.Process().children(recursive=True)
    own = [one for one in children if "chrom" in one.name()]
    return sum(sum(one.cpu_times()[:2]) for one in own)


if __name__ == "__main__":
    main(*sys.argv[1:])
