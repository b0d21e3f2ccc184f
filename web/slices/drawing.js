// What the page of slices shows, and how it is drawn; each part from the state of the page.

import { idHere, leftMap } from "../shared/address.js";
import { mapUrl } from "../shared/api.js";
import { approvalFact } from "../shared/approval_lines.js";
import { byId, html, nothing, render, targetOf } from "../shared/dom.js";
import { count } from "../shared/format.js";
import { frameText } from "../shared/frame.js";
import { t, written } from "../shared/texts.js";
import { noBrush } from "./brush.js";
import { cutText } from "./captions.js";
import { besideFields, controls } from "./controls.js";
import { noLiking } from "./liking.js";
import { legend } from "./legend.js";
import { SURFACES, parse } from "./state.js";
import { mapQuery } from "./to_map.js";
import { SliceView } from "./view.js";

/**
 * @import {PickView, SliceFacts, SliceImageView} from "../shared/http_types"
 * @typedef {import("./controls.js").Act & {step: (times: number) => void, showAll: () => void,
 *   measure: () => void, showHelp: () => void}} Act
 */

export const first = new SliceView();
export const second = new SliceView();
second.className = "second";
const LATE_MS = 2000; // after this time the page says how long it has waited
const wait = { text: "", began: 0, timer: 0 };

/**
 * What the page shows.
 * @typedef {typeof page} SlicePageState
 */
export const page = {
  state: parse(location.search),
  facts: /** @type {SliceFacts | null} */ (null),
  shown: /** @type {SliceImageView | null} */ (null),
  caption: "", // of the first slice
  secondCaption: "",
  sequence: 0, // number of the newest request of an image
  stretch: /** @type {number[][]} */ ([]), // positions of the walk that are marked [m]
  measuring: false,
  measured: /** @type {PickView[]} */ ([]), // at most two points
  picked: /** @type {PickView | null} */ (null),
  outline: /** @type {import("./findings.js").Outline} */ ({ corners: [], drawing: false }),
  brush: noBrush(), // what is painted gets another class
  like: noLiking(), // a thing, and all that are like it
  known: /** @type {import("./ellipses.js").KnownPlace[]} */ ([]), // measured surveyed points
  reading: "", // what is known of the picked points
  mode: /** @type {"split" | "swipe"} */ ("split"),
  swipe: 50, // where the second slice begins [%]
};

/** Draws all but the images of the slices. */
export function drawPage(/** @type {Act} */ act) {
  const { state, facts } = page;
  render(controls(state, facts, act), byId("controls"));
  drawTools(act);
  drawViews();
  drawUnder(act);
}

/** Says what the page waits for; empty = for nothing more. */
export function waitFor(/** @type {string} */ text) {
  clearInterval(wait.timer);
  const timer = text ? setInterval(drawViews, LATE_MS / 2) : 0;
  Object.assign(wait, { text, timer, began: performance.now() });
  document.body.classList.toggle("drawing", text !== "");
  drawViews();
}

/** What the page waits for: at once where it shows nothing, over an image when it is late. */
function waiting() {
  const { text, began } = wait;
  const ms = performance.now() - began;
  if (!text || (page.shown && ms < LATE_MS)) return nothing;
  return html`<p class="waiting">
    <span role="status">${text}</span
    >${ms < LATE_MS ? nothing : html` <span>${Math.floor(ms / 1000)} s</span>`}
  </p>`;
}

function drawTools(/** @type {Act} */ act) {
  const { step, showAll, measure, showHelp } = act;
  const button = (
    /** @type {string} */ text,
    /** @type {() => void} */ action,
    /** @type {string} */ title,
    label = title.split("  ")[0],
  ) =>
    html`<button type="button" title=${title} aria-label=${label} @click=${action}>
      ${text}
    </button>`;
  const mode = (/** @type {string} */ text, /** @type {"split" | "swipe"} */ value) =>
    html`<button
      type="button"
      id="mode-${value}"
      @click=${() => {
        page.mode = value;
        drawPage(act);
      }}
    >
      ${text}
    </button>`;
  render(
    html`<span class="moves"
        >${button(
          t("step-back-short"),
          () => step(-1),
          `${t("step-back-title")}  [`,
          t("step-back"),
        )}${button(
          t("step-forward-short"),
          () => step(1),
          `${t("step-forward-title")}  ]`,
          t("step-forward"),
        )}${button("−", () => first.zoom(1.5), t("zoom-out"))}${button(
          "+",
          () => first.zoom(1 / 1.5),
          t("zoom-in"),
        )}<button type="button" title="${t("whole-slice")}  0" @click=${showAll}>${t("all")}</button
        ><button
          type="button"
          id="measure"
          aria-pressed=${page.measuring}
          title="${t("measure-title")}  M"
          @click=${measure}
        >
          ${t("measure")}
        </button></span
      ><span class="beside"
        >${besideFields(page.state, page.facts, act)}${mode(t("split"), "split")}${mode(
          t("swipe"),
          "swipe",
        )}</span
      >${button("?", showHelp, `${t("keys")}  ?`, t("help"))}`,
    byId("tools"),
  );
}

function drawViews() {
  const { state, mode, swipe, caption, secondCaption } = page;
  const two = Boolean(state.beside || state.besideColor);
  const swiping = two && mode === "swipe";
  const views = byId("views");
  views.classList.toggle("two", two);
  views.classList.toggle("swiping", swiping);
  second.hidden = !two;
  second.style.clipPath = swiping ? `inset(0 0 0 ${swipe}%)` : "";
  const slide = (/** @type {Event} */ event) => {
    page.swipe = Number(targetOf(event).value);
    drawViews();
  };
  render(
    html`<div class="one">
        ${first} ${waiting()}
        <p class="caption">${caption}</p>
      </div>
      <div class="one other">
        ${second}
        <p class="caption second" ?hidden=${!two}>${secondCaption}</p>
      </div>
      <input
        class="swipe"
        type="range"
        min="0"
        max="100"
        aria-label=${t("swipe-between")}
        ?hidden=${!swiping}
        .value=${String(swipe)}
        @input=${slide}
      />`,
    views,
  );
}

function drawUnder(/** @type {Act} */ { change }) {
  const { state, facts, shown, reading } = page;
  const setRange = (/** @type {number | null} */ lo, /** @type {number | null} */ hi) =>
    change({ lo, hi }, { keep: true });
  render(
    html`<div id="legend">${shown && facts ? legend(state, shown, facts, setRange) : nothing}</div>
      <div class="facing">${shown && facts ? facing(shown, facts) : nothing}</div>
      <p class="readout" role="status">${reading}</p>`,
    byId("under"),
  );
}

/**
 * What is cut, in a row of facts.
 * @param {SliceImageView} shown
 * @param {SliceFacts} facts
 */
function facing({ position, points, surface }, { strays, frame, approval }) {
  const { t: thickness } = page.state;
  return html`<strong>${cutText(position)}</strong
    ><span>${t("cm-thick", { cm: written(String(Number((thickness * 100).toFixed(1)))) })}</span
    ><span>${t("points-on", { points: count(points), surface: SURFACES[surface] })}</span>
    ${
      strays && surface !== "strays"
        ? html`<span>${t("points-left-out", { points: count(strays) })}</span>`
        : nothing
    }
    <span class="frame">${frameText(frame)}</span>${approvalFact(approval)}
    <a href=${mapUrl(idHere()) + mapQuery(page.state, leftMap(idHere()))}>${t("show-in-3d")}</a>`;
}
