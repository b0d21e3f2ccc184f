import "./english.js";

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";

import { drawLessAtRest } from "../../web/shared/draw_at_rest.js";

/** A window whose screen and clock a test moves on. */
class FakeWindow extends EventTarget {
  now = 0;
  frames = new Map();
  timers = new Map();
  last = 0;
  performance = { now: () => this.now };
  Worker = class extends EventTarget {};

  requestAnimationFrame(draw) {
    this.frames.set(++this.last, draw);
    return this.last;
  }
  cancelAnimationFrame(id) {
    this.frames.delete(id);
  }
  setTimeout(call, ms, ...options) {
    this.timers.set(++this.last, { at: this.now + ms, call: () => call(...options) });
    return this.last;
  }
  clearTimeout(id) {
    this.timers.delete(id);
  }

  /** The screen shows `count` frames, 20 ms each. */
  show(count) {
    for (let k = 0; k < count; k++) {
      this.now += 20;
      for (const [id, { at, call }] of this.timers)
        if (at <= this.now && this.timers.delete(id)) call();
      const asked = [...this.frames.values()];
      this.frames.clear();
      for (const draw of asked) draw(this.now);
    }
  }
}

let screen;
let drawn;

beforeEach(() => {
  screen = new FakeWindow();
  drawLessAtRest(screen);
  drawn = 0;
  const draw = () => {
    drawn += 1;
    screen.requestAnimationFrame(draw);
  };
  screen.requestAnimationFrame(draw);
});

function drawnWithin(frames) {
  drawn = 0;
  screen.show(frames);
  return drawn;
}

test("a scene is drawn at full rate at first, at a few frames a second later", () => {
  assert.equal(drawnWithin(50), 50);
  screen.show(100);

  assert.ok(drawnWithin(100) <= 9);
  assert.ok(drawnWithin(100) >= 7);
});

for (const kind of ["pointerdown", "pointermove", "wheel", "keydown", "resize"])
  test(`${kind} is followed by the next frame`, () => {
    screen.show(201);
    screen.dispatchEvent(new Event(kind));

    assert.equal(drawnWithin(50), 50);
  });

test("a message of a worker is followed by the next frame", () => {
  const worker = new screen.Worker("blob:of-viser");
  screen.show(201);
  worker.dispatchEvent(new Event("message"));

  assert.equal(drawnWithin(50), 50);
});

test("a cancelled frame is not drawn, at full rate or at rest", () => {
  const never = () => assert.fail("it was cancelled");
  screen.cancelAnimationFrame(screen.requestAnimationFrame(never));
  screen.show(201);
  screen.cancelAnimationFrame(screen.requestAnimationFrame(never));
  screen.cancelAnimationFrame(12345);

  assert.ok(drawnWithin(100) > 0);
});
