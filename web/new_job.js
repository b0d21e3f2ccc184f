// <new-job>: the form that starts a job, with a browser of the server's folders.

import { addJob, browse, projectUrl, readChoices } from "./api.js";
import { attempt, make } from "./dom.js";
import { bytes } from "./format.js";

const field = (words, control, hint) =>
  make("label", {}, make("span", {}, words), control, hint ? make("small", {}, hint) : null);

const slug = (path) =>
  path.split("/").at(-1).replace(/\.[^.]*$/, "").replace(/[^A-Za-z0-9._-]+/g, "-").replace(/^[^A-Za-z0-9]+/, "").slice(0, 64);

class NewJob extends HTMLElement {
  #recording = make("input", { name: "recording", required: true, autocomplete: "off", spellcheck: false });
  #project = make("input", {
    name: "project", required: true, autocomplete: "off", spellcheck: false,
    pattern: "[A-Za-z0-9][A-Za-z0-9._\\-]{0,63}", title: "Letters, digits, dot, dash and underscore",
  });
  #preset = make("select", { name: "preset" });
  #rig = make("select", { name: "rig" }, make("option", { value: "" }, "Guess from the recording"));
  #imu = make("input", { name: "imu", autocomplete: "off", spellcheck: false });
  #gnss = make("input", { name: "gnss", autocomplete: "off", spellcheck: false });
  #folder = make("div", { className: "folder", hidden: true });
  #message = make("p", { className: "error", role: "alert" });

  async connectedCallback() {
    const look = make("button", { type: "button", onclick: () => this.#toggle() }, "Browse…");
    const form = make(
      "form",
      { onsubmit: (event) => this.#submit(event) },
      field("Recording on this computer", this.#recording, "File or folder: pcap, bag, mcap, frames"),
      look,
      this.#folder,
      field("Project name", this.#project),
      field("Preset", this.#preset),
      field("Rig", this.#rig),
      make(
        "details", {}, make("summary", {}, "IMU and GNSS files"),
        field("IMU, CSV", this.#imu, "Empty: what the recording has"),
        field("GNSS, CSV", this.#gnss, "Empty: what the recording has"),
      ),
      make("button", { className: "primary" }, "Start"),
      this.#message,
    );
    this.#recording.addEventListener("change", () => this.#suggest());
    this.replaceChildren(form);
    const choices = await attempt(this.#message, readChoices);
    const option = (name) => make("option", { value: name }, name);
    this.#preset.append(...(choices?.presets ?? []).map(option));
    this.#rig.append(...(choices?.rigs ?? []).map(option));
  }

  #suggest() {
    if (!this.#project.value) this.#project.value = slug(this.#recording.value);
  }

  async #toggle() {
    this.#folder.hidden = !this.#folder.hidden;
    if (!this.#folder.hidden) await this.#open("");
  }

  async #open(path) {
    const entries = await attempt(this.#message, () => browse(path));
    if (!entries) return;
    const up = path.split("/").slice(0, -1).join("/");
    const row = (words, note, onclick) =>
      make("button", { type: "button", onclick }, make("span", {}, words), make("small", {}, note));
    const choose = (chosen) => {
      this.#recording.value = chosen;
      this.#folder.hidden = true;
      this.#suggest();
    };
    this.#folder.replaceChildren(
      make("p", { className: "path" }, path || "Folders of this server"),
      ...(path ? [row("↩ All folders", "", () => this.#open("")), row("Use this folder", "", () => choose(path))] : []),
      ...(up && path ? [row("↑ Up", "", () => this.#open(up))] : []),
      ...entries.map((entry) =>
        entry.folder
          ? row(`${entry.name}/`, "", () => this.#open(entry.path))
          : row(entry.name, bytes(entry.bytes), () => choose(entry.path)),
      ),
    );
  }

  async #submit(event) {
    event.preventDefault();
    const job = {
      project: this.#project.value,
      recordings: [this.#recording.value],
      preset: this.#preset.value,
      rig: this.#rig.value,
      imu: this.#imu.value,
      gnss: this.#gnss.value,
    };
    const added = await attempt(this.#message, () => addJob(job));
    if (added) location.assign(projectUrl(added.job.project));
  }
}

customElements.define("new-job", NewJob);
