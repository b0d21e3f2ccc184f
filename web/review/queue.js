// <review-queue>: the loop closures to decide about, in the order of the server: large influence
// and doubtful ones first.

import { html, nothing, render, repeat, targetOf, within } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { VERDICTS, edgeText, length, reasonText, seconds } from "./captions.js";
import { workMark } from "./team_captions.js";

/** @import {Row} from "./state.js" */

/** The name of a text, and what it shows. */
/** @type {Record<string, [string, (row: Row, me: string) => boolean]>} */
const SHOW = {
  loops: ["queue-loops", (row) => row.measured && row.kind !== "neighbor"],
  doubt: ["queue-doubt", (row) => row.measured && row.state !== "accepted"],
  kept: [
    "queue-kept",
    (row) => row.measured && row.state === "accepted" && row.kind !== "neighbor",
  ],
  open: ["queue-open", (row) => row.measured && !row.who],
  decided: ["queue-decided", (row) => Boolean(row.who)],
  mine: ["queue-mine", (row, me) => me !== "" && row.work?.assignee === me],
  second: ["queue-second", (row) => Boolean(row.work?.waits)],
  later: ["queue-later", (row) => Boolean(row.work?.skipped_by)],
  all: ["queue-all", (row) => row.measured],
  apart: ["queue-apart", (row) => !row.measured],
};
const PAGE = 300; // rows in the list at a time

export class ReviewQueue extends HTMLElement {
  #state = {
    /** @type {Row[]} */
    rows: [],
    known: false, // whether rows have been set
    /** @type {Row[]} */
    shown: [], // those of the filters
    show: "loops",
    reason: "",
    chosen: "", // key of a pair
    me: "", // who looks
  };
  /** @type {Map<string, Row>} */
  #byKey = new Map();

  connectedCallback() {
    this.#draw();
  }

  /** Where the page puts buttons. */
  get tools() {
    return within(this, ".queue-head .buttons");
  }

  set rows(/** @type {Row[]} */ rows) {
    Object.assign(this.#state, { rows, known: true, chosen: "" });
    this.#byKey = new Map(rows.map((row) => [row.key, row]));
    this.#filter({});
  }

  /** Who looks: some pairs are theirs. */
  set me(/** @type {string} */ me) {
    this.#filter({ me });
  }

  get length() {
    return this.#state.shown.length;
  }

  get(/** @type {string} */ key) {
    return this.#byKey.get(key);
  }

  /** Draws again, as decisions changed; the filters stay as they were. */
  refresh() {
    this.#draw();
  }

  add(/** @type {Row} */ row) {
    this.#state.rows = [row, ...this.#state.rows];
    this.#byKey.set(row.key, row);
    this.#filter({});
  }

  /** The pair `steps` further on; from the beginning if none is chosen. */
  step(/** @type {number} */ steps) {
    const { shown } = this.#state;
    const next = shown[Math.min(shown.length - 1, Math.max(0, this.#at + steps))];
    if (next) this.choose(next.key);
  }

  neighbors() {
    return this.#state.shown.slice(this.#at + 1, this.#at + 3);
  }

  choose(/** @type {string} */ key) {
    this.#state.chosen = key;
    this.#draw();
    this.querySelector("[aria-current]")?.scrollIntoView({ block: "nearest" });
    this.dispatchEvent(new CustomEvent("chosen", { detail: key }));
  }

  /** Index of the chosen pair among the shown ones; -1 = none. */
  get #at() {
    const { shown, chosen } = this.#state;
    return shown.findIndex((row) => row.key === chosen);
  }

  /** Applies the filters, after one of them changed. */
  #filter(/** @type {{show?: string, reason?: string, me?: string}} */ changes) {
    const state = Object.assign(this.#state, changes);
    const matches = SHOW[state.show]?.[1] ?? (() => true);
    state.shown = state.rows.filter(
      (row) => matches(row, state.me) && (!state.reason || row.reason === state.reason),
    );
    this.#draw();
    this.dispatchEvent(new Event("filtered"));
  }

  #draw() {
    const { rows, shown, show, reason } = this.#state;
    const reasons = [...new Set(rows.map((row) => row.reason).filter(Boolean))].sort();
    const page = Math.floor(Math.max(0, this.#at) / PAGE);
    const byShow = (/** @type {Event} */ event) => this.#filter({ show: targetOf(event).value });
    const byReason = (/** @type {Event} */ event) =>
      this.#filter({ reason: targetOf(event).value });
    render(
      html`<div class="queue-head">
          <h1>${t("loops")}</h1>
          <div class="buttons"></div>
        </div>
        <div class="filters">
          <select aria-label=${t("which-pairs")} @change=${byShow}>
            ${Object.entries(SHOW).map(
              ([key, [text]]) =>
                html`<option value=${key} .selected=${key === show}>${t(text)}</option>`,
            )}</select
          ><select aria-label=${t("reason-of-rejection")} @change=${byReason}>
            <option value="">${t("any-reason")}</option>
            ${reasons.map(
              (one) =>
                html`<option value=${one} .selected=${one === reason}>${reasonText(one)}</option>`,
            )}
          </select>
        </div>
        <p class="quiet" role="status">${this.#count}</p>
        <ol class="queue">
          ${repeat(
            shown.slice(page * PAGE, (page + 1) * PAGE),
            (row) => row.key,
            (row) => this.#item(row),
          )}
        </ol>`,
      this,
    );
  }

  get #count() {
    const { shown, known } = this.#state;
    if (!known) return "";
    const decided = shown.filter((row) => row.who).length;
    return shown.length
      ? t("queue-count", {
          at: this.#at + 1 || "–",
          count: String(shown.length),
          decided: String(decided),
        })
      : t("none");
  }

  #item(/** @type {Row} */ row) {
    const { mark, word: id } = VERDICTS[row.state] ?? { mark: "✕", word: "mark-rejected" };
    const word = t(id);
    const chosen = row.key === this.#state.chosen;
    return html`<li data-key=${row.key} aria-current=${chosen ? "true" : nothing}>
      <button type="button" tabindex=${chosen ? 0 : -1} @click=${() => this.choose(row.key)}>
        <span class="mark ${row.state}" title=${word}
          ><span aria-hidden="true">${mark}</span><span class="unseen">${word}</span></span
        ><span>${seconds(row.t_i_s)} – ${seconds(row.t_j_s)}</span
        ><span class="number">${row.measured ? length(row.influence_m) : nothing}</span
        ><small>${[decider(row), workMark(row.work)].filter(Boolean).join(" · ")}</small>
      </button>
    </li>`;
  }
}

/** Who decided about a pair, or why the program did. */
const decider = (/** @type {Row} */ { who, reason, kind }) =>
  who ? t("by-person", { who }) : reason ? reasonText(reason) : edgeText(kind);

customElements.define("review-queue", ReviewQueue);
