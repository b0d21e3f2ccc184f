// <map-verdict>: the verdict on a map with its findings, as a bar that opens.

import { badge } from "./badge.js";
import { fill, make } from "./dom.js";
import { FindingList } from "./finding_list.js";
import { firstText, verdictState } from "./verdict.js";

export class MapVerdict extends HTMLElement {
  #line = make("summary");
  #list = new FindingList();
  #details = make("details", {}, this.#line, this.#list);

  connectedCallback() {
    this.setAttribute("role", "status");
    this.hidden = true;
    this.replaceChildren(this.#details);
  }

  /** What is known of the map; null hides the bar. */
  set facts(/** @type {import("./verdict.js").MapFacts | null} */ facts) {
    this.hidden = facts === null;
    if (!facts) return;
    const first = firstText(facts);
    this.className = verdictState(facts.verdict);
    fill(this.#line, badge(this.className), make("span", { className: "first" }, first));
    this.#list.facts = facts;
    this.#details.inert = first === "";
  }
}

customElements.define("map-verdict", MapVerdict);
