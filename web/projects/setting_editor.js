// <setting-editor>: every setting of a preset, made from what the server declares.
// Returns only what differs from the preset; problems are shown at the field.

import { checkSettings, readSettings } from "../shared/api.js";
import { attempt, make } from "../shared/dom.js";

const TYPES = { int: "whole number", float: "number", text: "text" };
let numbers = 0;

export class SettingEditor extends HTMLElement {
  #preset = "";
  #rows = new Map(); // path -> {input, value, error, row}
  #wanted = new Map(); // path -> text, of settings not shown yet
  #find = make("input", {
    type: "search",
    placeholder: "voxel, odometry, GNSS…",
    autocomplete: "off",
    oninput: () => this.#filter(),
  });
  #only = make("input", { type: "checkbox", onchange: () => this.#filter() });
  #text = make("p", { className: "quiet", role: "status" });
  #groups = make("div", { className: "groups" });
  #message = make("p", { className: "error", role: "alert" });

  connectedCallback() {
    this.replaceChildren(
      make("label", {}, make("span", {}, "Find a setting"), this.#find),
      make("label", { className: "check" }, this.#only, make("span", {}, "Only changed ones")),
      this.#text,
      this.#groups,
      this.#message,
    );
  }

  /** Shows a preset; changes made before are kept. */
  async show(preset) {
    if (preset === this.#preset) return;
    const kept = new Map(
      this.texts().map((text) => [
        text.slice(0, text.indexOf("=")),
        text.slice(text.indexOf("=") + 1),
      ]),
    );
    const groups = await attempt(this.#message, () => readSettings(preset));
    if (!groups) return;
    this.#preset = preset;
    this.#wanted = kept;
    this.#rows.clear();
    this.#groups.replaceChildren(...groups.map((group) => this.#group(group)));
    this.#wanted = new Map();
    this.#filter();
  }

  /** The changes to the preset, as `group.field=value` texts. */
  texts() {
    const changed = [...this.#rows].filter(([, row]) => row.input.value !== row.value);
    const unseen = [...this.#wanted].map(([path, value]) => `${path}=${value}`);
    return [...unseen, ...changed.map(([path, row]) => `${path}=${row.input.value}`)];
  }

  /** Applies the changes of another job; before or after `show`. */
  set(texts) {
    for (const text of texts) {
      const [path, value] = [
        text.slice(0, text.indexOf("=")).trim(),
        text.slice(text.indexOf("=") + 1).trim(),
      ];
      const row = this.#rows.get(path);
      if (row) row.input.value = value;
      else this.#wanted.set(path, value);
    }
    this.#filter();
  }

  /** Shows the problems the server found, each at its field; returns whether there are any. */
  complain(problems) {
    for (const [path, row] of this.#rows) {
      row.error.textContent = problems[path] ?? "";
      row.input.setAttribute("aria-invalid", String(path in problems));
    }
    const elsewhere = Object.entries(problems).filter(([path]) => !this.#rows.has(path));
    this.#message.textContent = elsewhere.map(([, text]) => text).join("; ");
    const first = [...this.#rows.values()].find((row) => row.error.textContent);
    if (first) {
      first.row.closest("details").open = true;
      first.row.hidden = false;
      first.input.focus();
    }
    return Object.keys(problems).length > 0;
  }

  #group({ name, text, settings }) {
    const rows = settings.map((setting) => this.#setting(setting));
    return make(
      "details",
      { className: "group" },
      make("summary", {}, name),
      make("p", { className: "quiet" }, text),
      ...rows,
    );
  }

  #setting({ path, name, kind, choices, unit, text, default: usual, value }) {
    const id = `setting-${(numbers += 1)}`;
    const shown = String(value);
    const input = this.#input(kind, choices, { id, value: this.#wanted.get(path) ?? shown });
    const error = make("p", { className: "error", id: `${id}-error` });
    const about = [
      kind in TYPES ? TYPES[kind] : "",
      `default ${String(usual) === "" ? "empty" : usual}`,
      value !== usual ? `preset ${value}` : "",
    ];
    const label = make(
      "label",
      { htmlFor: id },
      make("span", {}, name, unit ? make("small", {}, ` ${unit}`) : null),
    );
    const hint = make(
      "p",
      { className: "hint", id: `${id}-hint` },
      text ? `${text} ` : "",
      make("span", { className: "quiet" }, `(${about.filter(Boolean).join(", ")})`),
    );
    input.setAttribute("aria-describedby", `${id}-hint ${id}-error`);
    input.addEventListener("change", () => this.#check());
    const row = make("div", { className: "setting" }, label, input, hint, error);
    this.#rows.set(path, { input, value: shown, error, row });
    return row;
  }

  #input(kind, choices, props) {
    const options = kind === "bool" ? ["true", "false"] : kind === "choice" ? choices : null;
    if (options) {
      const select = make(
        "select",
        { id: props.id },
        ...options.map((one) => make("option", { value: one }, one)),
      );
      select.value = props.value;
      return select;
    }
    const numeric = kind === "int" || kind === "float";
    return make("input", {
      ...props,
      inputMode: numeric ? "decimal" : "text",
      autocomplete: "off",
      spellcheck: false,
    });
  }

  async #check() {
    this.#filter();
    const verdict = await attempt(this.#message, () => checkSettings(this.#preset, this.texts()));
    for (const [path, row] of this.#rows) {
      row.error.textContent = verdict?.problems[path] ?? "";
      row.input.setAttribute("aria-invalid", String(row.error.textContent !== ""));
    }
  }

  #filter() {
    const text = this.#find.value.trim().toLowerCase();
    for (const [path, row] of this.#rows) {
      const changed = row.input.value !== row.value;
      row.row.classList.toggle("changed", changed);
      const fits = !text || path.includes(text) || row.row.textContent.toLowerCase().includes(text);
      row.row.hidden = !fits || (this.#only.checked && !changed);
    }
    for (const group of this.#groups.children) {
      const rows = [...group.querySelectorAll(".setting")];
      group.hidden = rows.every((row) => row.hidden);
      if (text || this.#only.checked) group.open = !group.hidden;
    }
    const n = this.texts().length;
    this.#text.textContent = n ? `${n} changed` : "None changed";
  }
}

customElements.define("setting-editor", SettingEditor);
