// <slice-above>: the map from above with the slice and the marked stretch of the walk on it. Drag
// the line or its ends; drag beside it for a new slice.
//
// Event: "slice" with detail {a, b} [m].

import { render } from "../shared/dom.js";
import { listenToGestures } from "../shared/gestures.js";
import { drawScaleBar } from "../shared/scale_bar.js";
import { t } from "../shared/texts.js";
import { normalOf } from "./state.js";

const GRIP_PX = 22;

/**
 * @import {WindowSpec} from "../shared/http_types"
 * @import {SliceState} from "./state.js"
 * @import {ColorOf, Pen} from "./marks.js"
 * @typedef {{what: "a"} | {what: "b"} | {what: "line", from: number[], a: number[], b: number[]} |
 *   {what: "new", from: number[], px: number[]}} Drag what a pointer moves
 */

export class SliceAbove extends HTMLElement {
  #canvas = document.createElement("canvas");
  /** @type {{image: HTMLImageElement, window: WindowSpec} | null} */
  #map = null;
  /** @type {SliceState | null} */
  #state = null;
  /** @type {number[] | null} */
  #place = null;
  /** @type {number[][]} */
  #walk = [];
  /** @type {Drag | null} */
  #drag = null;

  connectedCallback() {
    this.#canvas.tabIndex = -1;
    render(this.#canvas, this);
    this.setAttribute("aria-busy", "true"); // nothing to drag before the image is there
    this.#canvas.setAttribute("role", "img");
    this.#canvas.setAttribute("aria-label", t("above-label"));
    listenToGestures(this.#canvas, {
      onDown: (at) => this.#down(at),
      onDrag: (_from, to) => this.#dragged(to),
      onUp: () => (this.#drag = null),
    });
    new ResizeObserver(() => this.draw()).observe(this);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  /**
   * Shows the image at a URL of a window of the map [m].
   * @param {string} url
   * @param {WindowSpec} window
   */
  show(url, window) {
    const image = Object.assign(document.createElement("img"), { src: url, alt: "" });
    image.addEventListener("load", () => {
      this.removeAttribute("aria-busy");
      this.#map = { image, window };
      this.draw();
    });
  }

  set state(/** @type {SliceState} */ state) {
    this.#state = state;
    this.draw();
  }

  /** A place to mark [m], or null. */
  set place(/** @type {number[] | null} */ place) {
    this.#place = place;
    this.draw();
  }

  /** Positions of the walk to mark [m]. */
  set walk(/** @type {number[][]} */ positions) {
    this.#walk = positions;
    this.draw();
  }

  #fit() {
    const { width, height } = this.getBoundingClientRect();
    const w = this.#map?.window ?? { left: 0, right: 1, bottom: 0, top: 1 };
    const scale = Math.min(width / (w.right - w.left), height / (w.top - w.bottom));
    return { width, height, scale, u: (w.left + w.right) / 2, v: (w.bottom + w.top) / 2 };
  }

  /** @returns {[number, number]} */
  #toPx(/** @type {number[]} */ [x, y]) {
    const { width, height, scale, u, v } = this.#fit();
    return [width / 2 + (x - u) * scale, height / 2 - (y - v) * scale];
  }

  /** @returns {[number, number]} */
  #toMap(/** @type {number[]} */ [x, y]) {
    const { width, height, scale, u, v } = this.#fit();
    return [u + (x - width / 2) / scale, v - (y - height / 2) / scale];
  }

  draw() {
    const { width, height } = this.getBoundingClientRect();
    const ratio = devicePixelRatio || 1;
    const canvas = this.#canvas;
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    const pen = canvas.getContext("2d");
    if (!pen) return;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    if (!this.#map || !this.#state) return;
    const { image, window: w } = this.#map;
    const style = getComputedStyle(this);
    const color = (/** @type {string} */ name) => style.getPropertyValue(name).trim();
    const [x0, y0] = this.#toPx([w.left, w.top]);
    const [x1, y1] = this.#toPx([w.right, w.bottom]);
    pen.drawImage(image, x0, y0, x1 - x0, y1 - y0);
    const ends = traceOf(this.#state, w);
    if (ends) this.#line(pen, ends, color);
    this.#stretch(pen, color);
    if (this.#place) {
      const [x, y] = this.#toPx(this.#place);
      pen.strokeStyle = color("--bad");
      pen.lineWidth = 3;
      pen.beginPath();
      pen.arc(x, y, 9, 0, 2 * Math.PI);
      pen.stroke();
    }
    drawScaleBar(pen, this.#fit().scale, {
      left: 10,
      bottom: height - 10,
      ink: color("--quiet"),
      halo: color("--panel"),
    });
  }

  /**
   * @param {Pen} pen
   * @param {ColorOf} color
   */
  #stretch(pen, color) {
    pen.strokeStyle = color("--bad");
    pen.lineWidth = 4;
    pen.lineCap = "round"; // one position is a dot
    pen.beginPath();
    for (const position of this.#walk) pen.lineTo(...this.#toPx(position));
    if (this.#walk[0]) pen.lineTo(...this.#toPx(this.#walk.at(-1) ?? this.#walk[0]));
    pen.stroke();
    pen.lineCap = "butt";
  }

  /**
   * @param {Pen} pen
   * @param {[number[], number[]]} ends
   * @param {ColorOf} color
   */
  #line(pen, ends, color) {
    const [a, b] = [this.#toPx(ends[0]), this.#toPx(ends[1])];
    const grips = this.#state?.kind === "vertical";
    /** @type {Array<[string, number]>} */
    const strokes = [
      [color("--panel"), 6],
      [color("--accent"), 2.5],
    ];
    for (const [stroke, width] of strokes) {
      pen.strokeStyle = stroke;
      pen.lineWidth = width;
      pen.beginPath();
      pen.moveTo(...a);
      pen.lineTo(...b);
      pen.stroke();
    }
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const side = [(b[1] - a[1]) / length, -(b[0] - a[0]) / length];
    const middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    pen.fillStyle = color("--accent");
    pen.beginPath(); // viewing direction
    pen.moveTo(middle[0] + 16 * side[0], middle[1] + 16 * side[1]);
    pen.lineTo(middle[0] + 7 * side[1], middle[1] - 7 * side[0]);
    pen.lineTo(middle[0] - 7 * side[1], middle[1] + 7 * side[0]);
    pen.fill();
    if (!grips) return;
    [a, b].forEach(([x, y], k) => {
      pen.fillStyle = color("--accent");
      pen.beginPath();
      pen.arc(x, y, 10, 0, 2 * Math.PI);
      pen.fill();
      pen.fillStyle = color("--accent-ink");
      pen.font = "600 12px system-ui, sans-serif";
      pen.textAlign = "center";
      pen.textBaseline = "middle";
      pen.fillText("AB"[k], x, y + 0.5);
    });
  }

  #down(/** @type {number[]} */ at) {
    if (!this.#map || !this.#state) return;
    const place = this.#toMap(at);
    const { kind, a, b } = this.#state;
    const near = (/** @type {number[]} */ end) =>
      Math.hypot(...this.#toPx(end).map((x, k) => x - at[k])) < GRIP_PX;
    if (kind === "vertical" && near(a)) this.#drag = { what: "a" };
    else if (kind === "vertical" && near(b)) this.#drag = { what: "b" };
    else if (kind === "vertical" && this.#offLine(at) < GRIP_PX)
      this.#drag = { what: "line", from: place, a, b };
    else this.#drag = { what: "new", from: place, px: at };
  }

  /** How far a position lies from the line of the slice [px]. */
  #offLine(/** @type {number[]} */ at) {
    if (!this.#state) return Infinity;
    const [a, b] = [this.#toPx(this.#state.a), this.#toPx(this.#state.b)];
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const s = Math.max(
      0,
      Math.min(1, ((at[0] - a[0]) * dx + (at[1] - a[1]) * dy) / (dx * dx + dy * dy || 1)),
    );
    return Math.hypot(at[0] - a[0] - s * dx, at[1] - a[1] - s * dy);
  }

  #dragged(/** @type {number[]} */ at) {
    const drag = this.#drag;
    if (!drag || !this.#state) return;
    const place = this.#toMap(at);
    const { a, b } = this.#state;
    if (drag.what === "a") this.#emit(place, b);
    else if (drag.what === "b") this.#emit(a, place);
    else if (drag.what === "line") {
      const shifted = (/** @type {number[]} */ end) =>
        end.map((x, k) => x + place[k] - drag.from[k]);
      this.#emit(shifted(drag.a), shifted(drag.b));
    } else if (Math.hypot(at[0] - drag.px[0], at[1] - drag.px[1]) > 12)
      this.#emit(drag.from, place);
  }

  /**
   * @param {number[]} a
   * @param {number[]} b
   */
  #emit(a, b) {
    if (Math.hypot(b[0] - a[0], b[1] - a[1]) > 0.05)
      this.dispatchEvent(new CustomEvent("slice", { detail: { a, b } }));
  }
}

/**
 * Ends of the slice's line in the map; null for a level plane.
 * @param {SliceState} state
 * @param {WindowSpec} window
 * @returns {[number[], number[]] | null}
 */
function traceOf(state, { left, right, bottom, top }) {
  if (state.kind === "vertical") return [state.a, state.b];
  if (state.kind === "horizontal") return null;
  const n = normalOf(state);
  const flat = Math.hypot(n[0], n[1]);
  if (flat < 0.02) return null;
  const reach = (right - left + top - bottom) / 2;
  const [x, y] = [(reach * n[1]) / flat, (-reach * n[0]) / flat];
  const { o } = state;
  return [
    [o[0] - x, o[1] - y],
    [o[0] + x, o[1] + y],
  ];
}

customElements.define("slice-above", SliceAbove);
