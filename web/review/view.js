// <pair-view>: the points of two places laid over each other, first blue, second orange, or their
// difference.
// Events: "laid" (the person moved the second place), "reach" (another number of multiframes).

import { html, nothing, render, targetOf, within } from "../shared/dom.js";
import { drawScaleBar } from "../shared/scale_bar.js";
import { t, written } from "../shared/texts.js";
import { HALO, INK, drawBoth, drawDifference, drawHandle, drawPicked, pointImage } from "./draw.js";
import { Camera, IDENTITY, nudged, rotationOf, transposed, turn } from "./math.js";
import { Picking } from "./picking.js";
import { listenToPointer } from "./pointer.js";
import { REACHES, SHOWN, VIEWS, after, group, key } from "./view_controls.js";

/**
 * @import {PairPoints} from "./draw.js"
 * @import {Xyz} from "./picking.js"
 * @import {Shown, View} from "./view_controls.js"
 * @typedef {Record<Shown, number[]>} Poses of the second place in the first
 * @typedef {object} ViewState
 * @property {View} view
 * @property {Shown} shown
 * @property {boolean} difference
 * @property {number} cut_cm
 * @property {boolean} upright the cut
 * @property {number} reach multiframes shown around each place
 * @property {string} empty text instead of points
 * @property {string} words over the points
 * @typedef {(picked: {p_i: Xyz[], p_j: Xyz[]}) => unknown} OnPicked
 */

const HALF_CUT_M = 0.1;
const EVERYTHING = [-Infinity, Infinity];

export class PairView extends HTMLElement {
  camera = new Camera();
  /** @type {ViewState} */
  #state = {
    view: "above",
    shown: "after",
    difference: false,
    cut_cm: 0,
    upright: false,
    reach: 0,
    empty: "",
    words: "",
  };
  #agreeing = 0; // fraction of the pixels, in the difference
  /** @type {PairPoints | null} */
  #points = null;
  /** @type {Poses} */
  #poses = { odometry: IDENTITY, predicted: IDENTITY, after: IDENTITY };
  #upright = [1, 0, 0, 0, 1, 0, 0, 0, 1];
  /** @type {Picking | null} */
  #picking = null;
  /** @type {OnPicked | null} */
  #onPicked = null;
  #requested = false; // a frame is requested
  /** @type {(() => void) | null} */
  #drawn = null; // to call once the points are on the screen

  connectedCallback() {
    this.#show({});
    new ResizeObserver(() => this.draw()).observe(this.#canvas);
    listenToPointer(this.#canvas, this);
  }

  get #canvas() {
    return within(this, "canvas", HTMLCanvasElement);
  }

  /** Draws the controls and the points, after something was chosen. */
  #show(/** @type {Partial<ViewState>} */ changes) {
    Object.assign(this.#state, changes);
    this.#drawControls();
    this.draw();
  }

  #drawControls() {
    const { view, shown, difference, cut_cm, upright, empty, words } = this.#state;
    this.classList.toggle("difference", difference);
    const cut = (/** @type {Event} */ event) =>
      this.#show({ cut_cm: Number(targetOf(event).value) });
    const turnUp = (/** @type {Event} */ event) => {
      this.#state.upright = targetOf(event).checked;
      this.show(view);
    };
    render(
      html`<div class="view-tools">
          ${group(t("view"), VIEWS, view, (key) => this.show(key))}
          <button type="button" aria-pressed=${difference} @click=${() => this.toggleDifference()}>
            ${t("difference")}
          </button>
          ${this.#names ? nothing : this.#choicesOfPlaces(shown)}
        </div>
        <div class="view-stage">
          <canvas tabindex="0" role="img" aria-label=${t("points-of-both")}></canvas>
          <p class="view-words">${words}</p>
          ${this.#legend()}
          <p class="view-empty">${empty}</p>
        </div>
        <div class="cut" ?hidden=${view !== "cut"}>
          <label
            ><span>${t("position-of-cut")}</span
            ><input
              type="range"
              min="-300"
              max="300"
              aria-label=${t("position-of-cut")}
              .value=${String(cut_cm)}
              @input=${cut}
            /><output>${written((cut_cm / 100).toFixed(2))} m</output></label
          ><label class="check"
            ><input type="checkbox" .checked=${upright} @change=${turnUp} /><span
              >${t("upright-cut")}</span
            ></label
          >
        </div>`,
      this,
    );
  }

  #choicesOfPlaces(/** @type {Shown} */ shown) {
    const choose = (/** @type {Event} */ event) => {
      this.#state.reach = Number(targetOf(event).value);
      this.#emit("reach");
    };
    return html`${group(t("show-places"), SHOWN, shown, (key) => this.compare(key))}
      <select aria-label=${t("multiframes-around")} @change=${choose}>
        ${REACHES.map(
          (n) =>
            html`<option value=${n}>${n ? t("reach", { count: n }) : t("nodes-only")}</option>`,
        )}
      </select>`;
  }

  /** Names of two clouds that are no places of a walk, if the page gave data-first, -second. */
  get #names() {
    const { first, second } = this.dataset;
    return first === undefined ? null : [first, second];
  }

  /** Multiframes shown around each place. */
  get reach() {
    return this.#state.reach;
  }

  /**
   * Shows a pair: points of both, poses, rotation to upright as a quaternion. The promise resolves
   * once the points are drawn; never if another pair is set before.
   * @param {PairPoints} points
   * @param {Poses} poses
   * @param {number[]} upright
   * @returns {Promise<void>}
   */
  set(points, poses, upright) {
    this.#points = points;
    this.#poses = poses;
    this.#upright = rotationOf(upright);
    this.#picking = null;
    this.camera.fit(points.i, Math.min(this.#canvas.clientWidth, this.#canvas.clientHeight));
    this.#show({ empty: "" });
    return new Promise((resolve) => (this.#drawn = resolve));
  }

  /** Shows a text instead of points. */
  clear(/** @type {string} */ text) {
    this.#points = this.#drawn = null;
    this.#show({ empty: text });
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
  on(/** @type {number[]} */ p) {
    const { clientWidth, clientHeight } = this.#canvas;
    return this.camera.toScreen(turn(this.#upright, p), clientWidth, clientHeight);
  }

  show(/** @type {View} */ view) {
    const upright = view === "side" || (view === "cut" && this.#state.upright);
    if (view === "free") [this.camera.yaw, this.camera.pitch] = [0.6, 0.6];
    else [this.camera.yaw, this.camera.pitch] = [0, upright ? 0 : Math.PI / 2];
    this.#show({ view });
  }

  compare(/** @type {Shown} */ shown) {
    this.#show({ shown });
  }

  /** The next of odometry, graph, aligned. */
  compareNext() {
    this.compare(after(SHOWN, this.#state.shown));
  }

  /** Shows both places over each other, or in color only what one of them has alone. */
  toggleDifference() {
    this.#show({ difference: !this.#state.difference });
  }

  viewNext() {
    this.show(after(VIEWS, this.#state.view));
  }

  moveCut(/** @type {number} */ steps) {
    if (this.#state.view !== "cut") this.show("cut");
    const cut_cm = Math.min(300, Math.max(-300, this.#state.cut_cm + 5 * steps));
    this.#show({ cut_cm });
  }

  /**
   * Moves the second place on the screen [m] and turns it about the line of sight [rad].
   * @param {number} right
   * @param {number} up
   */
  nudge(right, up, angle = 0) {
    const [x, y, eye] = this.camera.axes();
    const shift = x.map((v, k) => v * right + y[k] * up);
    this.#lay(nudged(this.pose, this.#toBody(shift), this.#toBody(eye), angle));
  }

  lift(/** @type {number} */ height) {
    this.#lay(nudged(this.pose, this.#toBody([0, 0, height]), [0, 0, 1], 0));
  }

  /** Starts picking the same three points in both places; `done({p_i, p_j})`. */
  pick(/** @type {OnPicked} */ done) {
    const [first, second] = this.#names ?? [];
    this.#picking = new Picking(
      first ? [t("in-blue", { name: first }), t("in-orange", { name: second ?? "" })] : undefined,
    );
    this.#onPicked = done;
    this.compare("after");
    this.#canvas.focus();
  }

  get hasPoints() {
    return this.#points !== null;
  }

  get isFree() {
    return this.#state.view === "free";
  }

  /** Whether the second place can be moved by its handle. */
  get hasHandle() {
    return this.#state.shown === "after" && this.#state.view !== "cut";
  }

  get isPicking() {
    return this.#picking !== null;
  }

  stopPicking() {
    this.#picking = null;
    this.draw();
  }

  #legend() {
    const [first, second] = this.#names ?? [t("first"), t("second")];
    return html`<div class="view-key">
      ${key("first", first)} ${key("second", second)} ${key("both", t("both"))}
    </div>`;
  }

  #emit(/** @type {string} */ name) {
    this.dispatchEvent(new CustomEvent(name, { bubbles: true }));
  }

  #lay(/** @type {number[]} */ pose) {
    this.pose = pose;
    this.#emit("laid");
  }

  #toBody(/** @type {number[]} */ v) {
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
    const { shown, difference, view } = this.#state;
    const pose = this.#poses[shown];
    const slab = view === "cut" ? this.#slab() : EVERYTHING;
    const projection = { upright: this.#upright, camera: this.camera, slab };
    if (this.#points) {
      const poses = { i: IDENTITY, j: pose };
      if (difference) this.#agreeing = drawDifference(image, this.#points, poses, projection);
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
    const middle = this.#state.cut_cm / 100;
    return [middle - HALF_CUT_M, middle + HALF_CUT_M];
  }

  /** Says over the points what is drawn. */
  #describe() {
    const { view, cut_cm, difference, words: before } = this.#state;
    const agreeing = Math.round(100 * this.#agreeing);
    const texts = [
      view === "cut" ? t("cut-at", { m: written((cut_cm / 100).toFixed(2)) }) : "",
      difference ? t("agreeing", { percent: agreeing }) : "",
      this.#picking?.text ?? "",
    ];
    const words = this.#points ? texts.filter(Boolean).join(" · ") : "";
    if (words === before) return;
    this.#state.words = words;
    this.#drawControls();
  }

  zoom(
    /** @type {number} */ factor,
    x = this.#canvas.clientWidth / 2,
    y = this.#canvas.clientHeight / 2,
  ) {
    const [dx, dy] = [x - this.#canvas.clientWidth / 2, y - this.#canvas.clientHeight / 2];
    this.camera.pan(-dx, -dy);
    this.camera.scale = Math.min(2000, Math.max(2, this.camera.scale * factor));
    this.camera.pan(dx, dy);
    this.draw();
  }

  /** Picks a point of the places by turns; after the last one reports all. */
  pickAt(/** @type {number[]} */ at) {
    if (!this.#picking || !this.#points) return;
    const [low = 0, high = 0] = this.#state.view === "cut" ? this.#slab() : EVERYTHING;
    const eye = this.camera.axes()[2];
    const toScreen = (/** @type {number[]} */ p) => {
      const [x, y, z] = turn(this.#upright, p);
      const depth = eye[0] * x + eye[1] * y + eye[2] * z;
      return depth < low || depth > high ? null : this.on(p);
    };
    this.#picking.pick(at, this.#points, this.pose, toScreen);
    if (this.#picking.isDone) {
      const { i: p_i, j: p_j } = this.#picking;
      this.#picking = null;
      this.#onPicked?.({ p_i, p_j });
    }
    this.draw();
  }
}

customElements.define("pair-view", PairView);
