// <pair-view>: the points of two places laid over each other, first red, second green.

import { make } from "../shared/dom.js";
import { Camera, IDENTITY, apply, nudged, rotationOf, times, transposed, turn } from "./math.js";

const RED = 0xff4a52ff; // A B G R
const GREEN = 0xff7fd62f;
const GROUND = 0xff18140f;
const VIEWS = { above: "Above", side: "Side", free: "Free", cut: "Cut" };
const SHOWN = { odometry: "Odometry", predicted: "Graph", after: "Aligned" };
const HANDLE_PX = 22;
const RING_PX = 66;
const PICK_PX = 14;

export class PairView extends HTMLElement {
  camera = new Camera();
  #view = "above";
  #shown = "after";
  #points = null;
  #poses = { odometry: IDENTITY, predicted: IDENTITY, after: IDENTITY };
  #upright = [1, 0, 0, 0, 1, 0, 0, 0, 1];
  #picking = null;
  #pointers = new Map();
  #drag = null;
  #asked = false;
  #drawn = null; // to call once the points are on the screen
  #canvas = make("canvas", { tabIndex: 0, role: "img", ariaLabel: "Points of both places" });
  #over = make("p", { className: "view-words" });
  #empty = make("p", { className: "view-empty" });
  #height = make("input", {
    type: "range",
    min: -300,
    max: 300,
    value: 0,
    ariaLabel: "Place of the cut",
  });
  #upwards = make("input", { type: "checkbox" });
  #cutWords = make("output");
  #cut = make("div", { className: "cut", hidden: true });
  #reach = make("select", { ariaLabel: "Multiframes shown around each place" });
  #buttons = {};

  connectedCallback() {
    const group = (label, choices, action) =>
      make(
        "div",
        { role: "group", ariaLabel: label, className: "choice" },
        ...Object.entries(choices).map(
          ([key, words]) =>
            (this.#buttons[key] = make(
              "button",
              { type: "button", onclick: () => action(key) },
              words,
            )),
        ),
      );
    this.#reach.append(
      ...[0, 2, 5, 10].map((n) =>
        make("option", { value: n }, n ? `± ${n} multiframes` : "One multiframe"),
      ),
    );
    this.#reach.addEventListener("change", () => this.#tell("reach"));
    this.#cut.append(
      make("label", {}, make("span", {}, "Place of the cut"), this.#height, this.#cutWords),
      make("label", { className: "check" }, this.#upwards, make("span", {}, "Upright cut")),
    );
    this.#height.addEventListener("input", () => this.#draw());
    this.#upwards.addEventListener("change", () => this.show(this.#view));
    this.replaceChildren(
      make(
        "div",
        { className: "view-tools" },
        group("View", VIEWS, (key) => this.show(key)),
        group("Show", SHOWN, (key) => this.compare(key)),
        this.#reach,
      ),
      make(
        "div",
        { className: "view-stage" },
        this.#canvas,
        this.#over,
        this.#legend(),
        this.#empty,
      ),
      this.#cut,
    );
    new ResizeObserver(() => this.#draw()).observe(this.#canvas);
    this.#listen();
    this.show("above");
    this.compare("after");
  }

  /** Multiframes shown around each place. */
  get reach() {
    return Number(this.#reach.value);
  }

  /**
   * Shows a pair: points of both, poses {odometry, predicted, after}, rotation to upright as a quaternion.
   * The promise is kept once the points are drawn; never if another pair comes first.
   */
  set(points, poses, upright) {
    this.#points = points;
    this.#poses = poses;
    this.#upright = rotationOf(upright);
    this.#picking = null;
    this.#empty.textContent = "";
    this.#fit();
    this.#draw();
    return new Promise((resolve) => (this.#drawn = resolve));
  }

  /** Shows nothing, and why. */
  clear(words) {
    this.#points = this.#drawn = null;
    this.#empty.textContent = words;
    this.#draw();
  }

  /** Where the second place is laid, x y z qx qy qz qw in the first. */
  get pose() {
    return this.#poses.after;
  }

  set pose(pose) {
    this.#poses = { ...this.#poses, after: pose };
    this.compare("after");
  }

  /** Where a point of the first place's frame is on the canvas [px]. */
  on(p) {
    return this.#place(p);
  }

  show(view) {
    this.#view = view;
    const upright = view === "side" || (view === "cut" && this.#upwards.checked);
    if (view === "free") [this.camera.yaw, this.camera.pitch] = [0.6, 0.6];
    else [this.camera.yaw, this.camera.pitch] = [0, upright ? 0 : Math.PI / 2];
    this.#cut.hidden = view !== "cut";
    for (const key of Object.keys(VIEWS)) this.#buttons[key].ariaPressed = String(key === view);
    this.#draw();
  }

  compare(shown) {
    this.#shown = shown;
    for (const key of Object.keys(SHOWN)) this.#buttons[key].ariaPressed = String(key === shown);
    this.#draw();
  }

  /** The next of odometry, graph, aligned. */
  compareNext() {
    const keys = Object.keys(SHOWN);
    this.compare(keys[(keys.indexOf(this.#shown) + 1) % keys.length]);
  }

  viewNext() {
    const keys = Object.keys(VIEWS);
    this.show(keys[(keys.indexOf(this.#view) + 1) % keys.length]);
  }

  moveCut(steps) {
    if (this.#view !== "cut") this.show("cut");
    this.#height.value = Number(this.#height.value) + 5 * steps;
    this.#draw();
  }

  /** Moves the second place on the screen [m] and turns it about the line of sight [rad]. */
  nudge(right, up, angle = 0) {
    const [x, y, eye] = this.camera.axes();
    const shift = x.map((v, k) => v * right + y[k] * up);
    this.#lay(nudged(this.pose, this.#toBody(shift), this.#toBody(eye), angle));
  }

  lift(height) {
    this.#lay(nudged(this.pose, this.#toBody([0, 0, height]), [0, 0, 1], 0));
  }

  /** Lets the person pick the same points in both, three pairs; `done({p_i, p_j})`. */
  pick(done) {
    this.#picking = { i: [], j: [], done };
    this.compare("after");
    this.#canvas.focus();
  }

  get isPicking() {
    return this.#picking !== null;
  }

  stopPicking() {
    this.#picking = null;
    this.#draw();
  }

  #legend() {
    const key = (name, words) => make("span", { className: `key ${name}` }, words);
    return make("div", { className: "view-key" }, key("red", "first"), key("green", "second"));
  }

  #tell(name) {
    this.dispatchEvent(new CustomEvent(name, { bubbles: true }));
  }

  #lay(pose) {
    this.pose = pose;
    this.#tell("laid");
  }

  #toBody(v) {
    return turn(transposed(this.#upright), v);
  }

  #toUpright(p) {
    return turn(this.#upright, p);
  }

  // -- drawing

  #fit() {
    const p = this.#points.i;
    if (!p.length) return;
    const far = [];
    for (let k = 0; k < p.length; k += 30) far.push(Math.hypot(p[k], p[k + 1]));
    far.sort((a, b) => a - b);
    const reach = Math.max(2, far[Math.floor(far.length * 0.9)]);
    const small = Math.min(this.#canvas.clientWidth, this.#canvas.clientHeight) || 400;
    this.camera.scale = (0.46 * small) / reach;
    this.camera.center = [0, 0, 0];
  }

  #draw() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.#paint();
    });
  }

  #paint() {
    const ratio = Math.min(2, devicePixelRatio || 1);
    const [width, height] = [
      Math.round(this.#canvas.clientWidth * ratio),
      Math.round(this.#canvas.clientHeight * ratio),
    ];
    if (!width || !height) return;
    if (this.#canvas.width !== width || this.#canvas.height !== height)
      Object.assign(this.#canvas, { width, height });
    const context = this.#canvas.getContext("2d");
    const image = context.createImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer).fill(GROUND);
    const pose = this.#poses[this.#shown];
    if (this.#points) {
      this.#splat(pixels, width, height, ratio, this.#points.i, IDENTITY, RED);
      this.#splat(pixels, width, height, ratio, this.#points.j, pose, GREEN);
    }
    context.putImageData(image, 0, 0);
    context.scale(ratio, ratio);
    if (this.#points) {
      this.#scaleBar(context, height / ratio);
      if (this.#shown === "after" && this.#view !== "cut") this.#gizmo(context, pose);
      this.#pins(context, pose);
    }
    context.resetTransform();
    this.#say();
    if (this.#points) this.#drawn?.();
  }

  /** Two by two pixels a point; where both colors meet they add up to a bright one. */
  #splat(pixels, width, height, ratio, points, pose, color) {
    const R = times(this.#upright, rotationOf(pose.slice(3)));
    const t = this.#toUpright(pose);
    const [x, y, eye] = this.camera.axes();
    const [cx, cy, cz] = this.camera.center;
    const scale = this.camera.scale * ratio;
    const row = (a) => [0, 1, 2].map((k) => a[0] * R[k] + a[1] * R[3 + k] + a[2] * R[6 + k]);
    const [X, Y, Z] = [row(x), row(y), row(eye)];
    const at = (a) => a[0] * (t[0] - cx) + a[1] * (t[1] - cy) + a[2] * (t[2] - cz);
    const [ox, oy] = [at(x), at(y)];
    const oz = eye[0] * t[0] + eye[1] * t[1] + eye[2] * t[2];
    const [low, high] = this.#view === "cut" ? this.#slab() : [-Infinity, Infinity];
    for (let k = 0; k < points.length; k += 3) {
      const [a, b, c] = [points[k], points[k + 1], points[k + 2]];
      const depth = Z[0] * a + Z[1] * b + Z[2] * c + oz;
      if (depth < low || depth > high) continue;
      const u = (width / 2 + scale * (X[0] * a + X[1] * b + X[2] * c + ox)) | 0;
      const v = (height / 2 - scale * (Y[0] * a + Y[1] * b + Y[2] * c + oy)) | 0;
      if (u < 0 || v < 0 || u >= width - 1 || v >= height - 1) continue;
      const p = v * width + u;
      const q = p + width;
      for (const at of [p, p + 1, q, q + 1])
        pixels[at] = pixels[at] === GROUND || pixels[at] === color ? color : pixels[at] | color;
    }
  }

  /** The slab of a cut along the line of sight [m]. */
  #slab() {
    const middle = Number(this.#height.value) / 100;
    return [middle - 0.1, middle + 0.1];
  }

  #scaleBar(context, height) {
    const steps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20];
    const metres = steps.find((m) => m * this.camera.scale > 60) ?? 50;
    const length = metres * this.camera.scale;
    context.strokeStyle = context.fillStyle = "#e6ebf0";
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(14, height - 20);
    context.lineTo(14, height - 14);
    context.lineTo(14 + length, height - 14);
    context.lineTo(14 + length, height - 20);
    context.stroke();
    context.font = "13px system-ui, sans-serif";
    context.fillText(
      metres < 1 ? `${Math.round(metres * 100)} cm` : `${metres} m`,
      18,
      height - 22,
    );
  }

  #place(p) {
    return this.camera.toScreen(
      this.#toUpright(p),
      this.#canvas.clientWidth,
      this.#canvas.clientHeight,
    );
  }

  /** A disc to move the second place by, a ring with a knob to turn it. */
  #gizmo(context, pose) {
    const [u, v] = this.#place(pose);
    context.strokeStyle = "#ffffff";
    context.fillStyle = "rgb(47 214 127 / 35%)";
    context.lineWidth = 2;
    context.beginPath();
    context.arc(u, v, HANDLE_PX / 2, 0, 7);
    context.fill();
    context.stroke();
    context.beginPath();
    context.moveTo(u - 17, v);
    context.lineTo(u + 17, v);
    context.moveTo(u, v - 17);
    context.lineTo(u, v + 17);
    context.stroke();
    context.setLineDash([6, 5]);
    context.beginPath();
    context.arc(u, v, RING_PX, 0, 7);
    context.stroke();
    context.setLineDash([]);
    context.fillStyle = "#ffffff";
    context.beginPath();
    context.arc(u + RING_PX, v, 7, 0, 7);
    context.fill();
  }

  #pins(context, pose) {
    if (!this.#picking) return;
    const pins = [
      ...this.#picking.i.map((p, k) => [p, k, "#ff8f86"]),
      ...this.#picking.j.map((p, k) => [apply(pose, p), k, "#7bf0b3"]),
    ];
    context.font = "bold 14px system-ui, sans-serif";
    for (const [p, k, color] of pins) {
      const [u, v] = this.#place(p);
      context.strokeStyle = context.fillStyle = color;
      context.lineWidth = 2;
      context.strokeRect(u - 6, v - 6, 12, 12);
      context.fillText(String(k + 1), u + 9, v - 8);
    }
  }

  #say() {
    const words = [];
    if (this.#view === "cut") {
      const metres = Number(this.#height.value) / 100;
      this.#cutWords.textContent = `${metres.toFixed(2)} m`;
      words.push(`Cut of 20 cm at ${metres.toFixed(2)} m`);
    }
    if (this.#picking) {
      const second = this.#picking.i.length > this.#picking.j.length;
      words.push(
        `Pick point ${this.#picking.j.length + 1} of 3 in the ${second ? "second (green)" : "first (red)"} place`,
      );
    }
    this.#over.textContent = this.#points ? words.join(" · ") : "";
  }

  // -- pointer, touch, wheel

  #listen() {
    const canvas = this.#canvas;
    canvas.addEventListener("pointerdown", (event) => this.#down(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    for (const name of ["pointerup", "pointercancel"])
      canvas.addEventListener(name, (event) => {
        this.#pointers.delete(event.pointerId);
        this.#drag = null;
      });
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.zoom(Math.exp(-event.deltaY / 500), event.offsetX, event.offsetY);
      },
      { passive: false },
    );
  }

  zoom(factor, x = this.#canvas.clientWidth / 2, y = this.#canvas.clientHeight / 2) {
    const [dx, dy] = [x - this.#canvas.clientWidth / 2, y - this.#canvas.clientHeight / 2];
    this.camera.pan(-dx, -dy);
    this.camera.scale = Math.min(2000, Math.max(2, this.camera.scale * factor));
    this.camera.pan(dx, dy);
    this.#draw();
  }

  #down(event) {
    if (!this.#points) return;
    this.#canvas.setPointerCapture(event.pointerId);
    this.#pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    if (this.#picking) this.#take(event.offsetX, event.offsetY);
    else this.#drag = this.#pointers.size > 1 ? "pinch" : this.#grabbed(event);
  }

  #grabbed(event) {
    if (this.#shown !== "after" || this.#view === "cut")
      return this.#view === "free" ? "orbit" : "pan";
    const [u, v] = this.#place(this.pose);
    const d = Math.hypot(event.offsetX - u, event.offsetY - v);
    if (d < HANDLE_PX) return "lay";
    if (Math.abs(d - RING_PX) < 14) return "turn";
    return this.#view === "free" && !event.shiftKey ? "orbit" : "pan";
  }

  #move(event) {
    const before = this.#pointers.get(event.pointerId);
    if (!before || !this.#drag) return;
    const now = [event.offsetX, event.offsetY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    if (this.#drag === "pinch") this.#pinch(event.pointerId, now);
    this.#pointers.set(event.pointerId, now);
    if (this.#drag === "pan") this.camera.pan(dx, dy);
    if (this.#drag === "orbit") this.#orbit(dx, dy);
    if (this.#drag === "lay") this.nudge(dx / this.camera.scale, -dy / this.camera.scale);
    if (this.#drag === "turn") this.#turnBy(before, now);
    this.#draw();
  }

  #orbit(dx, dy) {
    this.camera.yaw -= dx / 150;
    this.camera.pitch = Math.min(Math.PI / 2, Math.max(-0.2, this.camera.pitch + dy / 150));
  }

  #turnBy(before, now) {
    const [u, v] = this.#place(this.pose);
    const angle = (p) => Math.atan2(v - p[1], p[0] - u);
    this.nudge(0, 0, angle(now) - angle(before));
  }

  #pinch(id, now) {
    const other = [...this.#pointers].find(([key]) => key !== id)?.[1];
    if (!other) return;
    const before = this.#pointers.get(id);
    const length = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
    this.zoom(length(now) / length(before), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
    this.camera.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
  }

  /** The point of the place in turn that lies nearest under the pointer, the nearest to the eye first. */
  #take(x, y) {
    const picked = this.#picking;
    const first = picked.i.length === picked.j.length;
    const points = first ? this.#points.i : this.#points.j;
    const pose = first ? IDENTITY : this.pose;
    let best = null;
    let nearest = PICK_PX;
    for (let k = 0; k < points.length; k += 3) {
      const p = [points[k], points[k + 1], points[k + 2]];
      const [u, v] = this.#place(apply(pose, p));
      const d = Math.hypot(u - x, v - y);
      if (d < nearest) [nearest, best] = [d, p];
    }
    if (best) (first ? picked.i : picked.j).push(best);
    if (picked.j.length === 3) {
      this.#picking = null;
      picked.done({ p_i: picked.i, p_j: picked.j });
    }
    this.#draw();
  }
}

customElements.define("pair-view", PairView);
