// Which projects the list shows, and in which order. No DOM, no network.

import { language, t } from "../shared/texts.js";

/**
 * @import {ProjectCard, ProjectSpace} from "../shared/http_types"
 * @typedef {"newest" | "name" | "verdict" | "length" | "size"} Order
 * @typedef {object} Wanted
 * @property {string} text words that are searched; empty = all
 * @property {Order} order
 * @property {string} show "" = not archived, "archived", "twins", or "tag:" and a tag
 */

/** @type {Record<Order, string>} */
export const ORDERS = {
  newest: t("order-newest"),
  name: t("order-name"),
  verdict: t("order-verdict"),
  length: t("order-length"),
  size: t("order-size"),
};

/** @type {Record<string, number>} */
const SEVERITY = { "do not use": 0, check: 1, "": 2, good: 3 };
const names = new Intl.Collator(language(), { numeric: true, sensitivity: "base" });

/**
 * What the address of the page asks for.
 * @param {string} search
 * @returns {Wanted}
 */
export function wantedIn(search) {
  const query = new URLSearchParams(search);
  const order = /** @type {Order} */ (query.get("order"));
  return {
    text: query.get("find") ?? "",
    order: Object.hasOwn(ORDERS, order) ? order : "newest",
    show: query.get("show") ?? "",
  };
}

/** The same as a query; empty if nothing is asked for. */
export function searchOf(/** @type {Wanted} */ { text, order, show }) {
  const query = new URLSearchParams();
  if (text) query.set("find", text);
  if (order !== "newest") query.set("order", order);
  if (show) query.set("show", show);
  return query.size ? `?${query}` : "";
}

/**
 * Id -> other projects of the same recording.
 * @param {ProjectCard[]} projects
 * @returns {Map<string, ProjectCard[]>}
 */
export function twinsOf(projects) {
  /** @type {Map<string, ProjectCard[]>} */
  const groups = new Map();
  for (const project of projects)
    if (project.recording)
      groups.set(project.recording, [...(groups.get(project.recording) ?? []), project]);
  const twins = [...groups.values()].filter((group) => group.length > 1);
  return new Map(
    twins.flatMap((group) => group.map((one) => [one.id, group.filter((other) => other !== one)])),
  );
}

/**
 * Tag -> how many projects have it, by name; archived ones do not count.
 * @param {ProjectCard[]} projects
 */
export function tagCounts(projects) {
  /** @type {Map<string, number>} */
  const counts = new Map();
  for (const tag of projects.filter(({ archived }) => !archived).flatMap(({ tags }) => tags))
    counts.set(tag, (counts.get(tag) ?? 0) + 1);
  return [...counts].toSorted(([a], [b]) => names.compare(a, b));
}

/**
 * The projects to show, in order.
 * @param {ProjectCard[]} projects the newest first
 * @param {Wanted} wanted
 * @param {{twins: Map<string, unknown>, spaces: Map<string, ProjectSpace>}} known
 */
export function chosen(projects, { text, order, show }, { twins, spaces }) {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const tag = show.startsWith("tag:") ? show.slice(4) : null;
  const found = projects.filter((project) => {
    if (show === "twins" ? !twins.has(project.id) : project.archived !== (show === "archived"))
      return false;
    if (tag !== null && !project.tags.includes(tag)) return false;
    const { name, id, rig, preset, tags } = project;
    const all = [name, id, rig, preset, ...tags].join(" ").toLowerCase();
    return words.every((word) => all.includes(word));
  });
  return ordered(found, order, spaces);
}

/**
 * @param {ProjectCard[]} projects
 * @param {Order} order
 * @param {Map<string, ProjectSpace>} spaces
 */
function ordered(projects, order, spaces) {
  const size = (/** @type {ProjectCard} */ { id }) => spaces.get(id)?.bytes ?? 0;
  /** @type {Record<Exclude<Order, "newest">, (a: ProjectCard, b: ProjectCard) => number>} */
  const compare = {
    name: (a, b) => names.compare(a.name, b.name),
    verdict: (a, b) => (SEVERITY[a.usability] ?? 2) - (SEVERITY[b.usability] ?? 2),
    length: (a, b) => (b.path_length_m ?? 0) - (a.path_length_m ?? 0),
    size: (a, b) => size(b) - size(a),
  };
  return order === "newest" ? projects : projects.toSorted(compare[order]);
}
