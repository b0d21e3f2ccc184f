// <rig-section>: what the recording says of its rig, and what to do about it.

import { idHere } from "../shared/address.js";
import {
  addJob,
  listJobsOf,
  listRigs,
  projectUrl,
  readCalibration,
  readCalibrationSlices,
  readCurrentUser,
  rigUrl,
  saveCalibratedRig,
} from "../shared/api.js";
import { attempt, fields, fill, make } from "../shared/dom.js";
import { calibrationSlices } from "./calibration_slices.js";
import { beamRows, calibratingJob, outcomeOf, rowsOf } from "./rig_audit.js";

const BEAM_HEADS = ["LiDAR and ring", "Range", "Elevation", "Azimuth"];
const HEADS = ["Sensor", "Quantity", "Change ± σ", "Result"];

export class RigSection extends HTMLElement {
  #id = idHere();
  #body = make("div");
  #message = make("p", { className: "error", role: "alert" });
  #dialog = make("dialog", { ariaLabel: "Save the calibrated rig" });
  #mayProcess = false;
  #read = 0; // number of the newest request

  connectedCallback() {
    this.hidden = true;
    this.replaceChildren(make("h2", {}, "Rig"), this.#body, this.#message, this.#dialog);
  }

  /** Reads the audit of the latest run again. */
  async reload() {
    const number = ++this.#read;
    const found = await attempt(this.#message, async () => ({
      audit: await readCalibration(this.#id),
      slices: await readCalibrationSlices(this.#id),
      me: await readCurrentUser(),
    }));
    if (number !== this.#read) return;
    this.hidden = !found?.audit && !this.#message.textContent;
    if (!found?.audit) return;
    this.#mayProcess = found.me.may.includes("process");
    this.#draw(found.audit, found.slices);
  }

  #draw(audit, slices) {
    const { mark, word, className } = outcomeOf(audit);
    fill(
      this.#body,
      make("p", { className }, make("b", {}, `${mark} ${word}`)),
      make("p", {}, audit.outcome),
      this.#rigLine(audit),
      audit.parameters.length ? this.#table(audit) : null,
      audit.beams.length ? this.#beams(audit) : null,
      audit.before && audit.after ? this.#agreement(audit) : null,
      slices ? calibrationSlices(slices) : null,
      this.#mayProcess ? this.#buttons(audit) : null,
    );
  }

  #rigLine({ rig, saved }) {
    const link = ({ id, version }) =>
      make("a", { href: rigUrl(id) }, version ? `${id}, version ${version}` : id);
    const parts = [
      ...(rig ? ["Rig of the recording: ", link(rig), ". "] : []),
      ...(saved ? ["The calibrated rig is saved as ", link(saved), "."] : []),
    ];
    return parts.length ? make("p", { className: "quiet" }, ...parts) : null;
  }

  #table(audit) {
    const rows = rowsOf(audit.parameters);
    const off = audit.parameters.some((one) => one.status === "off");
    const cells = rows.map(({ sensor, quantity, change, mark, word, className }) => [
      make("th", { scope: "row" }, sensor),
      make("td", {}, quantity),
      make("td", { className: "number" }, change),
      make("td", { className }, `${mark} ${word}`),
    ]);
    return folded(`${rows.length} parameters compared`, "Audit", table(HEADS, cells), off);
  }

  #beams({ beams }) {
    const rows = beamRows(beams);
    const summary = `Corrections of ${rows.length} single beams`;
    return folded(summary, "Beams", table(BEAM_HEADS, rows.map(numbers)));
  }

  #agreement({ before, after }) {
    const text = (value) => (value === null ? "–" : `${(1e3 * value).toFixed(1)} mm`);
    const rows = [
      ["Distance of points from common planes", before.rms_m, after.rms_m],
      ["One surface seen by two LiDARs", before.offset_m, after.offset_m],
    ].filter(([, first, last]) => first !== null || last !== null);
    return table(
      ["", "Before", "After"],
      rows.map(([name, ...values]) => numbers([name, ...values.map(text)])),
      "Windows of the walk that were not used",
    );
  }

  #buttons(audit) {
    const calibrate = make("button", { type: "button", onclick: () => this.#calibrate() });
    calibrate.textContent = "Calibrate and map again";
    const save = make("button", { type: "button", onclick: () => this.#ask(audit) });
    save.textContent = "Save as a new rig version…";
    const done = audit.applied;
    const off = audit.parameters.some((one) => one.status === "off");
    return make(
      "div",
      { className: "buttons" },
      ...(off && !done ? [calibrate] : []),
      ...(done && !audit.saved ? [save] : []),
    );
  }

  async #calibrate() {
    const added = await attempt(this.#message, async () => {
      const job = calibratingJob(this.#id, await listJobsOf(this.#id));
      if (!job)
        throw new Error(
          "This server made no map of this project: use “Run again, with other settings” below, " +
            "with calibration.mode=auto",
        );
      return addJob(job);
    });
    if (added) location.assign(projectUrl(this.#id));
  }

  async #ask(audit) {
    const rigs = await attempt(this.#message, listRigs);
    if (!rigs) return;
    const own = rigs.filter((rig) => !rig.shipped).map((rig) => rig.id);
    const mine = own.includes(audit.rig?.id) ? audit.rig.id : "";
    const option = (value, text) => make("option", { value, selected: value === mine }, text);
    const into = make(
      "select",
      { name: "into" },
      ...own.map((id) => option(id, `A new version of ${id}`)),
      option("", "A new rig"),
    );
    const name = make("input", {
      name: "rig",
      value: this.#id,
      pattern: "[A-Za-z0-9][A-Za-z0-9._\\-]{0,63}",
      required: true,
      autocomplete: "off",
    });
    const label = make("label", {}, make("span", {}, "Name of the new rig"), name);
    const choose = () => (label.hidden = name.disabled = into.value !== "");
    into.addEventListener("change", choose);
    choose();
    const message = make("p", { className: "error", role: "alert" });
    this.#dialog.replaceChildren(
      make("h2", {}, "Save the calibrated rig"),
      make(
        "form",
        { onsubmit: (event) => this.#save(event, message) },
        make("label", {}, make("span", {}, "Save as"), into),
        label,
        make(
          "label",
          {},
          make("span", {}, "Note"),
          make("input", { name: "note", maxLength: 500, autocomplete: "off" }),
          make("small", {}, "The changes and their standard deviations are stored with it."),
        ),
        message,
        make(
          "div",
          { className: "buttons" },
          make("button", { type: "button", onclick: () => this.#dialog.close() }, "Cancel"),
          make("button", { className: "primary" }, "Save"),
        ),
      ),
    );
    this.#dialog.showModal();
  }

  async #save(event, message) {
    event.preventDefault();
    const { into, rig, note } = fields(event.target);
    const create = into.value === "";
    const version = { rig: create ? rig.value : into.value, create, note: note.value.trim() };
    if (!(await attempt(message, () => saveCalibratedRig(this.#id, version)))) return;
    this.#dialog.close();
    await this.reload();
  }
}

customElements.define("rig-section", RigSection);

/** A table of rows of cells. */
function table(heads, rows, caption = "") {
  return make(
    "table",
    { className: "audit" },
    caption ? make("caption", {}, caption) : null,
    make("thead", {}, make("tr", {}, ...heads.map((text) => make("th", { scope: "col" }, text)))),
    make("tbody", {}, ...rows.map((cells) => make("tr", {}, ...cells))),
  );
}

/** Cells of a row: its name, then numbers. */
const numbers = ([name, ...texts]) => [
  make("th", { scope: "row" }, name),
  ...texts.map((text) => make("td", { className: "number" }, text)),
];

/** What can be opened, and scrolled by the keyboard. */
function folded(summary, label, content, open = false) {
  return make(
    "details",
    { open },
    make("summary", {}, summary),
    make("div", { className: "scroll", tabIndex: 0, role: "region", ariaLabel: label }, content),
  );
}
