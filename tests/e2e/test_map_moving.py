"""What is seen of the map while the camera moves on and on, as in a flight along the walk."""

import pytest

from tests.e2e.conftest import looks
from tests.served import office, served

pytestmark = [pytest.mark.e2e, looks("desktop light")]

server = served(office(points=300_000))

SLOW_CLOCK = (
    "{ const now = performance.now.bind(performance); performance.now = () => now() / 100; }"
)
"""A busy computer draws so rarely that the camera counts as resting between two moves."""
READS = """(async () => {
  const frame = () => new Promise(requestAnimationFrame);
  while (!window.recon4Map?.run.canvas?.tiles.complete || !recon4Map.move) await frame();
  const { drawn, tiles } = recon4Map.run.canvas;
  const [points, frames] = [tiles.total, drawn.frames];
  for (let yaw = 0; tiles.total === points && drawn.frames < frames + 15; yaw += 0.01) {
    recon4Map.move({ ...recon4Map.camera(), distance: 4, yaw });
    await frame();
  }
  return tiles.total - points;
})()"""


def test_points_are_read_while_the_camera_moves(server, page):
    page.add_init_script(SLOW_CLOCK)
    page.goto(f"{server.url}/projects/office/map/?camera=8,5,1,0,-60,400,0")
    assert page.evaluate(READS) > 0


CLOCK = """{
  const now = performance.now.bind(performance);
  performance.now = () => window.clock ?? now();
}"""
"""Stands still where a test sets it."""
JUMP = """(async () => {
  const frame = () => new Promise(requestAnimationFrame);
  while (!window.recon4Map?.run.canvas?.drawn.rested || !recon4Map.move) await frame();
  const { drawn, pace } = recon4Map.run.canvas;
  window.begun = [];
  const resting = () => (begun.push(drawn.points), 1_200_000);
  Object.defineProperty(pace, "resting", { get: resting });
  window.jump = () => {
    begun.length = 0;
    clock = performance.now();
    recon4Map.move({ ...recon4Map.camera(), distance: 4 });
  };
})()"""
STANDS = """(async () => {
  clock += 500; // longer than the camera counts as moving
  for (let k = 0; k < 20; k++) await new Promise(requestAnimationFrame);
  return [recon4Map.run.canvas.drawn.points, begun.length];
})()"""
BEGINS = """(async () => {
  while (!begun.length) await new Promise(requestAnimationFrame);
  return begun[0];
})()"""


def test_what_a_jump_needs_is_shown_before_the_image_at_rest_is_begun(server, page):
    waiting = []
    page.add_init_script(CLOCK)
    page.goto(f"{server.url}/projects/office/map/?camera=8,5,1,0,-60,400,0")
    page.evaluate(JUMP)
    free = []
    page.route("**/points?*", lambda route: route.continue_() if free else waiting.append(route))
    with page.expect_request("**/points?*"):
        page.evaluate("jump()")

    points, begun = page.evaluate(STANDS)

    assert not begun
    free.append(True)
    for route in waiting:
        route.continue_()
    assert page.evaluate(BEGINS) > points
