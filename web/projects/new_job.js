// <new-job>: the form that starts a job: a recording, a name, a preset, settings.
// With `again` it repeats a job: in the same project, or in a new one that reuses finished stages.

import { addJob, listProjects, listRigs, projectUrl, readChoices } from "../shared/api.js";
import { attempt, make } from "../shared/dom.js";
import "./folder_browser.js";
import "./recording_summary.js";
import "./setting_editor.js";
import "./upload_box.js";

const field = (text, control, hint) =>
  make("label", {}, make("span", {}, text), control, hint ? make("small", {}, hint) : null);

/** The name of a file or folder without its ending. */
const titleOf = (path) =>
  path
    .split("/")
    .at(-1)
    .replace(/\.[A-Za-z0-9]+$/, "")
    .slice(0, 90);

const text = (name, more = {}) =>
  make("input", { name, autocomplete: "off", spellcheck: false, ...more });

export class NewJob extends HTMLElement {
  #recording = text("recording", { required: true, onchange: () => this.#look() });
  #browser = make("folder-browser", { onpick: (event) => this.#choose(event.detail) });
  #found = make("recording-look", { onpick: (event) => this.#choose(event.detail) });
  #project = text("project", {
    required: true,
    maxLength: 100,
    oninput: () => this.#touched.add("project"),
  });
  #preset = make("select", {
    name: "preset",
    onchange: () => {
      this.#touched.add("preset");
      this.#explainPreset();
      this.#editor.show(this.#preset.value);
    },
  });
  #presetText = make("span");
  #presetTexts = {}; // preset -> what it is for
  #rig = make(
    "select",
    { name: "rig", onchange: () => this.#touched.add("rig") },
    make("option", { value: "" }, "Detect from the recording"),
  );
  #imu = text("imu", { oninput: () => this.#touched.add("imu") });
  #gnss = text("gnss", { oninput: () => this.#touched.add("gnss") });
  #editor = make("setting-editor");
  #settings = make("details", {}, make("summary", {}, "All settings"), this.#editor);
  #message = make("p", { className: "error", role: "alert" });
  #touched = new Set(); // fields the person filled in: no suggestion overwrites them
  #taken = new Set(); // names of the existing projects: a new one gets another
  #others = []; // recordings of the repeated job after the first
  #again = null;
  #start = make("button", { className: "primary" }, "Start");
  #checked = { path: "", found: Promise.resolve(null) }; // the last recording that was looked at
  #offered = Promise.resolve(); // until presets, rigs and taken names are known

  connectedCallback() {
    this.replaceChildren(
      make(
        "form",
        { onsubmit: (event) => this.#submit(event) },
        ...(this.#again
          ? []
          : [
              make("upload-box", {
                onrecording: (event) => this.#choose(event.detail, { isNamed: true }),
                onremoved: () => this.#choose(""),
                onchosen: (event) => this.#suggest({ project: titleOf(event.detail) }),
              }),
            ]),
        field(
          this.#again ? "Recording" : "Or a recording on the server",
          this.#recording,
          "File or folder: pcap, bag, mcap, frames",
        ),
        make("button", { type: "button", onclick: () => this.#browser.toggle() }, "Browse…"),
        this.#browser,
        this.#found,
        field(
          "Project name",
          this.#project,
          this.#again
            ? "The same name runs again in this project, another name makes a new one. " +
                "Finished stages with unchanged inputs are reused."
            : "",
        ),
        field("Preset", this.#preset, this.#presetText),
        field("Rig", this.#rig),
        make(
          "details",
          {},
          make("summary", {}, "IMU and GNSS files"),
          field("IMU, CSV", this.#imu, "Empty: from the recording"),
          field("GNSS, CSV", this.#gnss, "Empty: from the recording"),
        ),
        this.#settings,
        this.#start,
        this.#message,
      ),
    );
    this.#settings.addEventListener(
      "toggle",
      () => this.#settings.open && this.#editor.show(this.#preset.value),
    );
    this.#offered = this.#offer();
  }

  async #offer() {
    const [choices, projects, rigs] =
      (await attempt(this.#message, () =>
        Promise.all([readChoices(), this.#again ? [] : listProjects(), listRigs()]),
      )) ?? [];
    this.#taken = new Set(projects?.flatMap(({ id, name }) => [id, name]));
    const option = (name) => make("option", { value: name }, name);
    this.#preset.append(...(choices?.presets ?? []).map(option));
    this.#presetTexts = choices?.preset_texts ?? {};
    this.#explainPreset();
    this.#rig.append(
      ...(rigs ?? []).map(({ id, path, shipped, version }) =>
        make("option", { value: path }, shipped ? id : `${id}, version ${version}`),
      ),
    );
    if (this.#again) this.#fill(this.#again);
    else this.#suggest({ project: this.#project.value || undefined }); // may be taken
  }

  #explainPreset() {
    this.#presetText.textContent = this.#presetTexts[this.#preset.value] ?? "";
  }

  /** A job to repeat; set before the form is shown. */
  set again(job) {
    this.#again = job;
  }

  #fill({ project, inputs }) {
    const [first = "", ...others] = inputs.recordings;
    this.#others = others;
    this.#recording.value = first;
    this.#suggest({ project, ...inputs });
    for (const name of ["project", "preset", "rig", "imu", "gnss"]) this.#touched.add(name);
    this.#editor.set(inputs.settings);
    if (inputs.settings.length) this.#settings.open = true;
  }

  /** @param {{isNamed?: boolean}} [known] whether it has a name from its sender */
  #choose(path, known) {
    this.#recording.value = path;
    this.#others = [];
    this.#look(known);
  }

  async #look({ isNamed = false } = {}) {
    const path = this.#recording.value.trim();
    if (!isNamed) this.#suggest({ project: titleOf(path) });
    const looked = Promise.all([this.#found.look(path), this.#offered]);
    this.#checked = { path, found: looked.then(([found]) => found) };
    const found = await this.#checked.found;
    if (found) this.#suggest(isNamed ? { ...found, project: undefined } : found);
  }

  /** Whether the recording can be read; looks at it unless that was done. */
  async #isReadable() {
    if (this.#checked.path !== this.#recording.value.trim()) this.#look();
    const found = await this.#checked.found;
    if (!found) this.#checked = { path: "", found: Promise.resolve(null) }; // look again next time
    return found !== null;
  }

  /**
   * Puts values into the fields that the person has not filled in.
   * @param {{project?: string, preset?: string, rig?: string, imu?: string, gnss?: string}} values
   */
  #suggest({ project, preset, rig, imu, gnss }) {
    const put = (name, input, value) => {
      if (value === undefined || this.#touched.has(name)) return;
      if (name === "rig" && value && ![...input.options].some((one) => one.value === value)) {
        input.append(make("option", { value }, value.split("/").at(-1)));
      }
      input.value = value;
    };
    put("project", this.#project, this.#again ? project : project && this.#free(project));
    put("preset", this.#preset, preset);
    this.#explainPreset();
    put("rig", this.#rig, rig);
    put("imu", this.#imu, imu);
    put("gnss", this.#gnss, gnss);
    if (preset !== undefined && this.#settings.open) this.#editor.show(this.#preset.value);
  }

  /** The name, with a number if there is a project of that name. */
  #free(project) {
    let found = project;
    for (let n = 2; this.#taken.has(found); n += 1) found = `${project}-${n}`;
    return found;
  }

  async #submit(event) {
    event.preventDefault();
    this.#message.textContent = "";
    [this.#start.disabled, this.#start.textContent] = [true, "Checking the recording…"];
    const readable = await this.#isReadable();
    if (!readable) {
      this.#message.textContent = "This recording cannot be read, see above: nothing was started";
      this.#recording.focus();
    } else {
      this.#start.textContent = "Starting…";
      const added = await attempt(this.#message, () => this.#add(this.#job()));
      if (added) location.assign(projectUrl(added.job.project));
    }
    [this.#start.disabled, this.#start.textContent] = [false, "Start"];
  }

  #job() {
    const name = this.#project.value.trim();
    const repeats = this.#again?.project === name;
    return {
      project: repeats ? name : "",
      title: repeats ? "" : name,
      recordings: [this.#recording.value.trim(), ...this.#others],
      preset: this.#preset.value,
      rig: this.#rig.value,
      imu: this.#imu.value,
      gnss: this.#gnss.value,
      settings: this.#editor.texts(),
      clone_of: this.#again && !repeats ? this.#again.project : "",
    };
  }

  async #add(job) {
    try {
      return await addJob(job);
    } catch (error) {
      if (Object.keys(error.problems).length) {
        this.#settings.open = true;
        await this.#editor.show(this.#preset.value);
        if (this.#editor.complain(error.problems))
          throw new Error("Some settings are invalid, see above");
      }
      throw error;
    }
  }
}

customElements.define("new-job", NewJob);
