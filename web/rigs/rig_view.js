// <rig-view>: the drawing of a rig on a canvas. Drag or arrow keys orbit; wheel, pinch, + - zoom.

import { html, render } from "../shared/dom.js";
import { listenToGestures } from "../shared/gestures.js";
import { OrbitCamera } from "./orbit_camera.js";
import { boundsOf, describe, shapesOf } from "./rig_scene.js";
import { t } from "../shared/texts.js";

/**
 * @import {Rig} from "./rig_math.js"
 * @import {Shape} from "./rig_scene.js"
 * @typedef {Shape & {depth: number}} FlatShape in pixels
 */

const STEP_PX = 20; // of an arrow key
const ZOOM = 1.2;
const BEHIND = 1e-3; // lines are drawn over the faces they lie in [m]
/** @type {Record<string, (camera: OrbitCamera) => void>} */
const KEYS = {
  ArrowLeft: (camera) => camera.orbit(-STEP_PX, 0),
  ArrowRight: (camera) => camera.orbit(STEP_PX, 0),
  ArrowUp: (camera) => camera.orbit(0, -STEP_PX),
  ArrowDown: (camera) => camera.orbit(0, STEP_PX),
  "+": (camera) => camera.zoom(ZOOM),
  "-": (camera) => camera.zoom(1 / ZOOM),
};

export class RigView extends HTMLElement {
  #canvas = document.createElement("canvas");
  #camera = new OrbitCamera();
  /** @type {Rig | null} */
  #content = null;
  /** @type {Shape[]} */
  #shapes = [];
  #waiting = false;
  #shown = "";

  connectedCallback() {
    Object.assign(this.#canvas, { tabIndex: 0, role: "img" });
    render(
      html`${this.#canvas}
        <div class="view-buttons">
          ${this.#button("+", t("zoom-in"), () => this.#camera.zoom(ZOOM))}
          ${this.#button("−", t("zoom-out"), () => this.#camera.zoom(1 / ZOOM))}
          ${this.#button("⟲", t("reset-view"), () => this.#reset())}
        </div>`,
      this,
    );
    listenToGestures(this.#canvas, {
      onDrag: (from, to) => this.#move(() => this.#camera.orbit(to[0] - from[0], to[1] - from[1])),
      onPinch: (before, after) =>
        this.#move(() => {
          this.#camera.zoom(after.apart / Math.max(before.apart, 1));
          const [a, b] = [before.middle, after.middle];
          this.#camera.orbit(b[0] - a[0], b[1] - a[1]);
        }),
      onWheel: (deltaY) => this.#move(() => this.#camera.zoom(Math.exp(-deltaY * 0.0015))),
    });
    this.#canvas.addEventListener("keydown", (event) => this.#press(event));
    new ResizeObserver(() => this.#fit()).observe(this.#canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.#later());
  }

  /**
   * Shows a rig; `elevations` are the beams of each model. The view stays for the same `key`.
   * @param {Rig} content
   * @param {Record<string, number[] | null>} elevations
   * @param {string} key
   */
  show(content, elevations, key) {
    this.#content = content;
    this.#shapes = shapesOf(content, elevations);
    this.#canvas.setAttribute("aria-label", describe(content));
    if (this.#shown !== key) {
      this.#shown = key;
      this.#reset();
    }
    this.#later();
  }

  /**
   * @param {string} text
   * @param {string} title
   * @param {() => void} action
   */
  #button(text, title, action) {
    const onclick = () => this.#move(action);
    return html`<button type="button" title=${title} aria-label=${title} @click=${onclick}>
      ${text}
    </button>`;
  }

  #press(/** @type {KeyboardEvent} */ event) {
    const action = event.key === "0" ? () => this.#reset() : KEYS[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    this.#move(() => action(this.#camera));
  }

  #move(/** @type {() => void} */ action) {
    action();
    this.#later();
  }

  /** @returns {[number, number]} */
  get #size() {
    return [this.#canvas.clientWidth, this.#canvas.clientHeight];
  }

  #reset() {
    if (this.#content) this.#camera.reset(boundsOf(this.#content), this.#size);
  }

  #fit() {
    if (this.#content) this.#camera.fit(boundsOf(this.#content), this.#size);
    this.#later();
  }

  #later() {
    if (this.#waiting) return;
    this.#waiting = true;
    requestAnimationFrame(() => {
      this.#waiting = false;
      this.#draw();
    });
  }

  #draw() {
    const [width, height] = this.#size;
    if (!this.#content || !width) return;
    const ratio = devicePixelRatio || 1;
    [this.#canvas.width, this.#canvas.height] = [width * ratio, height * ratio];
    const pen = this.#canvas.getContext("2d");
    if (!pen) return;
    pen.setTransform(ratio, 0, 0, ratio, (width * ratio) / 2, (height * ratio) / 2);
    const style = getComputedStyle(this);
    const colorOf = (/** @type {string} */ role) => style.getPropertyValue(`--${role}`).trim();
    const flat = this.#shapes.map((shape) => this.#flatten(shape));
    flat.sort((a, b) => a.depth - b.depth);
    for (const shape of flat) drawShape(pen, shape, colorOf(shape.role));
    const ground = colorOf("view-ground");
    for (const shape of flat) {
      if (shape.kind !== "text") continue;
      drawText(pen, shape, colorOf(shape.role.startsWith("axis") ? shape.role : "ink"), ground);
    }
    const { yaw, pitch, pxPerM } = this.#camera;
    this.#canvas.dataset.view = [yaw, pitch, pxPerM].map((value) => value.toFixed(3)).join(" ");
  }

  /** A shape in pixels, with the depth by which it is sorted. */
  #flatten(/** @type {Shape} */ shape) {
    const points = shape.points.map((point) => this.#camera.project(point));
    const depth = points.reduce((sum, point) => sum + point[2], 0) / points.length;
    return { ...shape, points, depth: shape.kind === "line" ? depth + BEHIND : depth };
  }
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {FlatShape} given
 * @param {string} color
 */
function drawShape(pen, { kind, points, alpha = 1, dashed, width = 1 }, color) {
  if (kind === "text") return;
  pen.beginPath();
  points.forEach(([x, y], /** @type {number} */ k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  if (kind === "face") {
    pen.closePath();
    pen.globalAlpha = alpha;
    pen.fillStyle = color;
    pen.fill();
  } else {
    pen.globalAlpha = 0.9;
    pen.strokeStyle = color;
    pen.lineWidth = width;
    pen.setLineDash(dashed ? [5, 4] : []);
    pen.stroke();
  }
  pen.globalAlpha = 1;
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {FlatShape} given
 * @param {string} color
 * @param {string} ground
 */
function drawText(pen, { points, text = "" }, color, ground) {
  const [[x, y]] = points;
  pen.font = "600 13px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.setLineDash([]);
  pen.lineWidth = 4;
  pen.strokeStyle = ground;
  pen.strokeText(text, x, y);
  pen.fillStyle = color;
  pen.fillText(text, x, y);
}

customElements.define("rig-view", RigView);
