// <review-queue>: the loop closures to decide about, in the order of the server: large influence
// and doubtful ones first.

import { make } from "../shared/dom.js";
import { VERDICTS, length, seconds } from "./captions.js";

const SHOW = {
  loops: ["Loop closures", (row) => row.measured && row.kind !== "neighbor"],
  doubt: ["Rejected or unverified", (row) => row.measured && row.state !== "accepted"],
  kept: ["Accepted", (row) => row.measured && row.state === "accepted" && row.kind !== "neighbor"],
  open: ["Decided automatically", (row) => row.measured && !row.who],
  decided: ["Decided by people", (row) => Boolean(row.who)],
  all: ["All registered pairs", (row) => row.measured],
  apart: ["Not registered", (row) => !row.measured],
};
const PAGE = 300; // rows in the list at a time

export class ReviewQueue extends HTMLElement {
  #rows = [];
  #byKey = new Map();
  #shown = [];
  #chosen = null;
  #page = 0;
  #show = make("select", { ariaLabel: "Which pairs" });
  #reason = make("select", { ariaLabel: "Reason of the rejection" });
  #count = make("p", { className: "quiet", role: "status" });
  #list = make("ol", { className: "queue" });
  tools = make("div", { className: "buttons" });

  connectedCallback() {
    this.#show.append(
      ...Object.entries(SHOW).map(([key, [text]]) => make("option", { value: key }, text)),
    );
    for (const one of [this.#show, this.#reason])
      one.addEventListener("change", () => this.#fill());
    this.replaceChildren(
      make("div", { className: "queue-head" }, make("h1", {}, "Loops"), this.tools),
      make("div", { className: "filters" }, this.#show, this.#reason),
      this.#count,
      this.#list,
    );
  }

  /** Rows as objects with the columns as fields. */
  set rows(rows) {
    this.#rows = rows;
    this.#chosen = null;
    this.#byKey = new Map(rows.map((row) => [row.key, row]));
    const reasons = [...new Set(rows.map((row) => row.reason).filter(Boolean))].sort();
    this.#reason.replaceChildren(
      make("option", { value: "" }, "Any reason"),
      ...reasons.map((text) => make("option", { value: text }, text)),
    );
    this.#fill();
  }

  get length() {
    return this.#shown.length;
  }

  get(key) {
    return this.#byKey.get(key);
  }

  /** Draws pairs again whose decision changed. */
  refresh(keys) {
    for (const key of keys) {
      const row = this.#byKey.get(key);
      const item = this.#list.querySelector(`[data-key="${key}"]`);
      if (row && item) item.replaceWith(this.#item(row));
    }
    this.#say();
  }

  add(row) {
    this.#rows = [row, ...this.#rows];
    this.#byKey.set(row.key, row);
    this.#fill();
  }

  /** The pair `steps` further on; from the beginning if none is chosen. */
  step(steps) {
    const at = this.#shown.findIndex((row) => row.key === this.#chosen);
    const next = this.#shown[Math.min(this.#shown.length - 1, Math.max(0, at + steps))];
    if (next) this.choose(next.key);
  }

  neighbors() {
    const at = this.#shown.findIndex((row) => row.key === this.#chosen);
    return this.#shown.slice(at + 1, at + 3);
  }

  choose(key) {
    const before = this.#chosen;
    this.#chosen = key;
    if (this.#pageOf(key) === this.#page) this.refresh([before, key]);
    else this.#list.replaceChildren(...this.#turnTo(key));
    this.#list.querySelector("[aria-current]")?.scrollIntoView({ block: "nearest" });
    this.#say();
    this.dispatchEvent(new CustomEvent("chosen", { detail: key }));
  }

  #fill() {
    const matches = SHOW[this.#show.value][1];
    const reason = this.#reason.value;
    this.#shown = this.#rows.filter((row) => matches(row) && (!reason || row.reason === reason));
    this.#list.replaceChildren(...this.#turnTo(this.#chosen));
    this.#say();
  }

  #pageOf(key) {
    return Math.floor(
      Math.max(
        0,
        this.#shown.findIndex((row) => row.key === key),
      ) / PAGE,
    );
  }

  /** The rows of the page on which a pair is. */
  #turnTo(key) {
    this.#page = this.#pageOf(key);
    return this.#shown
      .slice(this.#page * PAGE, (this.#page + 1) * PAGE)
      .map((row) => this.#item(row));
  }

  #say() {
    const at = this.#shown.findIndex((row) => row.key === this.#chosen) + 1;
    const decided = this.#shown.filter((row) => row.who).length;
    this.#count.textContent = this.#shown.length
      ? `${at || "–"} of ${this.#shown.length} · ${decided} decided by people`
      : "None";
  }

  #item(row) {
    const { mark, word } = VERDICTS[row.state] ?? VERDICTS.rejected;
    const chosen = row.key === this.#chosen;
    return make(
      "li",
      { "data-key": row.key, ...(chosen ? { ariaCurrent: "true" } : {}) },
      make(
        "button",
        { type: "button", tabIndex: chosen ? 0 : -1, onclick: () => this.choose(row.key) },
        make(
          "span",
          { className: `mark ${row.state}`, title: word },
          make("span", { ariaHidden: "true" }, mark),
          make("span", { className: "unseen" }, word),
        ),
        make("span", {}, `${seconds(row.t_i_s)} – ${seconds(row.t_j_s)}`),
        make("span", { className: "number" }, row.measured ? length(row.influence_m) : ""),
        make("small", {}, row.who ? `by ${row.who}` : row.reason || row.kind),
      ),
    );
  }
}

customElements.define("review-queue", ReviewQueue);
