// <slice-view>: a slice with grid, coordinates, scale bar; pan, zoom, pick. No network.
//
// Events: "frame" (panned or zoomed), "moving" (while it moves), "place" (a click; its detail is
// {u, v, reach}).

import { render } from "../shared/dom.js";
import { listenToGestures } from "../shared/gestures.js";
import { drawScaleBar, roundStep } from "../shared/scale_bar.js";
import { decimal, t } from "../shared/texts.js";
import { drawMark } from "./marks.js";
import { imageSize } from "./state.js";

const EDGE = { left: 56, bottom: 26 };
const FINEST_M = 0.0002;
const COARSEST_M = 50;
const CLICK_PX = 5; // a pointer that moves farther drags

/**
 * @import {SliceImageView, WindowSpec} from "../shared/http_types"
 * @import {ColorOf, Mark, Pen} from "./marks.js"
 * @typedef {{u: number, v: number, m: number}} Frame middle [m] and meters per pixel
 * @typedef {{u: number, v: number, reach: number}} Place of a click, and how far around it [m]
 */

export class SliceView extends HTMLElement {
  #canvas = document.createElement("canvas");
  #hover = document.createElement("output");
  /** @type {number[] | null} */
  #center = null; // null before the first image
  #metersPerPx = 0.01;
  /** All of the slice, which stays in sight in a view of another size; null = moved since.
   * @type {WindowSpec | null} */
  #whole = null;
  /** @type {{image: ImageBitmap, window: WindowSpec} | null} */
  #shown = null;
  #axes = ["", ""];
  /** @type {Mark[]} */
  #marks = [];
  #moved = 0; // by the pointer since it went down [px]
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #rest = undefined;
  #newest = 0; // number of the newest image
  /** Takes drags and clicks, in place of moving the view; places on the plane [m].
   * @type {((from: number[], to: number[]) => void) | null} */
  painting = null;

  connectedCallback() {
    Object.assign(this.#hover, { className: "cursor", ariaLive: "off" });
    Object.assign(this.#canvas, { tabIndex: 0, role: "img" });
    this.label = ""; // until somebody says of what
    render([this.#canvas, this.#hover], this);
    const canvas = this.#canvas;
    listenToGestures(canvas, {
      onDown: (_at, _event, count) => {
        if (count === 1) this.#moved = 0;
      },
      onHover: (at, event) => this.#hovered(at, event),
      onDrag: (from, to) => this.#dragged(from, to),
      onPinch: (before, after) => this.#pinched(before, after),
      onUp: (at, event, count) => this.#released(at, event, count),
      onWheel: (deltaY, at) =>
        this.zoom(Math.exp(Math.max(-120, Math.min(120, deltaY)) * 0.0022), at),
    });
    canvas.addEventListener("pointerleave", () => (this.#hover.value = ""));
    canvas.addEventListener("keydown", (event) => this.#key(event));
    new ResizeObserver(() => this.#resized()).observe(this);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  /** The label for screen readers. */
  set label(/** @type {string} */ text) {
    this.#canvas.setAttribute("aria-label", text || t("slice"));
  }

  /** Middle [m] and meters per pixel; null before the first image. */
  get frame() {
    return this.#center && { u: this.#center[0], v: this.#center[1], m: this.#metersPerPx };
  }

  set frame(frame) {
    const before = this.frame;
    this.#center = frame && [frame.u, frame.v];
    if (frame) this.#metersPerPx = Math.min(COARSEST_M, Math.max(FINEST_M, frame.m));
    if (JSON.stringify(this.frame) !== JSON.stringify(before)) this.#whole = null;
    this.draw();
  }

  /** Size and window to request: pixels of the screen, and the window if one is chosen. */
  get wanted() {
    const { width, height } = this.#size();
    const ask = imageSize(width, height, devicePixelRatio);
    if (!this.#center) return ask;
    const [u, v] = this.#center;
    const [du, dv] = [(width * this.#metersPerPx) / 2, (height * this.#metersPerPx) / 2];
    return { ...ask, window: { left: u - du, bottom: v - dv, right: u + du, top: v + dv } };
  }

  /** Shows a slice image of the server. */
  async show(/** @type {Pick<SliceImageView, "png" | "window" | "axes">} */ { png, window, axes }) {
    const bytes = Uint8Array.from(atob(png), (one) => one.charCodeAt(0));
    const mine = (this.#newest += 1);
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    if (mine !== this.#newest) return image.close(); // a newer one is shown already
    this.#shown?.image.close();
    [this.#shown, this.#axes] = [{ image, window }, axes];
    if (!this.#center) this.#fit(window);
    else this.draw();
  }

  /** All of a window between the edges with the coordinates. */
  #fit(/** @type {WindowSpec} */ window) {
    const { width, height } = this.#size();
    const m = Math.max(
      (window.right - window.left) / (width - EDGE.left),
      (window.top - window.bottom) / (height - EDGE.bottom),
    );
    const [u, v] = [(window.left + window.right) / 2, (window.bottom + window.top) / 2];
    this.#center = [u - (m * EDGE.left) / 2, v - (m * EDGE.bottom) / 2];
    this.#metersPerPx = m;
    this.#whole = window;
    this.#changed();
  }

  #resized() {
    if (this.#whole) this.#fit(this.#whole);
    else if (this.#center) this.#changed();
    else this.draw();
  }

  clear() {
    this.#shown = null;
    this.draw();
  }

  /** Points and lines to mark: [{points: [[u, v], …], text}]. */
  set marks(/** @type {Mark[]} */ marks) {
    this.#marks = marks;
    this.draw();
  }

  /** The middle of the view; [0, 0] before the first image. */
  get #middle() {
    return this.#center ?? [0, 0];
  }

  #size() {
    const { width, height } = this.getBoundingClientRect();
    return { width: Math.max(16, width), height: Math.max(16, height) };
  }

  /** @returns {[number, number]} */
  #toPx(/** @type {number[]} */ [u, v]) {
    const { width, height } = this.#size();
    return [
      width / 2 + (u - this.#middle[0]) / this.#metersPerPx,
      height / 2 - (v - this.#middle[1]) / this.#metersPerPx,
    ];
  }

  /** @returns {[number, number]} */
  #toPlane(/** @type {number[]} */ [x, y]) {
    const { width, height } = this.#size();
    return [
      this.#middle[0] + (x - width / 2) * this.#metersPerPx,
      this.#middle[1] - (y - height / 2) * this.#metersPerPx,
    ];
  }

  draw() {
    const { width, height } = this.#size();
    const ratio = devicePixelRatio || 1;
    const canvas = this.#canvas;
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    const pen = canvas.getContext("2d");
    if (!pen) return;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    const style = getComputedStyle(this);
    const color = (/** @type {string} */ name) => style.getPropertyValue(name).trim();
    pen.fillStyle = color("--paper");
    pen.fillRect(0, 0, width, height);
    if (!this.#center) return;
    const step = roundStep(this.#metersPerPx * 84);
    this.#grid(pen, step, color("--grid"));
    if (this.#shown) {
      const { image, window } = this.#shown;
      const [x0, y0] = this.#toPx([window.left, window.top]);
      const [x1, y1] = this.#toPx([window.right, window.bottom]);
      pen.imageSmoothingEnabled = x1 - x0 < image.width * 1.2;
      pen.drawImage(image, x0, y0, x1 - x0, y1 - y0);
    }
    this.#labels(pen, step, color);
    drawScaleBar(pen, 1 / this.#metersPerPx, {
      right: width - 16,
      bottom: height - EDGE.bottom - 14,
      ink: color("--ink"),
      halo: color("--paper"),
    });
    const [toPx, scale] = [(/** @type {number[]} */ uv) => this.#toPx(uv), 1 / this.#metersPerPx];
    for (const mark of this.#marks) drawMark(pen, mark, { toPx, scale, color, width });
  }

  /**
   * @param {number} step
   * @param {0 | 1} axis
   */
  #lines(step, axis) {
    const { width, height } = this.#size();
    const reach = ((axis ? height : width) * this.#metersPerPx) / 2;
    const first = Math.ceil((this.#middle[axis] - reach) / step);
    const last = Math.floor((this.#middle[axis] + reach) / step);
    return Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => (first + k) * step);
  }

  /**
   * @param {Pen} pen
   * @param {number} step
   * @param {string} color
   */
  #grid(pen, step, color) {
    const { width, height } = this.#size();
    pen.strokeStyle = color;
    pen.lineWidth = 1;
    pen.beginPath();
    for (const u of this.#lines(step, 0)) {
      const x = Math.round(this.#toPx([u, 0])[0]) + 0.5;
      pen.moveTo(x, 0);
      pen.lineTo(x, height);
    }
    for (const v of this.#lines(step, 1)) {
      const y = Math.round(this.#toPx([0, v])[1]) + 0.5;
      pen.moveTo(0, y);
      pen.lineTo(width, y);
    }
    pen.stroke();
  }

  /**
   * @param {Pen} pen
   * @param {number} step
   * @param {ColorOf} color
   */
  #labels(pen, step, color) {
    const { width, height } = this.#size();
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const text = (/** @type {number} */ x) =>
      decimal(Math.abs(x) < step / 2 ? 0 : x, digits).replace("-", "−");
    pen.fillStyle = color("--paper-edge");
    pen.fillRect(0, height - EDGE.bottom, width, EDGE.bottom);
    pen.fillRect(0, 0, EDGE.left, height);
    pen.fillStyle = color("--quiet");
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    const across = this.#axes[0].replace("along the section", t("axis-section"));
    const free = width - pen.measureText(across).width - 32;
    for (const u of this.#lines(step, 0)) {
      const x = this.#toPx([u, 0])[0];
      if (x > EDGE.left + 16 && x < free) pen.fillText(text(u), x, height - EDGE.bottom / 2);
    }
    pen.textAlign = "right";
    for (const v of this.#lines(step, 1)) {
      const y = this.#toPx([0, v])[1];
      if (y > 26 && y < height - EDGE.bottom - 10) pen.fillText(text(v), EDGE.left - 8, y);
    }
    pen.fillStyle = color("--ink");
    pen.fillText(across, width - 8, height - EDGE.bottom / 2);
    pen.textAlign = "left";
    pen.fillText(this.#axes[1].replace("height ", ""), 8, 12);
    pen.strokeStyle = color("--line");
    pen.strokeRect(EDGE.left + 0.5, -1, width, height - EDGE.bottom + 0.5);
  }

  // -- pointers

  /**
   * @param {number[]} at
   * @param {PointerEvent} event
   */
  #hovered(at, event) {
    if (!this.#center || event.pointerType !== "mouse") return;
    const digits = this.#metersPerPx < 0.005 ? 3 : 2;
    this.#hover.value = this.#toPlane(at)
      .map((x, k) => `${["u", "v"][k]} ${decimal(x, digits)}`)
      .join("  ");
  }

  /**
   * @param {number[]} from
   * @param {number[]} to
   */
  #dragged(from, to) {
    if (!this.#center) return;
    if (this.painting) return this.painting(this.#toPlane(from), this.#toPlane(to));
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    this.#moved += Math.hypot(dx, dy);
    if (this.#moved > CLICK_PX) this.#shift(dx, dy);
  }

  /**
   * @param {import("../shared/gestures.js").Pair} before
   * @param {import("../shared/gestures.js").Pair} after
   */
  #pinched(before, after) {
    if (!this.#center) return;
    this.#shift(after.middle[0] - before.middle[0], after.middle[1] - before.middle[1]);
    this.zoom(before.apart / Math.max(after.apart, 1), after.middle);
    this.#moved = Infinity;
  }

  /**
   * @param {number[]} at
   * @param {PointerEvent} event
   * @param {number} count
   */
  #released(at, event, count) {
    const click = count === 1 && this.#moved <= CLICK_PX && event.type === "pointerup";
    if (!click || !this.#center) return;
    const [u, v] = this.#toPlane(at);
    if (this.painting) return this.painting([u, v], [u, v]);
    const reach = (event.pointerType === "mouse" ? 8 : 18) * this.#metersPerPx;
    this.dispatchEvent(new CustomEvent("place", { detail: { u, v, reach } }));
  }

  #key(/** @type {KeyboardEvent} */ event) {
    /** @type {Record<string, [number, number]>} */
    const shifts = {
      ArrowLeft: [80, 0],
      ArrowRight: [-80, 0],
      ArrowUp: [0, 80],
      ArrowDown: [0, -80],
    };
    const shift = shifts[event.key];
    if (shift) this.#shift(...shift);
    else if (event.key === "Enter" && this.#center) {
      const [u, v] = this.#center;
      this.dispatchEvent(
        new CustomEvent("place", { detail: { u, v, reach: 16 * this.#metersPerPx } }),
      );
    } else return;
    event.preventDefault();
  }

  /**
   * @param {number} dx
   * @param {number} dy
   */
  #shift(dx, dy) {
    this.#center = [
      this.#middle[0] - dx * this.#metersPerPx,
      this.#middle[1] + dy * this.#metersPerPx,
    ];
    this.#whole = null;
    this.#changed();
  }

  /**
   * Closer by a factor below 1, about a place of the view or its middle.
   * @param {number} factor
   * @param {number[]} [at]
   */
  zoom(factor, at) {
    if (!this.#center) return;
    const { width, height } = this.#size();
    const place = at ?? [width / 2, height / 2];
    const [u, v] = this.#toPlane(place);
    const next = Math.min(COARSEST_M, Math.max(FINEST_M, this.#metersPerPx * factor));
    const scale = next / this.#metersPerPx;
    this.#center = [u + (this.#middle[0] - u) * scale, v + (this.#middle[1] - v) * scale];
    this.#metersPerPx = next;
    this.#whole = null;
    this.#changed();
  }

  #changed() {
    this.draw();
    this.dispatchEvent(new Event("moving"));
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => this.dispatchEvent(new Event("frame")), 140);
  }
}

customElements.define("slice-view", SliceView);
