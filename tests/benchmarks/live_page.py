"""Frame rate of the operator's page in Chromium with software rendering, at phone size.

``python -m tests.benchmarks.live_page [--points 400000] [--seconds 5]`` starts a server and opens
``/live``. In the page a simulated stream sends a building of n points, its plan and path, and ten
poses per second. A finger moves the map all the time, from above and in 3-D.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from playwright.sync_api import Page, expect, sync_playwright

from tests.chromium import CHROMIUM, FLAGS
from tests.e2e.conftest import SCREENS
from tests.service.running import server_thread

STREAM = """(() => {
  const [along, across, high, voxel, cell] = [80, 40, 3, 0.1, 0.25];
  const chunk = 20000, left = (all, start) => Math.min(chunk, all - start);
  const points = (count) => {
    const data = new ArrayBuffer(7 * count), voxels = new Int16Array(data, 0, 3 * count);
    for (let k = 0; k < 3 * count; k++)
      voxels[k] = Math.random() * [along, across, high][k % 3] / voxel;
    new Uint8Array(data, 6 * count).forEach((_, k, all) => (all[k] = 256 * Math.random()));
    return data;
  };
  const path = Array.from({ length: 4000 }, (_, k) =>
    [40 + 35 * Math.sin(k / 100), 20 + 15 * Math.sin(k / 77), 1.4]);
  const plan = async () => {
    const seen = new Uint8Array(along / cell * across / cell).map(() => 4 * Math.random());
    const packed = new Blob([seen]).stream().pipeThrough(new CompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(packed).arrayBuffer());
    return { cell_m: cell, first_cell: [0, 0], shape: [along / cell, across / cell],
      seen: btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")) };
  };
  window.WebSocket = class extends EventTarget {
    constructor() { super(); setTimeout(() => this.begin()); }
    send() {}
    close() {}
    deliver(data) { this.dispatchEvent(new MessageEvent("message", { data })); }
    deliverJson(message) { this.deliver(JSON.stringify(message)); }
    async begin() {
      this.dispatchEvent(new Event("open"));
      this.deliverJson({ project: "walk", state: "recording", findings: [], plan: await plan(),
        path: { start: 0, points: path } });
      for (let start = 0; start < ALL; start += chunk) {
        const count = left(ALL, start);
        this.deliverJson({ points: { generation: 0, start, count, voxel_m: voxel, total: ALL } });
        this.deliver(points(count));
      }
      const pose = () => ({ p: [40, 20, 1.4], yaw: Date.now() / 1000, lost: false });
      setInterval(() => this.deliverJson({ pose: pose() }), 100);
    }
  };
})()"""

MOVE = """(seconds) => new Promise((resolve) => {
  const map = document.getElementById("overlay");
  const at = (kind, x) => map.dispatchEvent(new PointerEvent(kind, {
    pointerId: 1, clientX: 195 + x, clientY: 400, bubbles: true }));
  map.setPointerCapture = () => {};
  at("pointerdown", 0);
  const began = performance.now();
  let frames = 0;
  const next = () => {
    frames += 1;
    at("pointermove", 40 * Math.sin(frames / 10));
    const passed = (performance.now() - began) / 1000;
    if (passed < seconds) return requestAnimationFrame(next);
    at("pointerup", 0);
    resolve(frames / passed);
  };
  requestAnimationFrame(next);
})"""


def measure(page: Page, url: str, *, points: int, seconds: float) -> None:
    """Print a line for each way to look."""
    page.add_init_script(STREAM.replace("ALL", str(points)))
    page.goto(f"{url}/live")
    expect(page.locator("#map")).to_have_attribute("data-points", str(points), timeout=30_000)
    for name, key in (("from above", None), ("3-D", "t")):
        if key:
            page.keyboard.press(key)
        page.evaluate(MOVE, 1.0)
        print(f"{points} points, {name}: {page.evaluate(MOVE, seconds):.1f} frames a second")


def main() -> None:
    """At phone size, device pixels 1:1 and 2:1."""
    ask = argparse.ArgumentParser(description=__doc__)
    ask.add_argument("--points", type=int, default=400_000)
    ask.add_argument("--seconds", type=float, default=5.0)
    given = ask.parse_args()
    width, height = SCREENS["phone"]
    with (
        tempfile.TemporaryDirectory() as folder,
        server_thread(Path(folder)) as server,
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
        for ratio in (1, 2):
            page = browser.new_page(
                viewport={"width": width, "height": height}, device_scale_factor=ratio
            )
            page.on("pageerror", lambda error: print("error:", error))
            print(f"{width} x {height}, {ratio} device pixels a pixel")
            measure(page, server.url, points=given.points, seconds=given.seconds)
            page.close()
        browser.close()


if __name__ == "__main__":
    main()
