// Handles of the clip over the map: dragged by mouse or finger, or moved by the arrow keys.

import { html, render, repeat } from "../shared/dom.js";
import { decimal, t } from "../shared/texts.js";
import { add, rayAt, toScreen } from "./camera.js";
import { alongAxis, handlesOf, isDraggable, movedHandle } from "./clip_handles.js";
import { heightsShown, page } from "./page.js";

/**
 * @import {Clip} from "./clip.js"
 * @import {Handle} from "./clip_handles.js"
 * @import {Stage} from "./tools.js"
 */

const SHORT_M = 0.05; // of an arrow
/** How far an arrow key moves a handle, by key [m]; with shift ten times as far. */
const STEPS_M = { ArrowUp: 0.05, ArrowRight: 0.05, ArrowDown: -0.05, ArrowLeft: -0.05 };

/**
 * What draws the handles.
 * @param {HTMLElement} element over the canvas
 * @param {Pick<Stage, "camera" | "screen" | "change">} stage
 */
export function handlesIn(element, { camera, screen, change }) {
  /** @type {{handle: Handle, clip: Clip, from: number} | null} the drag */
  let drag = null;

  const pointed = (/** @type {PointerEvent} */ event, /** @type {Handle} */ handle) => {
    const { left, top } = element.getBoundingClientRect();
    const at = [event.clientX - left, event.clientY - top];
    return alongAxis(handle, rayAt(camera(), screen(), at));
  };
  const move = (/** @type {Clip} */ clip) => change({ clip, standing: false });

  const on = (/** @type {Handle} */ handle) => ({
    down(/** @type {PointerEvent} */ event) {
      /** @type {HTMLElement} */ (event.currentTarget).setPointerCapture(event.pointerId);
      drag = { handle, clip: page.state.clip, from: pointed(event, handle) };
    },
    move(/** @type {PointerEvent} */ event) {
      if (drag?.handle.key !== handle.key) return;
      const by = pointed(event, drag.handle) - drag.from;
      move(movedHandle(drag.clip, drag.handle, by));
    },
    up: () => (drag = null),
    key(/** @type {KeyboardEvent} */ event) {
      const step = STEPS_M[/** @type {keyof typeof STEPS_M} */ (event.key)];
      if (step === undefined) return;
      event.preventDefault();
      move(movedHandle(page.state.clip, handle, event.shiftKey ? 10 * step : step));
    },
  });

  const button = (/** @type {Handle & {x: number, y: number}} */ handle) => {
    const { key, m, p, axis, x, y } = handle;
    const ahead = toScreen(camera(), screen(), add(p, axis, SHORT_M)) ?? { x, y };
    const outward = Math.atan2(ahead.y - y, ahead.x - x);
    const { down, move: moved, up, key: pressed } = on(handle);
    const name = key === "section" ? t("handle-section") : t("handle-box", { side: key });
    return html`<button
      type="button"
      role="slider"
      title=${t("handle-keys", { name })}
      aria-label=${name}
      aria-valuenow=${m.toFixed(2)}
      aria-valuetext=${`${decimal(m, 2)} m`}
      .style=${`left: ${x}px; top: ${y}px; rotate: ${outward}rad`}
      @pointerdown=${down}
      @pointermove=${moved}
      @pointerup=${up}
      @pointercancel=${up}
      @keydown=${pressed}
    ></button>`;
  };

  /** Draws them where they are now; none while a tool is chosen, which takes the clicks. */
  return function drawHandles() {
    const all = page.tool === "" ? handlesOf(page.state.clip, heightsShown()) : [];
    const { width, height } = screen();
    const shown = all.flatMap((handle) => {
      const at = toScreen(camera(), screen(), handle.p);
      if (!at) return [];
      const inside = at.x > 0 && at.y > 0 && at.x < width && at.y < height;
      const dragged = drag?.handle.key === handle.key;
      return dragged || (inside && isDraggable(camera(), handle)) ? [{ ...handle, ...at }] : [];
    });
    render(
      repeat(shown, ({ key }) => key, button),
      element,
    );
  };
}
