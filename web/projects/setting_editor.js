// <setting-editor>: every setting of a preset, made from what the server declares.
// Returns only what differs from the preset; problems are shown at the field.

import { checkSettings, readSettings } from "../shared/api.js";
import {
  attempt,
  html,
  messagePlace,
  nothing,
  render,
  repeat,
  say,
  targetOf,
  within,
} from "../shared/dom.js";
import { t } from "../shared/texts.js";

/** @import {GroupView, SettingView} from "../shared/http_types" */

/** @type {Record<string, string>} */
const TYPES = {
  int: t("setting-int"),
  float: t("setting-float"),
  text: t("setting-text"),
};

export class SettingEditor extends HTMLElement {
  #state = {
    preset: "",
    /** @type {GroupView[]} */
    groups: [],
    /** @type {Map<string, string>} */
    texts: new Map(), // of the fields, by path; of settings that are not shown too
    /** @type {Record<string, string>} */
    problems: {}, // by path
    find: "",
    onlyChanged: false,
  };

  connectedCallback() {
    this.#draw();
  }

  /** Shows a preset; changes made before are kept. */
  async show(/** @type {string} */ preset) {
    if (preset === this.#state.preset) return;
    const groups = await attempt(within(this, ":scope > .error"), () => readSettings(preset));
    if (!groups) return;
    const changes = new Map(this.#changes());
    Object.assign(this.#state, { preset, groups, texts: changes, problems: {} });
    this.#draw();
  }

  /** Settings that differ from the preset, or are not shown yet. */
  #changes() {
    const { groups, texts } = this.#state;
    const usual = new Map(
      groups.flatMap(({ settings }) => settings.map((one) => [one.path, String(one.value)])),
    );
    return [...texts].filter(([path, text]) => text !== usual.get(path));
  }

  /** The changes to the preset, as `group.field=value` texts. */
  texts() {
    return this.#changes().map(([path, text]) => `${path}=${text}`);
  }

  /** Applies the changes of another job; before or after `show`. */
  set(/** @type {string[]} */ changes) {
    for (const text of changes) {
      const at = text.indexOf("=");
      this.#state.texts.set(text.slice(0, at).trim(), text.slice(at + 1).trim());
    }
    this.#draw();
  }

  /** Shows the problems the server found, each at its field; returns whether there are any. */
  complain(/** @type {Record<string, string>} */ problems) {
    this.#state.problems = problems;
    this.#draw();
    const first = this.querySelector("[aria-invalid=true]");
    if (first instanceof HTMLElement) {
      /** @type {HTMLDetailsElement} */ (first.closest("details")).open = true;
      first.focus();
    }
    return Object.keys(problems).length > 0;
  }

  /**
   * A field was left with a text.
   * @param {string} path
   * @param {string} text
   */
  async #change(path, text) {
    this.#state.texts.set(path, text);
    this.#draw();
    const { preset } = this.#state;
    const verdict = await attempt(within(this, ":scope > .error"), () =>
      checkSettings(preset, this.texts()),
    );
    this.#state.problems = verdict?.problems ?? {};
    this.#draw();
  }

  #draw() {
    const { groups, problems, find, onlyChanged } = this.#state;
    const changed = this.#changes().length;
    const filters = find !== "" || onlyChanged;
    const change = (/** @type {Partial<{find: string, onlyChanged: boolean}>} */ filter) => {
      Object.assign(this.#state, filter);
      this.#draw();
    };
    const search = (/** @type {Event} */ event) =>
      change({ find: targetOf(event).value.trim().toLowerCase() });
    const restrict = (/** @type {Event} */ event) =>
      change({ onlyChanged: targetOf(event).checked });
    render(
      html`<label
          ><span>${t("setting-find")}</span
          ><input
            type="search"
            placeholder=${t("setting-example")}
            autocomplete="off"
            @input=${search}
        /></label>
        <label class="check"
          ><input type="checkbox" @change=${restrict} /><span
            >${t("setting-only-changed")}</span
          ></label
        >
        <p class="quiet" role="status">
          ${changed ? t("setting-changed", { count: String(changed) }) : t("setting-unchanged")}
        </p>
        <div class="groups">
          ${repeat(
            groups,
            ({ name }) => name,
            (group) => this.#group(group),
          )}
        </div>
        ${messagePlace()}`,
      this,
    );
    if (filters) for (const group of this.querySelectorAll("details")) group.open = !group.hidden;
    const shown = new Set(groups.flatMap(({ settings }) => settings.map(({ path }) => path)));
    const elsewhere = Object.entries(problems).filter(([path]) => !shown.has(path));
    if (elsewhere.length)
      say(within(this, ":scope > .error"), elsewhere.map(([, text]) => text).join("; "));
  }

  #group(/** @type {GroupView} */ { name, text, settings }) {
    const fits = settings.map((setting) => this.#fits(setting));
    return html`<details class="group" ?hidden=${!fits.includes(true)}>
      <summary lang="en">${name}</summary>
      <p class="quiet">${text}</p>
      ${settings.map((setting, k) => this.#setting(setting, !fits[k]))}
    </details>`;
  }

  #textOf(/** @type {SettingView} */ { path, value }) {
    return this.#state.texts.get(path) ?? String(value);
  }

  /** Whether a setting is what is searched for, or has a problem. */
  #fits(/** @type {SettingView} */ setting) {
    const { find, onlyChanged, problems } = this.#state;
    if (problems[setting.path]) return true;
    if (onlyChanged && this.#textOf(setting) === String(setting.value)) return false;
    return `${setting.path} ${setting.name} ${setting.text}`.toLowerCase().includes(find);
  }

  /**
   * @param {SettingView} setting
   * @param {boolean} hidden
   */
  #setting(setting, hidden) {
    const { path, name, kind, unit, text, default: usual, value } = setting;
    const problem = this.#state.problems[path] ?? "";
    const about = [
      TYPES[kind] ?? "",
      t("setting-default", { value: String(usual) || t("setting-empty") }),
      value !== usual ? t("fact-preset", { preset: String(value) }) : "",
    ];
    const id = `setting-${path}`;
    const changed = this.#textOf(setting) !== String(value);
    return html`<div class="setting ${changed ? "changed" : ""}" ?hidden=${hidden}>
      <label for=${id} lang="en"
        ><span>${name}${unit ? html`<small> ${unit}</small>` : nothing}</span></label
      >
      ${this.#input(setting, problem !== "")}
      <p class="hint" id="${id}-hint">
        <span>${text}</span>
        <span class="quiet">(${about.filter(Boolean).join(", ")})</span>
      </p>
      <p class="error" id="${id}-error">${problem}</p>
    </div>`;
  }

  /**
   * @param {SettingView} setting
   * @param {boolean} invalid
   */
  #input(setting, invalid) {
    const { path, kind, choices } = setting;
    const id = `setting-${path}`;
    const text = this.#textOf(setting);
    const about = `${id}-hint ${id}-error`;
    const change = (/** @type {Event} */ event) => this.#change(path, targetOf(event).value);
    const options = kind === "bool" ? ["true", "false"] : kind === "choice" ? choices : null;
    if (options)
      return html`<select
        id=${id}
        aria-describedby=${about}
        aria-invalid=${invalid}
        @change=${change}
      >
        ${options.map((one) => html`<option lang="en" .selected=${one === text}>${one}</option>`)}
      </select>`;
    const type = (/** @type {Event} */ event) => {
      this.#state.texts.set(path, targetOf(event).value);
      this.#draw();
    };
    return html`<input
      id=${id}
      aria-describedby=${about}
      aria-invalid=${invalid}
      inputmode=${kind === "int" || kind === "float" ? "decimal" : "text"}
      autocomplete="off"
      spellcheck="false"
      .value=${text}
      @input=${type}
      @change=${change}
    />`;
  }
}

customElements.define("setting-editor", SettingEditor);
