// <new-job>: the form that starts a job: a recording, a name, a preset, settings.
// With `again` it repeats a job: in the same project, or in a new one that reuses finished stages.

import { addJob, firstProjects, listRigs, projectUrl, readChoices } from "../shared/api.js";
import {
  asError,
  attempt,
  detailOf,
  html,
  messagePlace,
  nothing,
  render,
  say,
  targetOf,
  within,
} from "../shared/dom.js";
import { hasText, t } from "../shared/texts.js";
import { FolderBrowser } from "./folder_browser.js";
import { RecordingLook } from "./recording_summary.js";
import { SettingEditor } from "./setting_editor.js";
import "./upload_box.js";

/**
 * @import {Content} from "../shared/dom.js"
 * @import {Inputs, RecordingSummary} from "../shared/http_types"
 * @typedef {import("../shared/http_types").NewJob} JobRequest
 * @typedef {{project: string,
 *   inputs: Partial<Inputs> & Pick<Inputs, "recordings" | "settings">}} RepeatedJob
 * @typedef {"project" | "preset" | "rig" | "imu" | "gnss"} Suggested a field with suggestions
 */

/** @type {Suggested[]} */
const SUGGESTED = ["project", "preset", "rig", "imu", "gnss"];
/** The name of a file or folder without its ending. */
const titleOf = (/** @type {string} */ path) =>
  (path.split("/").at(-1) ?? "").replace(/\.[A-Za-z0-9]+$/, "").slice(0, 90);

/**
 * @param {string} text
 * @param {Content} control
 * @param {Content} hint
 */
const field = (text, control, hint = nothing) =>
  html`<label
    ><span>${text}</span>${control}${hint ? html`<small>${hint}</small>` : nothing}</label
  >`;

/**
 * A choice of the field Rig: value and caption.
 * @param {import("../shared/http_types").RigCard} card
 * @returns {[string, string]}
 */
function rigOption({ id, path, shipped, version }) {
  return [path, shipped ? id : t("rig-version", { id, version: String(version) })];
}

/**
 * What a preset is for.
 * @param {string} preset
 * @param {Record<string, string>} texts of the server
 */
const presetText = (preset, texts) =>
  hasText(`preset-${preset}`) ? t(`preset-${preset}`) : texts[preset];

export class NewJob extends HTMLElement {
  #state = {
    recording: "",
    /** @type {Record<Suggested, string>} */
    values: { project: "", preset: "", rig: "", imu: "", gnss: "" },
    /** @type {string[]} */
    presets: [],
    /** @type {Record<string, string>} */
    presetTexts: {}, // what each is for
    /** @type {Array<[string, string]>} */
    rigs: [], // path and caption
    busy: "", // what is being done
  };
  /** @type {Set<Suggested>} */
  #touched = new Set(); // fields the person filled in: no suggestion overwrites them
  /** @type {Set<string>} */
  #taken = new Set(); // names of the existing projects: a new one gets another
  /** @type {string[]} */
  #others = []; // recordings of the repeated job after the first
  /** @type {RepeatedJob | null} */
  #again = null;
  /** The last recording that was looked at. */
  #checked = {
    path: "",
    found: /** @type {Promise<RecordingSummary | null>} */ (Promise.resolve(null)),
  };
  #offered = Promise.resolve(); // until presets, rigs and taken names are known

  connectedCallback() {
    this.#draw();
    this.#offered = this.#offer();
  }

  #draw() {
    const { recording, values, presets, presetTexts, rigs, busy } = this.#state;
    const again = this.#again !== null;
    const pick = (/** @type {Event} */ event) => this.#choose(detailOf(event));
    const type = (/** @type {Event} */ event) => (this.#state.recording = targetOf(event).value);
    const browse = () => within(this, "folder-browser", FolderBrowser).toggle();
    render(
      html`<form @submit=${(/** @type {SubmitEvent} */ event) => this.#submit(event)}>
        ${again ? nothing : this.#upload()}
        ${field(
          again ? t("job-recording") : t("job-or-recording"),
          html`<input
            name="recording"
            autocomplete="off"
            spellcheck="false"
            required
            .value=${recording}
            @input=${type}
            @change=${() => this.#look()}
          />`,
          t("job-recording-hint"),
        )}
        <button type="button" @click=${browse}>${t("browse")}</button>
        <folder-browser @pick=${pick}></folder-browser>
        <recording-look @pick=${pick} @rig=${() => this.#awaitMounts()}></recording-look>
        ${field(t("job-name"), this.#text("project", true), again ? t("job-repeats") : nothing)}
        ${field(
          t("job-preset"),
          this.#select(
            "preset",
            presets.map((name) => [name, name]),
          ),
          html`<span>${presetText(values.preset, presetTexts)}</span>`,
        )}
        ${field(t("figure-rig"), this.#select("rig", [["", t("rig-detect")], ...rigs]))}
        <details>
          <summary>${t("job-samples")}</summary>
          ${field(t("job-imu"), this.#text("imu"), t("job-from-recording"))}
          ${field(t("job-gnss"), this.#text("gnss"), t("job-from-recording"))}
        </details>
        <details class="settings" @toggle=${() => this.#showSettings()}>
          <summary>${t("job-settings")}</summary>
          <setting-editor></setting-editor>
        </details>
        <button class="primary" ?disabled=${busy !== ""}>${busy || t("job-start")}</button>
        ${messagePlace()}
      </form>`,
      this,
    );
  }

  #upload() {
    const received = (/** @type {Event} */ event) =>
      this.#choose(detailOf(event), { isNamed: true });
    const chosen = (/** @type {Event} */ event) =>
      this.#suggest({ project: titleOf(detailOf(event)) });
    return html`<upload-box
      @recording=${received}
      @removed=${() => this.#choose("")}
      @chosen=${chosen}
    ></upload-box>`;
  }

  #text(/** @type {Suggested} */ name, required = false) {
    const type = (/** @type {Event} */ event) => {
      this.#touched.add(name);
      this.#state.values[name] = targetOf(event).value;
    };
    return html`<input
      name=${name}
      autocomplete="off"
      spellcheck="false"
      maxlength=${name === "project" ? 100 : nothing}
      ?required=${required}
      .value=${this.#state.values[name]}
      @input=${type}
    />`;
  }

  /**
   * @param {"preset" | "rig"} name
   * @param {Array<[string, string]>} options value and caption of each
   */
  #select(name, options) {
    const choose = (/** @type {Event} */ event) => {
      this.#touched.add(name);
      this.#put({ [name]: targetOf(event).value });
    };
    const chosen = this.#state.values[name];
    return html`<select name=${name} @change=${choose}>
      ${options.map(
        ([value, text]) =>
          html`<option value=${value} .selected=${value === chosen}>${text}</option>`,
      )}
    </select>`;
  }

  get #message() {
    return within(this, "form > .error");
  }

  get #editor() {
    return within(this, "setting-editor", SettingEditor);
  }

  get #settings() {
    return within(this, ".settings", HTMLDetailsElement);
  }

  async #offer() {
    const [choices, projects, rigs] =
      (await attempt(this.#message, () =>
        Promise.all([readChoices(), this.#again ? [] : firstProjects(), listRigs()]),
      )) ?? [];
    this.#taken = new Set(projects?.flatMap(({ id, name }) => [id, name]));
    const state = this.#state;
    state.presets = choices?.presets ?? [];
    state.presetTexts = choices?.preset_texts ?? {};
    state.values.preset ||= state.presets[0] ?? "";
    state.rigs = (rigs ?? []).map(rigOption);
    if (this.#again) this.#fill(this.#again);
    else this.#suggest({ project: state.values.project || undefined }); // may be taken
  }

  /** A rig was made of the recording: its mounts are filled in on another page, as a version. */
  #awaitMounts() {
    const readAgain = async () => {
      const rigs = await attempt(this.#message, listRigs);
      if (rigs) this.#state.rigs = rigs.map(rigOption);
      this.#draw();
    };
    window.addEventListener("focus", readAgain);
    void readAgain();
  }

  /** A job to repeat; set before the form is shown. */
  set again(/** @type {RepeatedJob} */ job) {
    this.#again = job;
  }

  #fill(/** @type {RepeatedJob} */ { project, inputs }) {
    const [first = "", ...others] = inputs.recordings;
    this.#others = others;
    this.#state.recording = first;
    this.#suggest({ ...inputs, project });
    for (const name of SUGGESTED) this.#touched.add(name);
    this.#editor.set(inputs.settings);
    if (inputs.settings.length) this.#settings.open = true;
  }

  /**
   * @param {string} path
   * @param {{isNamed?: boolean}} [known] whether it has a name from its sender
   */
  #choose(path, known) {
    this.#state.recording = path;
    this.#others = [];
    this.#draw();
    this.#look(known);
  }

  async #look({ isNamed = false } = {}) {
    const path = this.#state.recording.trim();
    if (!isNamed) this.#suggest({ project: titleOf(path) });
    const looks = within(this, "recording-look", RecordingLook);
    const looked = Promise.all([looks.look(path), this.#offered]);
    this.#checked = { path, found: looked.then(([found]) => found) };
    const found = await this.#checked.found;
    if (found) this.#suggest(isNamed ? { ...found, project: undefined } : found);
  }

  /** Whether the recording can be read; looks at it unless that was done. */
  async #isReadable() {
    if (this.#checked.path !== this.#state.recording.trim()) this.#look();
    const found = await this.#checked.found;
    if (!found) this.#checked = { path: "", found: Promise.resolve(null) }; // look again next time
    return found !== null;
  }

  /** Puts values into the fields that the person has not filled in. */
  #suggest(/** @type {Partial<Record<Suggested, string>>} */ suggested) {
    const { project } = suggested;
    const named = this.#again ? project : project && this.#free(project);
    const values = { ...suggested, project: named };
    this.#put(
      Object.fromEntries(
        SUGGESTED.filter((name) => values[name] !== undefined && !this.#touched.has(name)).map(
          (name) => [name, values[name]],
        ),
      ),
    );
  }

  /** Puts values into fields; a rig that is no choice yet becomes one. */
  #put(/** @type {Partial<Record<Suggested, string>>} */ values) {
    const { rig, preset } = values;
    const { rigs } = this.#state;
    if (rig && !rigs.some(([path]) => path === rig))
      this.#state.rigs = [...rigs, [rig, rig.split("/").at(-1) ?? rig]];
    Object.assign(this.#state.values, values);
    this.#draw();
    if (preset !== undefined) this.#showSettings();
  }

  /** Shows the settings of the preset, if the list of settings is open. */
  #showSettings() {
    if (this.#settings.open) this.#editor.show(this.#state.values.preset);
  }

  /** The name, with a number if there is a project of that name. */
  #free(/** @type {string} */ project) {
    let found = project;
    for (let n = 2; this.#taken.has(found); n += 1) found = `${project}-${n}`;
    return found;
  }

  async #submit(/** @type {SubmitEvent} */ event) {
    event.preventDefault();
    say(this.#message, "");
    this.#doing(t("job-checking"));
    const readable = await this.#isReadable();
    if (!readable) {
      say(this.#message, t("job-unreadable"));
      within(this, "[name=recording]").focus();
    } else {
      this.#doing(t("job-starting"));
      const added = await attempt(this.#message, () => this.#add(this.#job()));
      if (added) location.assign(projectUrl(added.job.project));
    }
    this.#doing("");
  }

  #doing(/** @type {string} */ busy) {
    this.#state.busy = busy;
    this.#draw();
  }

  /** @returns {JobRequest} */
  #job() {
    const { recording, values } = this.#state;
    const name = values.project.trim();
    const repeats = this.#again?.project === name;
    return {
      ...values,
      project: repeats ? name : "",
      title: repeats ? "" : name,
      recordings: [recording.trim(), ...this.#others],
      settings: this.#editor.texts(),
      clone_of: this.#again && !repeats ? this.#again.project : "",
    };
  }

  async #add(/** @type {JobRequest} */ job) {
    try {
      return await addJob(job);
    } catch (error) {
      const { problems = {} } = asError(error);
      if (Object.keys(problems).length) {
        this.#settings.open = true;
        await this.#editor.show(this.#state.values.preset);
        if (this.#editor.complain(problems)) throw new Error(t("job-invalid"));
      }
      throw error;
    }
  }
}

customElements.define("new-job", NewJob);
