// <rig-form>: the fields of a rig. Each input changes its number only, the others stay exact.

import {
  html,
  messagePlace,
  nothing,
  render,
  repeat,
  say,
  showError,
  targetOf,
  within,
} from "../shared/dom.js";
import { choice, group, labeled, slot } from "./rig_fields.js";
import { short } from "./rig_math.js";
import { t } from "../shared/texts.js";

/**
 * @import {Content} from "../shared/dom.js"
 * @import {Label} from "./rig_fields.js"
 * @import {Rig, RigImu, RigGnss, RigSensor, Triple} from "./rig_math.js"
 * @typedef {{factor: number, digits: number, unit: string, whole?: boolean}} Unit
 */

const CM = { factor: 100, digits: 4, unit: "cm" };
const DEGREES = { factor: 1, digits: 6, unit: "°" };
const MS = { factor: 1e3, digits: 6, unit: "ms" };
const PPM = { factor: 1, digits: 3, unit: "ppm" };
const PLAIN = { factor: 1, digits: 0, unit: "", whole: true };
const DECIMALS = 9; // of a changed number in its unit of the file
const KINDS = { lidar: t("kind-lidar"), profiler: t("kind-profiler"), laser2d: t("kind-laser2d") };
const XYZ = ["x", "y", "z"];
const RPY = ["roll", "pitch", "yaw"];

/** @type {RigSensor} */
const NEW_SENSOR = {
  name: "",
  kind: "lidar",
  model: "VLP-16",
  xyz_m: [0, 0, 0],
  rpy_deg: [0, 0, 0],
  time_offset_s: 0,
  clock_rate_ppm: 0,
  address: "",
  port: 2368,
  topic: "",
  head_topic: "",
  head_rate_deg_s: 0,
  enabled: true,
  serial: "",
  description: "",
  beams: null,
  fields: "",
};

export class RigForm extends HTMLElement {
  /** @type {{content: Rig | null, models: string[], warnings: string[], mayBeSaved: boolean}} */
  #state = { content: null, models: [], warnings: [], mayBeSaved: true };

  /**
   * Shows the fields of a rig; nothing of `content` itself is changed.
   * @param {Rig} content
   * @param {string[]} models
   */
  edit(content, models) {
    const fresh = { content: structuredClone(content), warnings: [], mayBeSaved: true };
    Object.assign(this.#state, fresh, { models });
    render(nothing, this); // what was typed before
    this.#draw();
  }

  get content() {
    if (!this.#state.content) throw new Error("no rig is edited");
    return this.#state.content;
  }

  /** Whether every field has a value of its kind. */
  get isComplete() {
    return within(this, "form", HTMLFormElement).checkValidity();
  }

  /**
   * Shows what the server says of the rig; `problems` are field -> text.
   * @param {{problems: Record<string, string>, warnings: string[]}} said
   */
  complain({ problems, warnings }) {
    Object.assign(this.#state, { warnings, mayBeSaved: Object.keys(problems).length === 0 });
    this.#draw();
    for (const slot of this.querySelectorAll("[data-problem]")) {
      const { problem: field = "" } = /** @type {HTMLElement} */ (slot).dataset;
      const text = problems[field] ?? "";
      if (slot.textContent !== text) slot.textContent = text;
      for (const input of this.querySelectorAll(`[name="${field}"]`))
        if (text) input.setAttribute("aria-invalid", "true");
        else input.removeAttribute("aria-invalid");
    }
  }

  /** Shows an error of saving; null = none. */
  set error(/** @type {unknown} */ error) {
    const message = within(this, "p.error");
    if (error) showError(message, error);
    else say(message, "");
  }

  #draw() {
    const { content, warnings, mayBeSaved } = this.#state;
    if (!content) return;
    const { sensors, imu, gnss } = content;
    const cancel = () => this.dispatchEvent(new CustomEvent("cancelled"));
    render(
      html`<form @submit=${(/** @type {SubmitEvent} */ event) => this.#submit(event)}>
        ${this.#text(content, "name", { label: t("name"), path: "name", required: true })}
        ${repeat(
          sensors,
          (sensor) => sensor,
          (sensor, k) => this.#sensor(sensor, k),
        )}
        <button type="button" @click=${() => this.#add()}>${t("add-sensor")}</button>
        ${this.#imu(imu)} ${this.#gnss(gnss)}
        <label
          ><span>${t("note-why")}</span><input name="note" maxlength="500" autocomplete="off"
        /></label>
        <ul class="warnings" role="status">
          ${warnings.map((text) => html`<li>▲ ${text}</li>`)}
        </ul>
        ${messagePlace()}
        <div class="buttons">
          <button class="primary" ?disabled=${!mayBeSaved}>${t("save-version")}</button
          ><button type="button" @click=${cancel}>${t("cancel")}</button>
        </div>
      </form>`,
      this,
    );
  }

  #submit(/** @type {SubmitEvent} */ event) {
    event.preventDefault();
    const note = within(this, "[name=note]", HTMLInputElement).value.trim();
    this.dispatchEvent(new CustomEvent("saved", { detail: note }));
  }

  #edited() {
    this.dispatchEvent(new CustomEvent("edited"));
  }

  #add() {
    const { sensors } = this.content;
    const ports = sensors.map((sensor) => sensor.port);
    const port = sensors.length ? Math.max(...ports) + 1 : NEW_SENSOR.port;
    sensors.push({ ...structuredClone(NEW_SENSOR), name: `sensor-${sensors.length + 1}`, port });
    this.#draw();
    this.#edited();
  }

  #remove(/** @type {number} */ k) {
    this.content.sensors.splice(k, 1);
    this.#draw();
    this.#edited();
  }

  #imu(/** @type {RigImu} */ imu) {
    return group(t("imu"), [
      this.#text(imu, "sensor", {
        label: t("inside-of"),
        path: "imu.sensor",
        hint: t("inside-of-none"),
      }),
      this.#triple(imu.xyz_m, { label: t("position"), path: "imu.xyz_m" }, XYZ),
      this.#triple(imu.rpy_deg, { label: t("rotation"), path: "imu.rpy_deg" }, RPY),
      this.#numbers(imu, "imu", this.#text(imu, "topic", { label: t("topic"), path: "imu.topic" })),
    ]);
  }

  #gnss(/** @type {RigGnss} */ gnss) {
    return group(t("gnss-antenna"), [
      this.#triple(gnss.lever_arm_m, { label: t("lever-arm"), path: "gnss.lever_arm_m" }, XYZ),
      this.#numbers(gnss, "gnss", [
        this.#text(gnss, "serial", { label: t("serial-line"), path: "gnss.serial" }),
        this.#text(gnss, "topic", { label: t("topic"), path: "gnss.topic" }),
      ]),
    ]);
  }

  /**
   * @param {RigSensor} sensor
   * @param {number} k
   */
  #sensor(sensor, k) {
    const path = `sensors.${k}`;
    const rate = { label: t("clock-rate"), path: `${path}.clock_rate_ppm`, ...PPM };
    const use = (/** @type {Event} */ event) => {
      sensor.enabled = targetOf(event).checked;
      this.#edited();
    };
    return group(sensor.name || t("sensor-number", { number: String(k + 1) }), [
      this.#kind(sensor, path),
      this.#triple(sensor.xyz_m, { label: t("position"), path: `${path}.xyz_m` }, XYZ),
      this.#triple(sensor.rpy_deg, { label: t("rotation"), path: `${path}.rpy_deg` }, RPY),
      this.#numbers(sensor, path, [
        sensor.kind === "lidar" ? this.#number(sensor, "clock_rate_ppm", rate) : nothing,
        this.#text(sensor, "address", {
          label: t("address"),
          path: `${path}.address`,
          hint: t("any"),
        }),
        this.#text(sensor, "topic", {
          label: t("topic"),
          path: `${path}.topic`,
          hint: t("detected"),
        }),
        this.#text(sensor, "serial", { label: t("serial-number"), path: `${path}.serial` }),
        this.#text(sensor, "fields", {
          label: t("columns"),
          path: `${path}.fields`,
          hint: t("known"),
        }),
      ]),
      sensor.kind === "profiler" ? this.#head(sensor, path) : nothing,
      html`<div class="title-row">
        <label class="check"
          ><input type="checkbox" .checked=${sensor.enabled} @change=${use} /><span
            >${t("used-for-map")}</span
          ></label
        >
        ${
          this.content.sensors.length > 1
            ? html`<button type="button" @click=${() => this.#remove(k)}>${t("remove")}</button>`
            : nothing
        }
      </div>`,
    ]);
  }

  /**
   * Name, kind and model of a sensor; its kind decides about other fields.
   * @param {RigSensor} sensor
   * @param {string} path
   */
  #kind(sensor, path) {
    const models = sensor.kind === "lidar" ? this.#state.models : ["generic"];
    const setKind = (/** @type {string} */ kind) => {
      sensor.kind = /** @type {RigSensor["kind"]} */ (kind);
      if (kind !== "lidar") sensor.model = "generic";
      if (kind !== "profiler") Object.assign(sensor, { head_topic: "", head_rate_deg_s: 0 });
      this.#draw();
      this.#edited();
    };
    const setModel = (/** @type {string} */ model) => {
      sensor.model = /** @type {RigSensor["model"]} */ (model);
      this.#edited();
    };
    const known = Object.fromEntries([...models, sensor.model].map((name) => [name, name]));
    return html`<div class="fields">
      ${this.#text(sensor, "name", { label: t("name"), path: `${path}.name`, required: true })}
      ${choice({ label: t("kind"), path: `${path}.kind` }, { ...KINDS }, sensor.kind, setKind)}
      ${choice({ label: t("model"), path: `${path}.model` }, known, sensor.model, setModel)}
    </div>`;
  }

  /**
   * The head that turns a profiler.
   * @param {RigSensor} sensor
   * @param {string} path
   */
  #head(sensor, path) {
    const topic = { label: t("head-topic"), path: `${path}.head_topic` };
    const rate = { label: t("head-rate"), path: `${path}.head_rate_deg_s` };
    return html`<div class="fields">
      ${this.#text(sensor, "head_topic", topic)}
      ${this.#number(sensor, "head_rate_deg_s", { ...rate, ...DEGREES, unit: "°/s" })}
    </div>`;
  }

  /**
   * Clock and port, and what else stands in their row.
   * @param {RigSensor | RigImu | RigGnss} record
   * @param {string} path
   * @param {Content | Content[]} others
   */
  #numbers(record, path, others) {
    const clock = { label: t("clock"), path: `${path}.time_offset_s`, ...MS };
    const port = { label: t("udp-port"), path: `${path}.port`, ...PLAIN };
    return html`<div class="fields">
      ${this.#number(record, "time_offset_s", clock)} ${this.#number(record, "port", port)}
      ${others}
    </div>`;
  }

  /**
   * @template {string} K
   * @param {Record<K, string>} record
   * @param {K} key
   * @param {Label & {hint?: string, required?: boolean}} options
   */
  #text(record, key, { label, path, hint = "", required = false }) {
    const type = (/** @type {Event} */ event) => {
      record[key] = targetOf(event).value.trim();
      this.#edited();
    };
    const input = html`<input
      name=${path}
      placeholder=${hint}
      autocomplete="off"
      spellcheck="false"
      maxlength="200"
      ?required=${required}
      .value=${record[key]}
      @input=${type}
    />`;
    return labeled(label, path, input);
  }

  /**
   * @template {string} K
   * @param {Record<K, number>} record
   * @param {K} key
   * @param {Label & Unit} options
   */
  #number(record, key, { label, path, ...unit }) {
    const set = (/** @type {number} */ value) => (record[key] = value);
    const input = this.#input(path, unit, record[key], set);
    return labeled(unit.unit ? `${label} [${unit.unit}]` : label, path, input);
  }

  /**
   * @param {Triple} values is changed
   * @param {Label} label
   * @param {string[]} parts names of the components
   */
  #triple(values, { label, path }, parts) {
    const unit = parts === RPY ? DEGREES : CM;
    const title = `${label} [${unit.unit}]`;
    return html`<div class="triple" role="group" aria-label=${title}>
      <span class="title">${title}</span>
      ${values.map(
        (value, k) =>
          html`<label
            ><span>${parts[k]}</span>${this.#input(path, unit, value, (set) => (values[k] = set))}
          </label>`,
      )}
      ${slot(path)}
    </div>`;
  }

  /**
   * @param {string} name
   * @param {Unit} unit
   * @param {number} value
   * @param {(value: number) => void} set
   */
  #input(name, { factor, digits, whole = false }, value, set) {
    const type = (/** @type {Event} */ event) => {
      const { valueAsNumber: given, validity } = targetOf(event);
      if (Number.isFinite(given) && validity.valid) set(Number((given / factor).toFixed(DECIMALS)));
      this.#edited();
    };
    return html`<input
      type="number"
      step=${whole ? "1" : "any"}
      inputmode=${whole ? "numeric" : "text" /* a minus is on the keyboard */}
      name=${name}
      required
      .value=${short(value * factor, digits)}
      @input=${type}
    />`;
  }
}

customElements.define("rig-form", RigForm);
