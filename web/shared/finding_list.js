// <finding-list>: what is known of a map, each finding with its level, code, text, remedy and a
// link to its place in the viewer, with the notes of reviewers and a field for one, and a filter;
// of a map of an earlier version its sentences.

import { idHere } from "./address.js";
import {
  acknowledge,
  findingHelpUrl,
  projectUrl,
  readAcknowledgments,
  slicesUrl,
  stretchUrl,
} from "./api.js";
import { attempt, make } from "./dom.js";
import { when } from "./format.js";
import { LEVELS, sliceOf, stretchOf, stretchText, verdictLists } from "./verdict.js";

const MANY = 4;
/** @type {import("./http_types").AcknowledgmentsView} */
const NO_NOTES = { may_acknowledge: false, notes: [] };

export class FindingList extends HTMLElement {
  #shown = "";
  /** @type {import("./verdict.js").MapFinding[]} */
  #findings = [];
  #notes = NO_NOTES;
  #filter = { level: "", kind: "" };
  /** Whether it has no field for notes: a dialog is about the state when it was opened. */
  readOnly = false;

  connectedCallback() {
    this.classList.add("verdict-lists");
  }

  /** What is known of the map; the same again changes nothing: focus and selection stay. */
  set facts(/** @type {import("./verdict.js").MapFacts} */ facts) {
    const text = JSON.stringify(facts);
    if (text === this.#shown) return;
    this.#shown = text;
    if (facts.findings) {
      this.#findings = facts.findings;
      this.#draw();
      this.#readNotes();
    } else this.replaceChildren(...sentences(facts));
  }

  async #readNotes() {
    this.#notes = await readAcknowledgments(idHere()).catch(() => NO_NOTES);
    if (this.#notes.may_acknowledge || this.#notes.notes.length) this.#draw();
  }

  #draw() {
    const { notes, may_acknowledge } = this.#notes;
    const items = this.#findings.map((finding, at) =>
      item(
        finding,
        notes.filter((note) => note.finding === at),
        may_acknowledge && !this.readOnly && finding.level !== "good"
          ? this.#form(finding, at)
          : null,
      ),
    );
    const outdated = notes.filter((note) => note.finding === null);
    this.replaceChildren(
      ...(items.length > MANY ? [this.#filters(items)] : []),
      make("ul", { className: "findings" }, ...items),
      ...(outdated.length ? [outdatedNotes(outdated)] : []),
    );
  }

  /** Choices of a level and a kind, with their numbers; they hide the other findings. */
  #filters(items) {
    const apply = () =>
      items.forEach((one, at) => {
        const { level, kind } = this.#findings[at];
        const { level: onlyLevel, kind: onlyKind } = this.#filter;
        one.hidden = (onlyLevel && level !== onlyLevel) || (onlyKind && kind !== onlyKind);
      });
    const choice = (name, caption, words) => {
      const values = [...new Set(this.#findings.map((finding) => finding[name]))];
      const count = (value) => this.#findings.filter((one) => one[name] === value).length;
      const select = make(
        "select",
        { onchange: () => ((this.#filter[name] = select.value), apply()) },
        make("option", { value: "" }, `All (${items.length})`),
        ...values.map((value) => make("option", { value }, `${words(value)} (${count(value)})`)),
      );
      select.value = this.#filter[name];
      return make("label", {}, make("span", {}, caption), select);
    };
    const level = choice("level", "Level of findings", (value) => LEVELS[value] ?? value);
    const kind = choice("kind", "Kind of findings", (value) => value);
    apply();
    return make("div", { className: "finding-filter" }, level, kind);
  }

  /** A field for a note about a finding, which opens. */
  #form({ kind, span_s }, at) {
    const why = make("input", { name: "why", maxLength: 500, required: true, autocomplete: "off" });
    const message = make("p", { className: "error", role: "alert" });
    const submit = async (event) => {
      event.preventDefault();
      const note = { finding: at, kind, span_s, why: why.value };
      const done = await attempt(message, () => acknowledge(idHere(), note));
      if (!done) return;
      this.#notes = done;
      this.#draw();
      this.querySelectorAll("ul.findings > li")[at].querySelector("summary").focus();
    };
    return make(
      "details",
      { className: "acknowledge" },
      make("summary", {}, "Acknowledge…"),
      make(
        "form",
        { onsubmit: submit },
        make("label", {}, make("span", {}, "Note (the verdict does not change)"), why),
        message,
        make("button", {}, "Acknowledge"),
      ),
    );
  }
}

const noteLine = ({ who, time, why }) =>
  make(
    "p",
    { className: "acknowledged" },
    `✓ Acknowledged by ${who}, ${when(time)}: `,
    make("q", {}, why),
  );

/** Notes about findings that the map does not have any more. */
const outdatedNotes = (notes) =>
  make(
    "section",
    { className: "outdated" },
    make("h3", {}, "Outdated acknowledgments: this map has no such finding"),
    make(
      "ul",
      {},
      ...notes.map((note) =>
        make(
          "li",
          {},
          `${note.kind}${note.span_s ? `, ${stretchText(note)}` : ""}`,
          noteLine(note),
        ),
      ),
    ),
  );

/** @param {import("./verdict.js").MapFinding} finding */
const item = (finding, notes, form) =>
  make(
    "li",
    { className: finding.level.replaceAll(" ", "-") },
    make(
      "p",
      { className: "finding-head" },
      make("span", { className: "level" }, LEVELS[finding.level] ?? finding.level),
      make("strong", {}, finding.title),
      make("a", { className: "code", href: findingHelpUrl(finding.kind), ...BESIDE }, finding.kind),
    ),
    make("p", {}, finding.text),
    finding.remedy ? make("p", { className: "remedy" }, finding.remedy) : null,
    placeLink(finding),
    sliceLink(finding),
    ...notes.map(noteLine),
    form,
  );

const BESIDE = { target: "_blank", rel: "noopener" };

/**
 * A link to the stretch in the viewer of the project's page, which opens beside any other page;
 * null without a stretch.
 */
function placeLink(finding) {
  const stretch = stretchOf(finding);
  if (!stretch) return null;
  const here = location.pathname === projectUrl(idHere());
  const link = { className: "button stretch", href: stretchUrl(idHere(), stretch) };
  const text = `Show in the map: ${stretchText(finding)}`;
  return make("a", here ? link : { ...link, ...BESIDE }, text);
}

/** On the page of slices a link to the slice at the place of a finding. */
const sliceLink = (finding) =>
  finding.place_m && location.pathname === slicesUrl(idHere())
    ? make("a", { className: "button stretch", href: `?${sliceOf(finding)}` }, "Cut here")
    : null;

const sentences = (facts) =>
  verdictLists(facts).flatMap(([title, texts]) => [
    make("h3", {}, title),
    make("ul", {}, ...texts.map((text) => make("li", {}, text))),
  ]);

customElements.define("finding-list", FindingList);

/** The list of what is known of a map, to read only. */
export function fixedFindingList(/** @type {import("./verdict.js").MapFacts} */ facts) {
  const list = /** @type {FindingList} */ (document.createElement("finding-list"));
  list.readOnly = true;
  list.facts = facts;
  return list;
}
