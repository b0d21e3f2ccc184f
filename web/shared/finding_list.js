// <finding-list>: what is known of a map, each finding with its level, code, text, remedy and a
// link to its place in the viewer; of a map of an earlier version its sentences.

import { idHere } from "./address.js";
import { findingHelpUrl, projectUrl, stretchUrl } from "./api.js";
import { make } from "./dom.js";
import { LEVELS, stretchOf, stretchText, verdictLists } from "./verdict.js";

export class FindingList extends HTMLElement {
  #shown = "";

  connectedCallback() {
    this.classList.add("verdict-lists");
  }

  /** What is known of the map; the same again changes nothing: focus and selection stay. */
  set facts(/** @type {import("./verdict.js").MapFacts} */ facts) {
    const text = JSON.stringify(facts);
    if (text === this.#shown) return;
    this.#shown = text;
    this.replaceChildren(...(facts.findings ? [listOf(facts.findings)] : sentences(facts)));
  }
}

/** @param {import("./verdict.js").MapFinding[]} findings */
const listOf = (findings) => make("ul", { className: "findings" }, ...findings.map(item));

/** @param {import("./verdict.js").MapFinding} finding */
const item = (finding) =>
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

const sentences = (facts) =>
  verdictLists(facts).flatMap(([title, texts]) => [
    make("h3", {}, title),
    make("ul", {}, ...texts.map((text) => make("li", {}, text))),
  ]);

customElements.define("finding-list", FindingList);

/** The list of what is known of a map. */
export function findingList(/** @type {import("./verdict.js").MapFacts} */ facts) {
  const list = /** @type {FindingList} */ (document.createElement("finding-list"));
  list.facts = facts;
  return list;
}
