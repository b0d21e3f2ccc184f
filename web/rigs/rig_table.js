// The numbers of a rig as a table, and its versions and projects as lists.

import { projectUrl, rigFileUrl } from "../shared/api.js";
import { make } from "../shared/dom.js";
import { when } from "../shared/format.js";
import { short } from "./rig_math.js";

export const COLORS = 4; // of sensors in the drawing
const HEADS = ["Sensor", "Model", "Position [cm]", "Rotation [°]", "Clock [ms]", "Port", "Address"];
const NUMBERS = new Set(["Clock [ms]", "Port"]);
const PARTS = { "Position [cm]": ["x", "y", "z"], "Rotation [°]": ["roll", "pitch", "yaw"] };

const cell = (text) => make("td", { className: "number" }, text.replace("-", "−"));
const triple = (values, digits) => values.map((value) => cell(short(value, digits)));
const centimeters = (values) =>
  triple(
    values.map((value) => 100 * value),
    2,
  );
const milliseconds = (seconds) => cell(short(1e3 * seconds, 3));
const none = (count) => Array.from({ length: count }, () => cell("–"));

export const swatch = (role) =>
  make("span", { className: "swatch", ariaHidden: "true", style: `background: var(--${role})` });

const row = (role, name, ...cells) =>
  make("tr", {}, make("th", { scope: "row" }, swatch(role), ` ${name}`), ...cells);

const sensorRow = (sensor, k) =>
  row(
    sensor.enabled ? `sensor-${k % COLORS}` : "disabled",
    sensor.enabled ? sensor.name : `${sensor.name} (disabled)`,
    make("td", {}, sensor.kind === "lidar" ? sensor.model : sensor.kind),
    ...centimeters(sensor.xyz_m),
    ...triple(sensor.rpy_deg, 4),
    milliseconds(sensor.time_offset_s),
    cell(String(sensor.port)),
    make("td", {}, sensor.address || "any"),
  );

/** The table of all sensors. */
export function numbersTable({ sensors, imu, gnss }) {
  const upper = HEADS.map((text) =>
    PARTS[text]
      ? make("th", { scope: "colgroup", colSpan: 3 }, text)
      : make(
          "th",
          { scope: "col", rowSpan: 2, className: NUMBERS.has(text) ? "number" : "" },
          text,
        ),
  );
  const lower = Object.values(PARTS).flatMap((names) =>
    names.map((text) => make("th", { scope: "col", className: "number" }, text)),
  );
  return make(
    "table",
    { className: "numbers" },
    make("thead", {}, make("tr", {}, ...upper), make("tr", {}, ...lower)),
    make(
      "tbody",
      {},
      ...sensors.map(sensorRow),
      row(
        "imu",
        "IMU",
        make("td", {}, "–"),
        ...centimeters(imu.xyz_m),
        ...triple(imu.rpy_deg, 4),
        milliseconds(imu.time_offset_s),
        cell(imu.port ? String(imu.port) : "none"),
        make("td", {}, "any"),
      ),
      row(
        "gnss",
        "GNSS antenna",
        make("td", {}, "–"),
        ...centimeters(gnss.lever_arm_m),
        ...none(3),
        milliseconds(gnss.time_offset_s),
        cell(gnss.port ? String(gnss.port) : "none"),
        make("td", {}, gnss.serial || "any"),
      ),
    ),
  );
}

const STEEP_DEG = 85;

/** What to know about the angles of a rig; empty = nothing. */
export const angleHint = ({ sensors, imu }) =>
  [...sensors, imu].some(({ rpy_deg: [, pitch] }) => Math.abs(pitch) > STEEP_DEG)
    ? "With a pitch near 90°, roll and yaw turn about the same axis: " +
      "at 90° only their difference counts, at −90° their sum."
    : "";

/** The versions of a rig, the newest first; `show(number)` shows one. */
export function versionList(id, versions, shown, show) {
  const item = (version) =>
    make(
      "li",
      version.number === shown ? { ariaCurrent: "true" } : {},
      make(
        "div",
        { className: "title-row" },
        make("b", {}, `Version ${version.number}`),
        make(
          "div",
          { className: "buttons" },
          version.number === shown
            ? make("span", { className: "quiet" }, "shown")
            : make("button", { type: "button", onclick: () => show(version.number) }, "Show"),
          make("a", { className: "button", href: rigFileUrl(id, version.number) }, "TOML"),
        ),
      ),
      make(
        "p",
        { className: "quiet" },
        [version.who, version.when && when(version.when)].filter(Boolean).join(", "),
      ),
      version.problem ? make("p", { className: "error" }, version.problem) : null,
      version.note ? make("p", { className: "note" }, version.note) : null,
      version.evidence
        ? make(
            "details",
            {},
            make("summary", {}, "Evidence of the calibration"),
            make("p", { className: "note" }, version.evidence),
          )
        : null,
    );
  return make("ul", { className: "versions" }, ...versions.map(item));
}

/** The projects that used a rig. */
export function useList(uses) {
  if (!uses.length) return make("p", { className: "quiet" }, "No project of this server yet");
  const item = ({ project, name, version }) =>
    make(
      "li",
      {},
      make("a", { href: projectUrl(project) }, name),
      version ? make("small", {}, `version ${version}`) : null,
    );
  return make("ul", { className: "files" }, ...uses.map(item));
}
