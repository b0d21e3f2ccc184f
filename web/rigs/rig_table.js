// The numbers of a rig as a table, and its versions and projects as lists.

import { projectUrl, rigFileUrl } from "../shared/api.js";
import { html, nothing } from "../shared/dom.js";
import { when } from "../shared/format.js";
import { short } from "./rig_math.js";

/**
 * @import {RigUse, RigVersion} from "../shared/http_types"
 * @import {Rig, RigSensor} from "./rig_math.js"
 */

export const COLORS = 4; // of sensors in the drawing
const HEADS = ["Sensor", "Model", "Position [cm]", "Rotation [°]", "Clock [ms]", "Port", "Address"];
const NUMBERS = new Set(["Clock [ms]", "Port"]);
/** @type {Record<string, string[]>} */
const PARTS = { "Position [cm]": ["x", "y", "z"], "Rotation [°]": ["roll", "pitch", "yaw"] };

const cell = (/** @type {string} */ text) =>
  html`<td class="number">${text.replace("-", "−")}</td>`;
/**
 * @param {number[]} values
 * @param {number} digits
 */
const triple = (values, digits) => values.map((value) => cell(short(value, digits)));
const centimeters = (/** @type {number[]} */ values) =>
  triple(
    values.map((value) => 100 * value),
    2,
  );
const milliseconds = (/** @type {number} */ seconds) => cell(short(1e3 * seconds, 3));
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
    sensor.enabled ? sensor.name : `${sensor.name} (disabled)`,
    html`<td>${sensor.kind === "lidar" ? sensor.model : sensor.kind}</td>`,
    ...centimeters(sensor.xyz_m),
    ...triple(sensor.rpy_deg, 4),
    milliseconds(sensor.time_offset_s),
    cell(String(sensor.port)),
    html`<td>${sensor.address || "any"}</td>`,
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
        "IMU",
        html`<td>–</td>`,
        ...centimeters(imu.xyz_m),
        ...triple(imu.rpy_deg, 4),
        milliseconds(imu.time_offset_s),
        cell(imu.port ? String(imu.port) : "none"),
        html`<td>any</td>`,
      )}${row(
        "gnss",
        "GNSS antenna",
        html`<td>–</td>`,
        ...centimeters(gnss.lever_arm_m),
        ...none(3),
        milliseconds(gnss.time_offset_s),
        cell(gnss.port ? String(gnss.port) : "none"),
        html`<td>${gnss.serial || "any"}</td>`,
      )}
    </tbody>
  </table>`;
}

const STEEP_DEG = 85;

/** What to know about the angles of a rig; empty = nothing. */
export const angleHint = (/** @type {Rig} */ { sensors, imu }) =>
  [...sensors, imu].some(({ rpy_deg: [, pitch] }) => Math.abs(pitch) > STEEP_DEG)
    ? "With a pitch near 90°, roll and yaw turn about the same axis: " +
      "at 90° only their difference counts, at −90° their sum."
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
        <b>Version ${number}</b>
        <div class="buttons">
          ${
            number === shown
              ? html`<span class="quiet">shown</span>`
              : html`<button type="button" @click=${() => show(number)}>Show</button>`
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
              <summary>Evidence of the calibration</summary>
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
  if (!uses.length) return html`<p class="quiet">No project of this server yet</p>`;
  const item = (/** @type {RigUse} */ { project, name, version }) =>
    html`<li>
      <a href=${projectUrl(project)}>${name}</a
      >${version ? html`<small>version ${version}</small>` : nothing}
    </li>`;
  return html`<ul class="files">
    ${uses.map(item)}
  </ul>`;
}
