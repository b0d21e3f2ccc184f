"""Jumps on the page *Map*: how soon points of the new place are seen.

``python -m tests.benchmarks.map_jumps FOLDER PROJECT [JUMPS]`` serves a folder of projects, jumps
to tiles with many points, and prints figures of ``docs/studies/map-viewer.md``.
"""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median

import numpy as np
from playwright.sync_api import Page, sync_playwright

from tests.benchmarks.map_page import OURS, _cpu_s, _until
from tests.chromium import CHROMIUM, FLAGS
from tests.service.running import server_thread

AWAY_M = 9.0
MANY = 200_000
"""Points of a tile that is jumped to, if there is one."""
NOTE = f"""(() => {{
  const {{ drawn }} = window.recon4Map.run.canvas;
  let {{ frames }} = drawn;
  window.images = [];
  const set = (value) => {{
    if (value > frames) images.push([performance.now(), drawn.points]);
    frames = value;
  }};
  Object.defineProperty(drawn, "frames", {{ get: () => frames, set }});
  return {OURS.replace(".drawn", "")}.tiles.nodes.filter(({{ cube }}) => cube >= 0)
    .map(({{ low_m, high_m, points }}) => [low_m, high_m, points]);
}})()"""
JUMP = """([target, distance, yaw]) => {
  images.length = 0;
  window.jumped = performance.now();
  recon4Map.move({ ...recon4Map.camera(), target, distance, yaw });
}"""


def main(folder: str, project: str, jumps: str = "20") -> None:
    """Jump and print."""
    with server_thread(Path(folder)) as server, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.goto(f"{server.url}/projects/{project}/map/", wait_until="commit")
        _until(page.main_frame, f"{OURS}?.rested && !!window.recon4Map.move")
        tiles = sorted(page.evaluate(NOTE), key=lambda tile: tile[2])
        large = [tile for tile in tiles if tile[2] > MANY] or tiles[-1:]
        rng, cpu = np.random.default_rng(4), _cpu_s()
        times = []
        for _ in range(int(jumps)):
            low, high, _ = large[int(rng.integers(len(large)))]
            target = ((np.array(low) + high) / 2.0).tolist()
            times.append(_jump(page, [target, AWAY_M, float(rng.uniform(0.0, 2.0 * np.pi))]))
        names = ("first image", "image with more points", "at rest")
        for name, some in zip(names, zip(*times, strict=True), strict=True):
            print(f"{name}: {median(some):.2f} s ({min(some):.2f} to {max(some):.2f})")
        print(f"processor time of the browser a jump: {(_cpu_s() - cpu) / int(jumps):.1f} s")
        browser.close()


def _jump(page: Page, to: list[object]) -> tuple[float, float, float]:
    """When the first image was complete, one with more points, and the one at rest [s]."""
    page.evaluate(JUMP, to)
    _until(page.main_frame, f"images.length && {OURS}.rested")
    images, jumped = page.evaluate("[images, jumped]")
    more = next((ms for ms, points in images if points > images[0][1]), images[-1][0])
    first, late, rest = ((ms - jumped) / 1e3 for ms in (images[0][0], more, images[-1][0]))
    return first, late, rest


if __name__ == "__main__":
    main(*sys.argv[1:])
