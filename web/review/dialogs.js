// Dialogs of the review: the keys, and a loop closure between any two multiframes.

import { closeButton, openDialog } from "../shared/dialog.js";
import { html, messagePlace, render, say, targetOf, within } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { keys, seconds } from "./captions.js";
import { FIRST_CSS, SECOND_CSS } from "./draw.js";

/** @import {TrajectoryNodes} from "../shared/http_types" */

const SIZE_PX = { width: 640, height: 400 };
const CAPTIONS = ["first-multiframe", "second-multiframe"];

export function showKeys() {
  const rows = keys().map(
    ([key, text]) =>
      html`<tr>
        <th scope="row"><kbd>${key}</kbd></th>
        <td>${text}</td>
      </tr>`,
  );
  const table = html`<table>
      <tbody>
        ${rows}
      </tbody>
    </table>
    ${closeButton(t("close"))}`;
  openDialog(t("keys"), table).classList.add("wide");
}

/**
 * Asks for two multiframes by sliders or on the plan of the walk; `look([frame_i, frame_j])`.
 * @param {TrajectoryNodes} walk
 * @param {[number, number] | undefined} chosen
 * @param {(pair: [number, number]) => unknown} look
 */
export function askForFrames(walk, chosen, look) {
  const most = walk.frames.length - 1;
  const nodeOf = (/** @type {number} */ frame) =>
    Math.max(
      0,
      walk.frames.findIndex((one) => one >= frame),
    );
  const state = { nodes: chosen ? chosen.map(nodeOf) : [0, most], active: 0 };
  const dialog = openDialog(t("add-loop-closure"), html`<form></form>`);
  const form = within(dialog, "form", HTMLFormElement);
  const put = (/** @type {number} */ k, /** @type {number} */ node) => {
    state.nodes[k] = node;
    draw();
  };
  const slider = (/** @type {string} */ caption, /** @type {number} */ k) => {
    const node = state.nodes[k] ?? 0;
    return html`<label
      ><span>${caption}</span
      ><input
        type="range"
        min="0"
        max=${most}
        .value=${String(node)}
        @input=${(/** @type {Event} */ event) => put(k, Number(targetOf(event).value))}
        @focus=${() => (state.active = k)}
      /><output
        >${t("at-multiframe", {
          time: seconds(walk.t_s[node] ?? 0),
          frame: String(walk.frames[node]),
        })}</output
      ></label
    >`;
  };
  const onPlan = (/** @type {PointerEvent} */ event) => {
    const { active } = state;
    state.active = 1 - active;
    put(active, plan.nearest(event.offsetX, event.offsetY));
  };
  const submit = (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    const [a = 0, b = 0] = state.nodes.map((node) => walk.frames[node] ?? 0);
    if (a === b) return say(within(form, ".error"), t("same-multiframe"));
    dialog.close();
    look([Math.min(a, b), Math.max(a, b)]);
  };
  const draw = () => {
    render(
      html`<canvas
          class="plan"
          width=${SIZE_PX.width}
          height=${SIZE_PX.height}
          role="img"
          aria-label=${t("walk-from-above")}
          @pointerdown=${onPlan}
        ></canvas>
        ${CAPTIONS.map((id, k) => slider(t(id), k))} ${messagePlace()}
        <div class="buttons">
          ${closeButton()}<button class="primary">${t("look-at-pair")}</button>
        </div>`,
      form,
    );
    plan.draw(state.nodes);
  };
  const plan = planner(walk, () => within(form, "canvas", HTMLCanvasElement));
  form.addEventListener("submit", submit);
  draw();
}

/**
 * The walk from above on a canvas.
 * @param {TrajectoryNodes} walk
 * @param {() => HTMLCanvasElement} canvasOf
 */
function planner(walk, canvasOf) {
  const xs = walk.xyz_m.map((p) => p[0] ?? 0);
  const ys = walk.xyz_m.map((p) => p[1] ?? 0);
  const [left, right, low, high] = [
    Math.min(...xs),
    Math.max(...xs),
    Math.min(...ys),
    Math.max(...ys),
  ];
  const { width, height } = SIZE_PX;
  const scale = Math.min((width - 40) / (right - left || 1), (height - 40) / (high - low || 1));
  /** @returns {[number, number]} */
  const at = (/** @type {number} */ node) => [
    width / 2 + ((xs[node] ?? 0) - (left + right) / 2) * scale,
    height / 2 - ((ys[node] ?? 0) - (low + high) / 2) * scale,
  ];
  return {
    draw(/** @type {number[]} */ nodes) {
      const context = canvasOf().getContext("2d");
      if (!context) return;
      context.fillStyle = "#0f1418";
      context.fillRect(0, 0, width, height);
      context.strokeStyle = "#8fa0ae";
      context.lineWidth = 2;
      context.beginPath();
      xs.forEach((_, node) => context[node ? "lineTo" : "moveTo"](...at(node)));
      context.stroke();
      nodes.forEach((node, k) => {
        context.fillStyle = k ? SECOND_CSS : FIRST_CSS;
        context.beginPath();
        context.arc(...at(node), 9, 0, 7);
        context.fill();
      });
    },
    /** The node nearest to a position on the canvas [px]. */
    nearest(/** @type {number} */ x, /** @type {number} */ y) {
      const { clientWidth, clientHeight } = canvasOf();
      const [u, v] = [(x * width) / clientWidth, (y * height) / clientHeight];
      const far = (/** @type {number} */ node) => Math.hypot(at(node)[0] - u, at(node)[1] - v);
      return xs.reduce((best, _, node) => (far(node) < far(best) ? node : best), 0);
    },
  };
}
