// <pair-view>: the points of two places laid over each other, first blue, second orange, or their
// difference.
// Events: "laid" (the person moved the second place), "reach" (another number of multiframes).

import { make } from "../shared/dom.js";
import { drawScaleBar } from "../shared/scale_bar.js";
import { HALO, INK, drawBoth, drawDifference, drawHandle, drawPicked, pointImage } from "./draw.js";
import { Camera, IDENTITY, nudged, rotationOf, transposed, turn } from "./math.js";
import { Picking } from "./picking.js";
import { listenToPointer } from "./pointer.js";

const VIEWS = { above: "Above", side: "Side", free: "Free", cut: "Cut" };
const SHOWN = { odometry: "Odometry", predicted: "Graph", after: "Aligned" };
const HALF_CUT_M = 0.1;
const EVERYTHING = [-Infinity, Infinity];

export class PairView extends HTMLElement {
  camera = new Camera();
  #view = "above";
  #shown = "after";
  #difference = false;
  #agreeing = 0; // fraction of the pixels, in the difference
  #points = null;
  #poses = { odometry: IDENTITY, predicted: IDENTITY, after: IDENTITY };
  #upright = [1, 0, 0, 0, 1, 0, 0, 0, 1];
  /** @type {Picking | null} */
  #picking = null;
  #onPicked = null;
  #requested = false; // a frame is requested
  #drawn = null; // to call once the points are on the screen
  #canvas = make("canvas", { tabIndex: 0, role: "img", ariaLabel: "Points of both places" });
  #over = make("p", { className: "view-words" });
  #empty = make("p", { className: "view-empty" });
  #height = make("input", {
    type: "range",
    min: -300,
    max: 300,
    value: 0,
    ariaLabel: "Position of the cut",
  });
  #upwards = make("input", { type: "checkbox" });
  #cutText = make("output");
  #cut = make("div", { className: "cut", hidden: true });
  #reach = make("select", { ariaLabel: "Multiframes shown around each place" });
  #buttons = {};
  #differs = make(
    "button",
    { type: "button", onclick: () => this.toggleDifference() },
    "Difference",
  );

  connectedCallback() {
    const reaches = [0, 2, 5, 10].map((n) =>
      make("option", { value: n }, n ? `± ${n} multiframes` : "Nodes only"),
    );
    this.#reach.append(...reaches);
    this.#reach.addEventListener("change", () => this.#emit("reach"));
    this.#cut.append(
      make("label", {}, make("span", {}, "Position of the cut"), this.#height, this.#cutText),
      make("label", { className: "check" }, this.#upwards, make("span", {}, "Upright cut")),
    );
    this.#height.addEventListener("input", () => this.draw());
    this.#upwards.addEventListener("change", () => this.show(this.#view));
    const views = this.#group("View", VIEWS, (key) => this.show(key));
    const shown = this.#group("Show", SHOWN, (key) => this.compare(key));
    const stage = [this.#canvas, this.#over, this.#legend(), this.#empty];
    const ofPlaces = this.#names ? [] : [shown, this.#reach];
    this.replaceChildren(
      make("div", { className: "view-tools" }, views, this.#differs, ...ofPlaces),
      make("div", { className: "view-stage" }, ...stage),
      this.#cut,
    );
    new ResizeObserver(() => this.draw()).observe(this.#canvas);
    listenToPointer(this.#canvas, this);
    this.show("above");
    this.compare("after");
    this.#drawDifferenceButton();
  }

  /** Buttons of which one is pressed. */
  #group(label, choices, action) {
    const buttons = Object.entries(choices).map(([key, text]) => {
      this.#buttons[key] = make("button", { type: "button", onclick: () => action(key) }, text);
      return this.#buttons[key];
    });
    return make("div", { role: "group", ariaLabel: label, className: "segmented" }, ...buttons);
  }

  /** Names of two clouds that are no places of a walk, if the page gave data-first, -second. */
  get #names() {
    const { first, second } = this.dataset;
    return first === undefined ? null : [first, second];
  }

  /** Multiframes shown around each place. */
  get reach() {
    return Number(this.#reach.value);
  }

  /**
   * Shows a pair: points of both, poses {odometry, predicted, after}, rotation to upright as a
   * quaternion. The promise resolves once the points are drawn; never if another pair is set
   * before.
   */
  set(points, poses, upright) {
    this.#points = points;
    this.#poses = poses;
    this.#upright = rotationOf(upright);
    this.#picking = null;
    this.#empty.textContent = "";
    this.camera.fit(points.i, Math.min(this.#canvas.clientWidth, this.#canvas.clientHeight));
    this.draw();
    return new Promise((resolve) => (this.#drawn = resolve));
  }

  /** Shows a text instead of points. */
  clear(text) {
    this.#points = this.#drawn = null;
    this.#empty.textContent = text;
    this.draw();
  }

  /** Pose of the second place in the first, x y z qx qy qz qw. */
  get pose() {
    return this.#poses.after;
  }

  set pose(pose) {
    this.#poses = { ...this.#poses, after: pose };
    this.compare("after");
  }

  /** Position on the canvas of a point in the frame of the first place [px]. */
  on(p) {
    const { clientWidth, clientHeight } = this.#canvas;
    return this.camera.toScreen(turn(this.#upright, p), clientWidth, clientHeight);
  }

  show(view) {
    this.#view = view;
    const upright = view === "side" || (view === "cut" && this.#upwards.checked);
    if (view === "free") [this.camera.yaw, this.camera.pitch] = [0.6, 0.6];
    else [this.camera.yaw, this.camera.pitch] = [0, upright ? 0 : Math.PI / 2];
    this.#cut.hidden = view !== "cut";
    for (const key of Object.keys(VIEWS)) this.#buttons[key].ariaPressed = String(key === view);
    this.draw();
  }

  compare(shown) {
    this.#shown = shown;
    for (const key of Object.keys(SHOWN)) this.#buttons[key].ariaPressed = String(key === shown);
    this.draw();
  }

  /** The next of odometry, graph, aligned. */
  compareNext() {
    const keys = Object.keys(SHOWN);
    this.compare(keys[(keys.indexOf(this.#shown) + 1) % keys.length]);
  }

  /** Shows both places over each other, or in color only what one of them has alone. */
  toggleDifference() {
    this.#difference = !this.#difference;
    this.#drawDifferenceButton();
    this.draw();
  }

  #drawDifferenceButton() {
    this.#differs.ariaPressed = String(this.#difference);
    this.classList.toggle("difference", this.#difference);
  }

  viewNext() {
    const keys = Object.keys(VIEWS);
    this.show(keys[(keys.indexOf(this.#view) + 1) % keys.length]);
  }

  moveCut(steps) {
    if (this.#view !== "cut") this.show("cut");
    this.#height.value = Number(this.#height.value) + 5 * steps;
    this.draw();
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

  /** Starts picking the same three points in both places; `done({p_i, p_j})`. */
  pick(done) {
    const [first, second] = this.#names ?? [];
    this.#picking = new Picking(first && [`${first} (blue)`, `${second} (orange)`]);
    this.#onPicked = done;
    this.compare("after");
    this.#canvas.focus();
  }

  get hasPoints() {
    return this.#points !== null;
  }

  get isFree() {
    return this.#view === "free";
  }

  /** Whether the second place can be moved by its handle. */
  get hasHandle() {
    return this.#shown === "after" && this.#view !== "cut";
  }

  get isPicking() {
    return this.#picking !== null;
  }

  stopPicking() {
    this.#picking = null;
    this.draw();
  }

  #legend() {
    const key = (name, text) => make("span", { className: `key ${name}` }, text);
    const [first, second] = this.#names ?? ["first", "second"];
    const keys = [key("first", first), key("second", second), key("both", "both")];
    return make("div", { className: "view-key" }, ...keys);
  }

  #emit(name) {
    this.dispatchEvent(new CustomEvent(name, { bubbles: true }));
  }

  #lay(pose) {
    this.pose = pose;
    this.#emit("laid");
  }

  #toBody(v) {
    return turn(transposed(this.#upright), v);
  }

  // -- drawing

  draw() {
    if (this.#requested) return;
    this.#requested = true;
    requestAnimationFrame(() => {
      this.#requested = false;
      this.#paint();
    });
  }

  #paint() {
    const image = pointImage(this.#canvas);
    if (!image) return;
    const { context, ratio } = image;
    const pose = this.#poses[this.#shown];
    const slab = this.#view === "cut" ? this.#slab() : EVERYTHING;
    const projection = { upright: this.#upright, camera: this.camera, slab };
    if (this.#points) {
      const poses = { i: IDENTITY, j: pose };
      if (this.#difference) this.#agreeing = drawDifference(image, this.#points, poses, projection);
      else drawBoth(image, this.#points, poses, projection);
    }
    image.show();
    context.scale(ratio, ratio);
    if (this.#points) {
      const bottom = image.height / ratio - 14;
      drawScaleBar(context, this.camera.scale, { left: 14, bottom, ink: INK, halo: HALO });
      if (this.hasHandle) drawHandle(context, this.on(pose));
      if (this.#picking) drawPicked(context, this.#picking, pose, (p) => this.on(p));
    }
    context.resetTransform();
    this.#describe();
    if (this.#points) this.#drawn?.();
  }

  /** The range of a cut along the line of sight [m]. */
  #slab() {
    const middle = Number(this.#height.value) / 100;
    return [middle - HALF_CUT_M, middle + HALF_CUT_M];
  }

  #describe() {
    const texts = [];
    if (this.#view === "cut") {
      const at = `${(Number(this.#height.value) / 100).toFixed(2)} m`;
      this.#cutText.textContent = at;
      texts.push(`Cut of 20 cm at ${at}`);
    }
    if (this.#difference)
      texts.push(`${Math.round(100 * this.#agreeing)} % of what is drawn agrees within 5 cm`);
    if (this.#picking) texts.push(this.#picking.text);
    this.#over.textContent = this.#points ? texts.join(" · ") : "";
  }

  zoom(factor, x = this.#canvas.clientWidth / 2, y = this.#canvas.clientHeight / 2) {
    const [dx, dy] = [x - this.#canvas.clientWidth / 2, y - this.#canvas.clientHeight / 2];
    this.camera.pan(-dx, -dy);
    this.camera.scale = Math.min(2000, Math.max(2, this.camera.scale * factor));
    this.camera.pan(dx, dy);
    this.draw();
  }

  /** Picks a point of the places by turns; after the last one reports all. */
  pickAt(at) {
    const [low, high] = this.#view === "cut" ? this.#slab() : EVERYTHING;
    const eye = this.camera.axes()[2];
    const toScreen = (p) => {
      const [x, y, z] = turn(this.#upright, p);
      const depth = eye[0] * x + eye[1] * y + eye[2] * z;
      return depth < low || depth > high ? null : this.on(p);
    };
    this.#picking.pick(at, this.#points, this.pose, toScreen);
    if (this.#picking.isDone) {
      const { i: p_i, j: p_j } = this.#picking;
      this.#picking = null;
      this.#onPicked({ p_i, p_j });
    }
    this.draw();
  }
}

customElements.define("pair-view", PairView);
