// <finding-list>: what is known of a map, with the time axis of the walk; each finding with its
// level, code, text, remedy and a link to its place in the viewer, with the notes of reviewers and
// a field for one, and a filter; of a map of an earlier version its sentences.

import { idHere } from "./address.js";
import {
  acknowledge,
  findingHelpUrl,
  isGuest,
  mapPlaceUrl,
  mapUrl,
  projectUrl,
  readAcknowledgments,
  readCurrentUser,
  slicesUrl,
  stretchUrl,
} from "./api.js";
import { attempt, html, messagePlace, nothing, render, targetOf, within } from "./dom.js";
import { when } from "./format.js";
import {
  LEVELS,
  durationOf,
  sliceOf,
  spanIn,
  stretchOf,
  stretchText,
  verdictLists,
} from "./verdict.js";
import { walkAxis } from "./walk_axis.js";
import { t } from "./texts.js";

/**
 * @import {Acknowledgment, AcknowledgmentsView} from "./http_types"
 * @import {Content} from "./dom.js"
 * @import {MapFacts, MapFinding} from "./verdict.js"
 * @typedef {"level" | "kind"} Choice
 */

const MANY = 4;
/** @type {AcknowledgmentsView} */
const NO_NOTES = { may_acknowledge: false, notes: [] };

export class FindingList extends HTMLElement {
  #state = {
    shown: "", // the facts as text
    /** @type {MapFinding[]} */
    findings: [],
    duration_s: 0,
    notes: NO_NOTES,
    guest: false, // sees the map, not the graph
    filter: { level: "", kind: "" },
  };
  /** Whether it has no field for notes: a dialog is about the state when it was opened. */
  readOnly = false;

  connectedCallback() {
    this.classList.add("verdict-lists");
    addEventListener("hashchange", this.#redraw);
  }

  disconnectedCallback() {
    removeEventListener("hashchange", this.#redraw);
  }

  /** What is known of the map; the same again changes nothing: focus and selection stay. */
  set facts(/** @type {MapFacts} */ facts) {
    const shown = JSON.stringify(facts);
    if (shown === this.#state.shown) return;
    const duration_s = durationOf(facts);
    Object.assign(this.#state, { shown, findings: facts.findings ?? [], duration_s });
    render(nothing, this); // a note that is being written is not moved to another finding
    if (facts.findings) {
      this.#draw();
      this.#readNotes();
    } else render(sentences(facts), this);
  }

  /** Another stretch is marked. */
  #redraw = () => {
    if (this.#state.findings.length) this.#draw();
  };

  async #readNotes() {
    this.#state.guest = isGuest(await readCurrentUser());
    if (this.#state.guest) return this.#draw();
    this.#state.notes = await readAcknowledgments(idHere()).catch(() => NO_NOTES);
    if (this.#state.notes.may_acknowledge || this.#state.notes.notes.length) this.#draw();
  }

  #draw() {
    const { findings, duration_s, filter, guest, notes: all } = this.#state;
    const { notes, may_acknowledge } = all;
    const span = spanIn(location);
    const isMarked = (/** @type {MapFinding} */ { span_s }) => span_s?.join(",") === span;
    const items = findings.map((finding, at) => {
      const fits =
        (!filter.level || finding.level === filter.level) &&
        (!filter.kind || finding.kind === filter.kind);
      const mayNote = may_acknowledge && !this.readOnly && finding.level !== "good";
      const about = notes.filter((note) => note.finding === at);
      return item(finding, about, {
        hidden: !fits,
        guest,
        form: mayNote ? this.#form(finding, at) : null,
      });
    });
    const outdated = notes.filter((note) => note.finding === null);
    render(
      html`${walkAxis(findings, duration_s, isMarked)}
        ${findings.length > MANY ? this.#filters() : nothing}
        <ul class="findings">
          ${items}
        </ul>
        ${outdated.length ? outdatedNotes(outdated) : nothing}`,
      this,
    );
  }

  /** Choices of a level and a kind, with their numbers; they hide the other findings. */
  #filters() {
    const level = this.#choice("level", t("finding-levels"), levelText);
    const kind = this.#choice("kind", t("finding-kinds"), (value) => value);
    return html`<div class="finding-filter">${level}${kind}</div>`;
  }

  /**
   * @param {Choice} name
   * @param {string} caption
   * @param {(value: string) => string} words
   */
  #choice(name, caption, words) {
    const { findings, filter } = this.#state;
    const values = [...new Set(findings.map((finding) => finding[name]))];
    const count = (/** @type {string} */ value) =>
      findings.filter((one) => one[name] === value).length;
    const change = (/** @type {Event} */ event) => {
      filter[name] = targetOf(event).value;
      this.#draw();
    };
    return html`<label
      ><span>${caption}</span
      ><select @change=${change}>
        <option value="">${t("finding-all", { count: String(findings.length) })}</option>
        ${values.map(
          (value) => html`<option value=${value}>${words(value)} (${count(value)})</option>`,
        )}
      </select></label
    >`;
  }

  /**
   * A field for a note about a finding, which opens.
   * @param {MapFinding} finding
   * @param {number} at
   */
  #form({ kind, span_s }, at) {
    const submit = async (/** @type {SubmitEvent} */ event) => {
      event.preventDefault();
      const details = /** @type {HTMLElement} */ (targetOf(event).closest("details"));
      const why = within(details, "input", HTMLInputElement);
      const note = { finding: at, kind, span_s, why: why.value };
      const done = await attempt(within(details, ".error"), () => acknowledge(idHere(), note));
      if (!done) return;
      this.#state.notes = done;
      why.value = "";
      details.removeAttribute("open");
      this.#draw();
      within(details, "summary").focus();
    };
    return html`<details class="acknowledge">
      <summary>${t("acknowledge-open")}</summary>
      <form @submit=${submit}>
        <label
          ><span>${t("acknowledge-note")}</span
          ><input name="why" maxlength="500" required autocomplete="off"
        /></label>
        ${messagePlace()}
        <button>${t("acknowledge")}</button>
      </form>
    </details>`;
  }
}

const levelText = (/** @type {string} */ level) => LEVELS[level] ?? level;

const noteLine = (/** @type {Acknowledgment} */ { who, time, why }) =>
  html`<p class="acknowledged">${t("acknowledged", { who, when: when(time) })} <q>${why}</q></p>`;

/** Notes about findings that the map does not have any more. */
const outdatedNotes = (/** @type {Acknowledgment[]} */ notes) =>
  html`<section class="outdated">
    <h3>${t("acknowledged-outdated")}</h3>
    <ul>
      ${notes.map(
        (note) =>
          html`<li>
            ${note.kind}${note.span_s ? `, ${stretchText(note)}` : ""}${noteLine(note)}
          </li>`,
      )}
    </ul>
  </section>`;

/**
 * @param {MapFinding} finding
 * @param {Acknowledgment[]} notes
 * @param {{hidden: boolean, guest: boolean, form: Content}} options
 */
const item = (finding, notes, { hidden, guest, form }) =>
  html`<li class=${finding.level.replaceAll(" ", "-")} ?hidden=${hidden}>
    <p class="finding-head">
      <span class="level">${levelText(finding.level)}</span><strong>${finding.title}</strong>${
        guest
          ? html`<span class="code">${finding.kind}</span>`
          : html`<a class="code" href=${findingHelpUrl(finding.kind)} target="_blank" rel="noopener"
              >${finding.kind}</a
            >`
      }
    </p>
    <p>${finding.text}</p>
    ${finding.remedy ? html`<p class="remedy">${finding.remedy}</p>` : nothing}
    ${placeLinks(finding, guest)} ${sliceLink(finding)} ${notes.map(noteLine)} ${form}
  </li>`;

/**
 * Links to the stretch in the map and in the graph, which open beside a page that may have fields
 * filled in; nothing without a stretch.
 * @param {MapFinding} finding
 * @param {boolean} guest
 */
function placeLinks(finding, guest) {
  const stretch = stretchOf(finding);
  if (!stretch) return nothing;
  const pages = [projectUrl(idHere()), mapUrl(idHere())];
  const beside = pages.includes(location.pathname) ? nothing : "_blank";
  const rel = beside === nothing ? nothing : "noopener";
  return html`<a
      class="button stretch"
      href=${mapPlaceUrl(idHere(), stretch)}
      target=${beside}
      rel=${rel}
      >${t("finding-in-map", { stretch: stretchText(finding) })}</a
    >
    ${
      guest
        ? nothing
        : html`<a
            class="button stretch"
            href=${stretchUrl(idHere(), stretch)}
            target=${beside}
            rel=${rel}
            aria-label=${t("finding-in-graph-of", { stretch: stretchText(finding) })}
            >${t("finding-in-graph")}</a
          >`
    }`;
}

/** On the page of slices a link to the slice at the place of a finding. */
const sliceLink = (/** @type {MapFinding} */ finding) =>
  finding.place_m && location.pathname === slicesUrl(idHere())
    ? html`<a class="button stretch" href="?${sliceOf(finding)}">${t("finding-cut")}</a>`
    : nothing;

const sentences = (/** @type {MapFacts} */ facts) =>
  verdictLists(facts).map(
    ([title, texts]) =>
      html`<h3>${title}</h3>
        <ul>
          ${texts.map((text) => html`<li>${text}</li>`)}
        </ul>`,
  );

customElements.define("finding-list", FindingList);

/** The list of what is known of a map, to read only. */
export function fixedFindingList(/** @type {MapFacts} */ facts) {
  const list = /** @type {FindingList} */ (document.createElement("finding-list"));
  list.readOnly = true;
  list.facts = facts;
  return list;
}
