// The numbers of a rig as a table, and its versions and projects as lists.

import { projectUrl, rigFileUrl } from "../shared/api.js";
import { html, nothing } from "../shared/dom.js";
import { when } from "../shared/format.js";
import { short } from "./rig_math.js";
import { asWritten, t, wordOf } from "../shared/texts.js";

/**
 * @import {RigUse, RigVersion} from "../shared/http_types"
 * @import {Rig, RigSensor} from "./rig_math.js"
 */

export const COLORS = 4; // of sensors in the drawing
const POSITION = `${t("position")} [cm]`;
const ROTATION = `${t("rotation")} [°]`;
const CLOCK = `${t("clock")} [ms]`;
const PORT = t("port");
const HEADS = [t("sensor"), t("model"), POSITION, ROTATION, CLOCK, PORT, t("address")];
const NUMBERS = new Set([CLOCK, PORT]);
/** @type {Record<string, string[]>} */
const PARTS = { [POSITION]: ["x", "y", "z"], [ROTATION]: ["roll", "pitch", "yaw"] };

const cell = (/** @type {string} */ text) =>
  html`<td class="number">${text.replace("-", "−")}</td>`;
/**
 * @param {number} value
 * @param {number} digits
 */
const figure = (value, digits) => cell(asWritten(Number(short(value, digits))));
/**
 * @param {number[]} values
 * @param {number} digits
 */
const triple = (values, digits) => values.map((value) => figure(value, digits));
const centimeters = (/** @type {number[]} */ values) =>
  triple(
    values.map((value) => 100 * value),
    2,
  );
const milliseconds = (/** @type {number} */ seconds) => figure(1e3 * seconds, 3);
const none = (/** @type {number} */ count) => Array.from({ length: count }, () => cell("–"));

export const swatch = (/** @type {string} */ role) =>
  html`<span class="swatch" aria-hidden="true" .style=${`background: var(--${role})`}></span>`;

/**
 * @param {string} role
 * @param {string} name
 * @param {...unknown} cells
 */
const row = (role, name, ...cells) =>
  html`<tr>
    <th scope="row">${swatch(role)} ${name}</th>
    ${cells}
  </tr>`;

/**
 * @param {RigSensor} sensor
 * @param {number} k
 */
const sensorRow = (sensor, k) =>
  row(
    sensor.enabled ? `sensor-${k % COLORS}` : "disabled",
    sensor.enabled ? sensor.name : t("disabled-sensor", { name: sensor.name }),
    html`<td>${sensor.kind === "lidar" ? sensor.model : wordOf("kind", sensor.kind)}</td>`,
    ...centimeters(sensor.xyz_m),
    ...triple(sensor.rpy_deg, 4),
    milliseconds(sensor.time_offset_s),
    cell(String(sensor.port)),
    html`<td>${sensor.address || t("any")}</td>`,
  );

/** The table of all sensors. */
export function numbersTable(/** @type {Rig} */ { sensors, imu, gnss }) {
  const upper = HEADS.map((text) =>
    PARTS[text]
      ? html`<th scope="colgroup" colspan="3">${text}</th>`
      : html`<th scope="col" rowspan="2" class=${NUMBERS.has(text) ? "number" : ""}>${text}</th>`,
  );
  const lower = Object.values(PARTS).flatMap((names) =>
    names.map((text) => html`<th scope="col" class="number">${text}</th>`),
  );
  return html`<table class="numbers">
    <thead>
      <tr>
        ${upper}
      </tr>
      <tr>
        ${lower}
      </tr>
    </thead>
    <tbody>
      ${sensors.map(sensorRow)}${row(
        "imu",
        t("imu"),
        html`<td>–</td>`,
        ...centimeters(imu.xyz_m),
        ...triple(imu.rpy_deg, 4),
        milliseconds(imu.time_offset_s),
        cell(imu.port ? String(imu.port) : t("none")),
        html`<td>${t("any")}</td>`,
      )}${row(
        "gnss",
        t("gnss-antenna"),
        html`<td>–</td>`,
        ...centimeters(gnss.lever_arm_m),
        ...none(3),
        milliseconds(gnss.time_offset_s),
        cell(gnss.port ? String(gnss.port) : t("none")),
        html`<td>${gnss.serial || t("any")}</td>`,
      )}
    </tbody>
  </table>`;
}

const STEEP_DEG = 85;

/** What to know about the angles of a rig; empty = nothing. */
export const angleHint = (/** @type {Rig} */ { sensors, imu }) =>
  [...sensors, imu].some(({ rpy_deg: [, pitch] }) => Math.abs(pitch) > STEEP_DEG)
    ? t("steep-pitch")
    : "";

/**
 * The versions of a rig, the newest first.
 * @param {string} id
 * @param {RigVersion[]} versions
 * @param {number} shown
 * @param {(number: number) => void} show
 */
export function versionList(id, versions, shown, show) {
  const item = (/** @type {RigVersion} */ { number, who, when: time, problem, note, evidence }) =>
    html`<li aria-current=${number === shown ? "true" : nothing}>
      <div class="title-row">
        <b>${t("version", { version: String(number) })}</b>
        <div class="buttons">
          ${
            number === shown
              ? html`<span class="quiet">${t("shown")}</span>`
              : html`<button type="button" @click=${() => show(number)}>${t("show-it")}</button>`
          }
          <a class="button" href=${rigFileUrl(id, number)}>TOML</a>
        </div>
      </div>
      <p class="quiet">${[who, time && when(time)].filter(Boolean).join(", ")}</p>
      ${problem ? html`<p class="error">${problem}</p>` : nothing}
      ${note ? html`<p class="note">${note}</p>` : nothing}
      ${
        evidence
          ? html`<details>
              <summary>${t("evidence")}</summary>
              <p class="note">${evidence}</p>
            </details>`
          : nothing
      }
    </li>`;
  return html`<ul class="versions">
    ${versions.map(item)}
  </ul>`;
}

/** The projects that used a rig. */
export function useList(/** @type {RigUse[]} */ uses) {
  if (!uses.length) return html`<p class="quiet">${t("no-use")}</p>`;
  const item = (/** @type {RigUse} */ { project, name, version }) =>
    html`<li>
      <a href=${projectUrl(project)}>${name}</a
      >${version ? html`<small>${t("version-brief", { version })}</small>` : nothing}
    </li>`;
  return html`<ul class="files">
    ${uses.map(item)}
  </ul>`;
}
