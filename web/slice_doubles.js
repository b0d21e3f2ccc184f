// Places where two visits put one wall at two places; a click goes there.

import { readDoubleWalls } from "./api.js";
import { attempt, make } from "./dom.js";
import { count } from "./format.js";

const cm = (m) => `${(m * 100).toFixed(1)} cm`;
const span = ([from, to]) => `${from.toFixed(0)}–${to.toFixed(0)} s`;

/** A horizontal cut through the middle, close up; a vertical one across, where the surface is level. */
function cutAt(wall) {
  const [x, y, z] = wall.middle_m;
  const close = { t: 0.1, color: "time", lo: null, hi: null, m: 0.003 };
  if (Math.abs(wall.normal[2]) < 0.7) return { ...close, kind: "horizontal", z, u: x, v: y };
  return { ...close, kind: "vertical", a: [x - 2, y], b: [x + 2, y], u: 2, v: z };
}

export function doublesPanel({ id, change, point }) {
  const message = make("p", { className: "error", role: "alert" });
  const list = make("div", {});
  const button = make("button", { type: "button", onclick: () => attempt(message, look) }, "Look for double walls");
  const hint = make("p", { className: "quiet" }, "One surface that two visits put at two places. The whole map is checked.");

  async function look() {
    button.disabled = true;
    button.textContent = "Looking…";
    try {
      show(await readDoubleWalls(id));
    } finally {
      button.disabled = false;
      button.textContent = "Look for double walls";
    }
  }

  function show(found) {
    const seen = found.patches
      ? `${count(found.patches)} patches were visited twice; their visits differ by ${cm(found.median_separation_m)} (median), ${cm(found.p95_separation_m)} (95 %); a surface is ${cm(found.median_sigma_m)} thick (σ).`
      : "No surface was visited twice: nothing can be said.";
    const verdict = found.walls.length
      ? make("p", { className: "verdict bad" }, `✕ ${found.walls.length} places are double`)
      : make("p", { className: "verdict good" }, found.patches ? "✓ No double wall found" : "– Not checked");
    const rows = found.walls.slice(0, 200).map((wall, k) => row(wall, k));
    const head = ["Place", "Apart", "Limit", "σ", "D", "Weaker layer", "Visits"].map((words) => make("th", { scope: "col" }, words));
    const table = rows.length ? make("div", { className: "wide" }, make("table", {}, make("thead", {}, make("tr", {}, ...head)), make("tbody", {}, ...rows))) : null;
    list.replaceChildren(...[verdict, make("p", { className: "quiet" }, seen), table].filter(Boolean));
  }

  function row(wall, k) {
    const go = () => {
      point(wall.middle_m.slice(0, 2));
      change(cutAt(wall));
      document.getElementById("views").scrollIntoView({ block: "nearest" });
    };
    const words = wall.middle_m.map((x) => x.toFixed(1)).join(" ");
    return make("tr", {},
      make("td", {}, make("button", { type: "button", className: "go", onclick: go, ariaLabel: `Go to double wall ${k + 1}` }, words)),
      make("td", { className: "number" }, cm(wall.separation_m)),
      make("td", { className: "number" }, cm(wall.limit_m)),
      make("td", { className: "number" }, cm(wall.sigma_m)),
      make("td", { className: "number" }, wall.bimodality.toFixed(1)),
      make("td", { className: "number" }, `${(wall.share * 100).toFixed(0)} %`),
      make("td", {}, `${wall.spans_s.map(span).join(" and ")}; multiframes ${wall.frames.map(([from, to]) => `${from}–${to}`).join(" and ")}`),
    );
  }

  return { element: make("div", {}, hint, button, message, list) };
}
