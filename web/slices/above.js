// <slice-above>: the map from above with the slice on it. Drag the line or its ends; drag beside it
// for a new slice.
//
// Event: "slice" with detail {a, b} [m].

import { make } from "../shared/dom.js";
import { listenToGestures } from "../shared/gestures.js";
import { drawScaleBar } from "../shared/scale_bar.js";
import { normalOf } from "./state.js";

const GRIP_PX = 22;

export class SliceAbove extends HTMLElement {
  #canvas = make("canvas", { tabIndex: -1 });
  #image = null;
  #window = null;
  #state = null;
  #wall = null;
  #drag = null;

  connectedCallback() {
    this.replaceChildren(this.#canvas);
    this.setAttribute("aria-busy", "true"); // nothing to drag before the image is there
    this.#canvas.setAttribute("role", "img");
    this.#canvas.setAttribute("aria-label", "The map from above, with the slice");
    listenToGestures(this.#canvas, {
      onDown: (at) => this.#down(at),
      onDrag: (_from, to) => this.#dragged(to),
      onUp: () => (this.#drag = null),
    });
    new ResizeObserver(() => this.draw()).observe(this);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  /** Shows the image at a URL of a window of the map [m]. */
  show(url, window) {
    const image = make("img", { src: url, alt: "" });
    image.addEventListener("load", () => {
      this.removeAttribute("aria-busy");
      [this.#image, this.#window] = [image, window];
      this.draw();
    });
  }

  set state(state) {
    this.#state = state;
    this.draw();
  }

  /** A place to mark [m], or null. */
  set place(place) {
    this.#wall = place;
    this.draw();
  }

  #fit() {
    const { width, height } = this.getBoundingClientRect();
    const w = this.#window;
    const scale = Math.min(width / (w.right - w.left), height / (w.top - w.bottom));
    return { width, height, scale, u: (w.left + w.right) / 2, v: (w.bottom + w.top) / 2 };
  }

  #toPx(/** @type {number[]} */ [x, y]) {
    const { width, height, scale, u, v } = this.#fit();
    return [width / 2 + (x - u) * scale, height / 2 - (y - v) * scale];
  }

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
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    if (!this.#window || !this.#state) return;
    const style = getComputedStyle(this);
    const color = (name) => style.getPropertyValue(name).trim();
    const w = this.#window;
    const [x0, y0] = this.#toPx([w.left, w.top]);
    const [x1, y1] = this.#toPx([w.right, w.bottom]);
    pen.drawImage(this.#image, x0, y0, x1 - x0, y1 - y0);
    const ends = this.#trace();
    if (ends) this.#line(pen, ends, color);
    if (this.#wall) {
      const [x, y] = this.#toPx(this.#wall);
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

  /** Ends of the slice's line in the map; null for a level plane. */
  #trace() {
    const s = this.#state;
    if (s.kind === "vertical") return [s.a, s.b];
    if (s.kind === "horizontal") return null;
    const n = normalOf(s);
    const flat = Math.hypot(n[0], n[1]);
    if (flat < 0.02) return null;
    const reach =
      (this.#window.right - this.#window.left + this.#window.top - this.#window.bottom) / 2;
    const along = [n[1] / flat, -n[0] / flat];
    return [-1, 1].map((side) => [
      s.o[0] + side * reach * along[0],
      s.o[1] + side * reach * along[1],
    ]);
  }

  #line(pen, ends, color) {
    const [a, b] = ends.map((end) => this.#toPx(end));
    const grips = this.#state.kind === "vertical";
    for (const [stroke, width] of [
      [color("--panel"), 6],
      [color("--accent"), 2.5],
    ]) {
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

  #down(at) {
    if (!this.#window || !this.#state) return;
    const place = this.#toMap(at);
    const { kind, a, b } = this.#state;
    const near = (end) => Math.hypot(...this.#toPx(end).map((x, k) => x - at[k])) < GRIP_PX;
    if (kind === "vertical" && near(a)) this.#drag = { what: "a" };
    else if (kind === "vertical" && near(b)) this.#drag = { what: "b" };
    else if (kind === "vertical" && this.#offLine(at) < GRIP_PX)
      this.#drag = { what: "line", from: place, a, b };
    else this.#drag = { what: "new", from: place, px: at };
  }

  #offLine(at) {
    const [a, b] = [this.#toPx(this.#state.a), this.#toPx(this.#state.b)];
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const s = Math.max(
      0,
      Math.min(1, ((at[0] - a[0]) * dx + (at[1] - a[1]) * dy) / (dx * dx + dy * dy || 1)),
    );
    return Math.hypot(at[0] - a[0] - s * dx, at[1] - a[1] - s * dy);
  }

  #dragged(at) {
    const drag = this.#drag;
    if (!drag) return;
    const place = this.#toMap(at);
    const shift = drag.from ? place.map((x, k) => x - drag.from[k]) : null;
    const { a, b } = this.#state;
    if (drag.what === "a") this.#emit(place, b);
    else if (drag.what === "b") this.#emit(a, place);
    else if (drag.what === "line")
      this.#emit(
        drag.a.map((x, k) => x + shift[k]),
        drag.b.map((x, k) => x + shift[k]),
      );
    else if (Math.hypot(at[0] - drag.px[0], at[1] - drag.px[1]) > 12) this.#emit(drag.from, place);
  }

  #emit(a, b) {
    if (Math.hypot(b[0] - a[0], b[1] - a[1]) > 0.05)
      this.dispatchEvent(new CustomEvent("slice", { detail: { a, b } }));
  }
}

customElements.define("slice-above", SliceAbove);
