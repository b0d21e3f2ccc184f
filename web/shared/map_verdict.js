// <map-verdict>: the verdict on a map with its reasons and notes, as a bar that opens.

import { badge } from "./badge.js";
import { fill, make } from "./dom.js";
import { verdictLists, verdictState } from "./verdict.js";

/** Findings, what is not observable, and notes as titled lists. */
export const verdictDetails = (facts) =>
  verdictLists(facts).flatMap(([title, texts]) => [
    make("h3", {}, title),
    make("ul", {}, ...texts.map((text) => make("li", {}, text))),
  ]);

export class MapVerdict extends HTMLElement {
  #line = make("summary");
  #lists = make("div", { className: "verdict-lists" });
  #details = make("details", {}, this.#line, this.#lists);

  connectedCallback() {
    this.setAttribute("role", "status");
    this.hidden = true;
    this.replaceChildren(this.#details);
  }

  /** What is known of the map; null hides the bar. */
  set facts(/** @type {import("./verdict.js").MapFacts | null} */ facts) {
    this.hidden = facts === null;
    if (!facts) return;
    const lists = verdictLists(facts);
    const first = lists[0]?.[1][0] ?? "";
    this.className = verdictState(facts.verdict);
    fill(this.#line, badge(this.className), make("span", { className: "first" }, first));
    fill(this.#lists, ...verdictDetails(facts));
    this.#details.inert = lists.length === 0;
  }
}

customElements.define("map-verdict", MapVerdict);
