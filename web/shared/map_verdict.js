// <map-verdict>: the verdict on a map with its findings, as a bar that opens.

import { badge } from "./badge.js";
import { html, render } from "./dom.js";
import "./finding_list.js";
import { firstText, verdictState } from "./verdict.js";

/** @import {MapFacts} from "./verdict.js" */

export class MapVerdict extends HTMLElement {
  connectedCallback() {
    this.setAttribute("role", "status");
    this.hidden = true;
  }

  /** What is known of the map; null hides the bar. */
  set facts(/** @type {MapFacts | null} */ facts) {
    this.hidden = facts === null;
    if (!facts) return;
    const first = firstText(facts);
    const state = verdictState(facts.verdict);
    this.className = state;
    render(
      html`<details ?inert=${first === ""}>
        <summary>${badge(state)}<span class="first">${first}</span></summary>
        <finding-list .facts=${facts}></finding-list>
      </details>`,
      this,
    );
  }
}

customElements.define("map-verdict", MapVerdict);
