// <rig-form>: the fields of a rig. Each input changes its number only, the others stay exact.

import { make, showError } from "../shared/dom.js";
import { short } from "./rig_math.js";

const CM = { factor: 100, digits: 4, unit: "cm" };
const DEGREES = { factor: 1, digits: 6, unit: "°" };
const MS = { factor: 1e3, digits: 6, unit: "ms" };
const DECIMALS = 9; // of a changed number in its unit of the file
const KINDS = { lidar: "LiDAR", profiler: "Profiler", laser2d: "2-D laser" };
const XYZ = ["x", "y", "z"];
const RPY = ["roll", "pitch", "yaw"];

const NEW_SENSOR = {
  name: "",
  kind: "lidar",
  model: "VLP-16",
  xyz_m: [0, 0, 0],
  rpy_deg: [0, 0, 0],
  time_offset_s: 0,
  address: "",
  port: 2368,
  topic: "",
  head_topic: "",
  head_rate_deg_s: 0,
  enabled: true,
  serial: "",
};

export class RigForm extends HTMLElement {
  #content = null;
  #models = [];
  #note = make("input", { name: "note", maxLength: 500, autocomplete: "off" });
  #save = make("button", { className: "primary" }, "Save as a new version");
  #warnings = make("ul", { className: "warnings", role: "status" });
  #message = make("p", { className: "error", role: "alert" });

  /** Shows the fields of a rig; nothing of `content` itself is changed. */
  edit(content, models) {
    this.#content = structuredClone(content);
    this.#models = models;
    this.#note.value = "";
    this.#message.textContent = "";
    this.#draw();
  }

  get content() {
    return this.#content;
  }

  /** Whether every field has a value of its kind. */
  get isComplete() {
    return this.querySelector("form").checkValidity();
  }

  /** Shows what the server says of the rig; `problems` are field -> text. */
  complain({ problems, warnings }) {
    for (const slot of this.querySelectorAll("[data-problem]")) {
      const field = /** @type {HTMLElement} */ (slot).dataset.problem;
      const text = problems[field] ?? "";
      if (slot.textContent !== text) slot.textContent = text;
      for (const input of this.querySelectorAll(`[name="${field}"]`))
        if (text) input.setAttribute("aria-invalid", "true");
        else input.removeAttribute("aria-invalid");
    }
    this.#warnings.replaceChildren(...warnings.map((text) => make("li", {}, `▲ ${text}`)));
    this.#save.disabled = Object.keys(problems).length > 0;
  }

  /** Shows an error of saving; null = none. */
  set error(error) {
    if (error) showError(this.#message, error);
    else this.#message.textContent = "";
  }

  #draw() {
    const { sensors, imu, gnss } = this.#content;
    const cancel = () => this.dispatchEvent(new CustomEvent("cancelled"));
    this.replaceChildren(
      make(
        "form",
        { onsubmit: (event) => this.#submit(event) },
        this.#text(this.#content, "name", { label: "Name", path: "name", required: true }),
        ...sensors.map((sensor, k) => this.#sensor(sensor, k)),
        make("button", { type: "button", onclick: () => this.#add() }, "Add a sensor"),
        this.#group(
          "IMU",
          this.#triple(imu, "xyz_m", { label: "Position", of: XYZ, path: "imu", ...CM }),
          this.#triple(imu, "rpy_deg", { label: "Rotation", of: RPY, path: "imu", ...DEGREES }),
          this.#numbers(
            imu,
            "imu",
            this.#text(imu, "topic", { label: "Topic", path: "imu.topic" }),
          ),
        ),
        this.#group(
          "GNSS antenna",
          this.#triple(gnss, "lever_arm_m", { label: "Lever arm", of: XYZ, path: "gnss", ...CM }),
          this.#numbers(
            gnss,
            "gnss",
            this.#text(gnss, "serial", { label: "Serial line", path: "gnss.serial" }),
            this.#text(gnss, "topic", { label: "Topic", path: "gnss.topic" }),
          ),
        ),
        make("label", {}, make("span", {}, "Note: what changed and why"), this.#note),
        this.#warnings,
        this.#message,
        make(
          "div",
          { className: "buttons" },
          this.#save,
          make("button", { type: "button", onclick: cancel }, "Cancel"),
        ),
      ),
    );
  }

  #submit(event) {
    event.preventDefault();
    this.dispatchEvent(new CustomEvent("saved", { detail: this.#note.value.trim() }));
  }

  #edited() {
    this.dispatchEvent(new CustomEvent("edited"));
  }

  #add() {
    const sensors = this.#content.sensors;
    const ports = sensors.map((sensor) => sensor.port);
    const port = sensors.length ? Math.max(...ports) + 1 : NEW_SENSOR.port;
    sensors.push({ ...structuredClone(NEW_SENSOR), name: `sensor-${sensors.length + 1}`, port });
    this.#draw();
    this.#edited();
  }

  #remove(k) {
    this.#content.sensors.splice(k, 1);
    this.#draw();
    this.#edited();
  }

  #group(title, ...children) {
    return make("fieldset", {}, make("legend", {}, title), ...children);
  }

  #sensor(sensor, k) {
    const path = `sensors.${k}`;
    const redraw = () => {
      if (sensor.kind !== "lidar") sensor.model = "generic";
      if (sensor.kind !== "profiler") Object.assign(sensor, { head_topic: "", head_rate_deg_s: 0 });
      this.#draw();
      this.#edited();
    };
    const models = sensor.kind === "lidar" ? this.#models : ["generic"];
    const head = sensor.kind === "profiler" && [
      this.#text(sensor, "head_topic", { label: "Topic of the head", path: `${path}.head_topic` }),
      this.#number(sensor, "head_rate_deg_s", {
        label: "Turn rate of the head",
        path: `${path}.head_rate_deg_s`,
        ...DEGREES,
        unit: "°/s",
      }),
    ];
    const row = (...children) => make("div", { className: "fields" }, ...children);
    const checkbox = make("input", { type: "checkbox", checked: sensor.enabled });
    checkbox.addEventListener("change", () => {
      sensor.enabled = checkbox.checked;
      this.#edited();
    });
    return this.#group(
      sensor.name || `Sensor ${k + 1}`,
      row(
        this.#text(sensor, "name", { label: "Name", path: `${path}.name`, required: true }),
        this.#choice(sensor, "kind", { label: "Kind", path, options: KINDS, then: redraw }),
        this.#choice(sensor, "model", {
          label: "Model",
          path,
          options: Object.fromEntries(models.map((name) => [name, name])),
        }),
      ),
      this.#triple(sensor, "xyz_m", { label: "Position", of: XYZ, path, ...CM }),
      this.#triple(sensor, "rpy_deg", { label: "Rotation", of: RPY, path, ...DEGREES }),
      this.#numbers(
        sensor,
        path,
        this.#text(sensor, "address", { label: "Address", path: `${path}.address`, hint: "any" }),
        this.#text(sensor, "topic", { label: "Topic", path: `${path}.topic`, hint: "detected" }),
        this.#text(sensor, "serial", { label: "Serial number", path: `${path}.serial` }),
      ),
      head ? row(...head) : null,
      make(
        "div",
        { className: "title-row" },
        make("label", { className: "check" }, checkbox, make("span", {}, "Used for the map")),
        this.#content.sensors.length > 1
          ? make("button", { type: "button", onclick: () => this.#remove(k) }, "Remove")
          : null,
      ),
    );
  }

  /** Clock and port, and what else stands in their row. */
  #numbers(record, path, ...others) {
    return make(
      "div",
      { className: "fields" },
      this.#number(record, "time_offset_s", {
        label: "Clock",
        path: `${path}.time_offset_s`,
        ...MS,
      }),
      this.#number(record, "port", {
        label: "UDP port",
        path: `${path}.port`,
        factor: 1,
        digits: 0,
        unit: "",
        whole: true,
      }),
      ...others,
    );
  }

  #text(record, key, { label, path, hint = "", required = false }) {
    const input = make("input", {
      name: path,
      value: record[key],
      placeholder: hint,
      autocomplete: "off",
      spellcheck: false,
      required,
      maxLength: 200,
    });
    input.addEventListener("input", () => {
      record[key] = input.value.trim();
      this.#edited();
    });
    return this.#labeled(label, input, path);
  }

  #choice(record, key, { label, path, options, then = () => this.#edited() }) {
    const known = record[key] in options ? options : { ...options, [record[key]]: record[key] };
    const select = make(
      "select",
      { name: `${path}.${key}` },
      ...Object.entries(known).map(([value, text]) =>
        make("option", { value, selected: value === record[key] }, text),
      ),
    );
    select.addEventListener("change", () => {
      record[key] = select.value;
      then();
    });
    return this.#labeled(label, select, `${path}.${key}`);
  }

  #number(record, key, { label, path, unit, factor, digits, whole = false }) {
    const set = (value) => (record[key] = value);
    const input = this.#input(path, record[key], set, { factor, digits, whole });
    return this.#labeled(unit ? `${label} [${unit}]` : label, input, path);
  }

  #triple(record, key, { label, of, path, unit, factor, digits }) {
    const how = { factor, digits, whole: false };
    const field = `${path}.${key}`;
    const part = (name, k) => {
      const input = this.#input(field, record[key][k], (value) => (record[key][k] = value), how);
      return make("label", {}, make("span", {}, name), input);
    };
    const title = `${label} [${unit}]`;
    return make(
      "div",
      { className: "triple", role: "group", ariaLabel: title },
      make("span", { className: "title" }, title),
      ...of.map(part),
      this.#slot(field),
    );
  }

  #input(name, value, set, { factor, digits, whole }) {
    const input = make("input", {
      type: "number",
      step: whole ? "1" : "any",
      name,
      value: short(value * factor, digits),
      required: true,
      inputMode: whole ? "numeric" : "text", // a minus is on the keyboard
    });
    input.addEventListener("input", () => {
      const given = input.valueAsNumber;
      if (Number.isFinite(given) && input.validity.valid)
        set(Number((given / factor).toFixed(DECIMALS)));
      this.#edited();
    });
    return input;
  }

  #labeled(label, input, path) {
    return make("label", {}, make("span", {}, label), input, this.#slot(path));
  }

  #slot(path) {
    return make("small", { className: "error", "data-problem": path });
  }
}

customElements.define("rig-form", RigForm);
