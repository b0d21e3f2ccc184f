// Sensors, disk, batteries and warnings: in brief on the page, all values in a sheet.

import { byId, html, nothing, render } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { chips, lidarRow, linkLost, supplies } from "./captions.js";

/**
 * @import {Message, Phone, Warning} from "./messages"
 * @import {LiveScene} from "./scene.js"
 */

const SHORT_PX = 700;
const NARROW_PX = 600;
/** Kinds of the errors that are shown: their texts without numbers. */
const shown = { errors: /** @type {Set<string>} */ (new Set()) };

/** @returns {Warning} */
const noPoints = () => ({ level: "info", text: t("no-webgl") });

const kindOf = (/** @type {Warning} */ { text }) => text.replace(/\d+/g, "#");

/**
 * Shows sensors and warnings; `battery` is the phone's.
 * @param {{scene: LiveScene, linked: boolean, battery: Phone | null, drawsPoints: boolean}} live
 */
export function drawHealth({ scene, linked, battery, drawsPoints }) {
  const { state, newest } = scene;
  const found = chips(newest, state, battery);
  byId("sensors").hidden = found.length === 0;
  byId("sensors").classList.toggle("old", !linked);
  render(
    found.map(({ text, error }) => html`<span class=${error ? "error" : ""}>${text}</span>`),
    byId("sensors"),
  );
  const warnings = linked
    ? [...(newest.findings ?? []), ...(drawsPoints ? [] : [noPoints()])]
    : [linkLost(state, scene.silentS)];
  drawWarnings(warnings);
  if (byId("health", HTMLDialogElement).open) drawSheet(newest, warnings, battery);
}

const lines = (/** @type {Warning[]} */ warnings) =>
  warnings.map(({ level, text }) => html`<li class=${level}>${text}</li>`);

/** How many warnings there is space for: on a phone one error or two, else one, above the map. */
function spaceFor(/** @type {Warning[]} */ warnings) {
  if (innerWidth >= NARROW_PX) return innerHeight < SHORT_PX ? 2 : 3;
  const errors = warnings.filter(({ level }) => level === "error");
  return Math.min(Math.max(errors.length, 1), 2);
}

function drawWarnings(/** @type {Warning[]} */ warnings) {
  const most = spaceFor(warnings);
  const more = warnings.length - most;
  const others = html`<li class="more">
    <button type="button" @click=${() => byId("sensors").click()}>
      ${t("more-warnings", { count: String(more) })}
    </button>
  </li>`;
  render([lines(warnings.slice(0, most)), more > 0 ? others : nothing], byId("findings"));
  vibrateOnNew(warnings.filter(({ level }) => level === "error"));
}

/** Vibrates for a new error, because the operator does not always look at the phone. */
function vibrateOnNew(/** @type {Warning[]} */ errors) {
  const kinds = new Set(errors.map(kindOf));
  if ([...kinds].some((kind) => !shown.errors.has(kind)) && navigator.userActivation?.hasBeenActive)
    navigator.vibrate?.([120, 80, 120]);
  shown.errors = kinds;
}

/**
 * Opens the sheet.
 * @param {{scene: LiveScene, battery: Phone | null}} live
 */
export function showHealth({ scene, battery }) {
  byId("health", HTMLDialogElement).showModal();
  drawSheet(scene.newest, scene.newest.findings ?? [], battery);
}

/**
 * @param {Message} newest
 * @param {Warning[]} warnings
 * @param {Phone | null} battery
 */
function drawSheet(newest, warnings, battery) {
  render(lines(warnings), byId("all-findings"));
  render(
    (newest.lidars ?? []).map(lidarRow).map(
      ([name, rate, lost, clock]) =>
        html`<tr>
          <th>${name}</th>
          <td class="number">${rate}</td>
          <td class="number">${lost}</td>
          <td>${clock}</td>
        </tr>`,
    ),
    byId("lidars"),
  );
  render(
    supplies(newest, battery).map(
      ([name, value]) =>
        html`<div>
          <dt>${name}</dt>
          <dd>${value}</dd>
        </div>`,
    ),
    byId("supplies"),
  );
}
