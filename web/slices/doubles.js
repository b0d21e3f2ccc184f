// Double walls: surfaces that two visits put at two places; a click on one shows it in the slice.

import { readDoubleWalls } from "../shared/api.js";
import { attempt, make } from "../shared/dom.js";
import { count } from "../shared/format.js";
import { distanceFrom } from "./state.js";

/** Half the size of a place [m]. */
const REACH_M = 0.75;
const MAX_ROWS = 50;

const cm = (m) => `${(m * 100).toFixed(1)} cm`;
const range = ([from, to]) => `${from}–${to}`;
const span = ([from, to]) => `${from.toFixed(0)}–${to.toFixed(0)} s`;

/** A close horizontal slice through the middle; if the surface is level, a vertical one across. */
function cutAt(wall) {
  const [x, y, z] = wall.middle_m;
  const close = { t: 0.1, color: "time", lo: null, hi: null, m: 0.003 };
  if (Math.abs(wall.normal[2]) < 0.7) return { ...close, kind: "horizontal", z, u: x, v: y };
  return { ...close, kind: "vertical", a: [x - 2, y], b: [x + 2, y], u: 2, v: z };
}

export function doublesPanel({ id, change, point, state }) {
  const message = make("p", { className: "error", role: "alert" });
  const list = make("div", {});
  const button = make(
    "button",
    { type: "button", onclick: () => attempt(message, look) },
    "Find double walls",
  );
  const hint = make(
    "p",
    { className: "quiet" },
    "A wall is double where two visits put one surface at two places. The whole map is checked.",
  );

  const choose = (text, choices) =>
    make(
      "select",
      { ariaLabel: text, hidden: true, onchange: () => listed() },
      ...Object.entries(choices).map(([value, name]) => make("option", { value }, name)),
    );
  const which = choose("Which surfaces", {
    double: "Only double ones",
    all: "All visited twice, worst first",
  });
  const where = choose("Where", { all: "Whole map", slice: "In this slice" });
  const table = make("div", { className: "scroll" });
  let walls = [];
  let surfaces = [];

  async function look() {
    button.disabled = true;
    button.textContent = "Searching…";
    try {
      show(await readDoubleWalls(id, state().source));
    } finally {
      button.disabled = false;
      button.textContent = "Find double walls";
    }
  }

  function show(found) {
    const seen = found.patches
      ? `${count(found.patches)} patches were visited twice; distance between the visits ` +
        `${cm(found.median_separation_m)} (median), ${cm(found.p95_separation_m)} (95 %); ` +
        `thickness σ as measured ${cm(found.median_sigma_m)}.`
      : "No surface was visited twice: double walls cannot be detected.";
    const verdict = found.walls.length
      ? make("p", { className: "verdict bad" }, `✕ ${found.walls.length} double walls`)
      : make(
          "p",
          { className: "verdict good" },
          found.patches ? "✓ No double wall found" : "– Not checked",
        );
    [walls, surfaces] = [found.walls, found.surfaces];
    which.hidden = where.hidden = walls.length + surfaces.length === 0;
    which.value = walls.length ? "double" : "all";
    list.replaceChildren(verdict, make("p", { className: "quiet" }, seen));
    listed();
  }

  const inSlice = (wall) => distanceFrom(state(), wall.middle_m) <= state().t / 2 + REACH_M;

  /** Lists the selected rows; with "In this slice" they follow the slice. */
  function listed() {
    const focused = table.contains(document.activeElement)
      ? document.activeElement.ariaLabel
      : null;
    const asked = which.value === "all" ? [...walls, ...surfaces] : walls;
    const meant = where.value === "slice" ? asked.filter(inSlice) : asked;
    if (!asked.length) return table.replaceChildren();
    const summary = [
      `${meant.length} of ${asked.length} places`,
      meant.length > MAX_ROWS ? `the ${MAX_ROWS} worst are listed` : "",
    ];
    const head = [
      "Place",
      "",
      "Separation",
      "Limit",
      "Thickness σ as measured",
      "D = separation / σ",
      "Weaker layer",
      "Visits",
    ].map((text) => make("th", { scope: "col" }, text));
    const rows = meant.slice(0, MAX_ROWS).map(row);
    const caption = make(
      "p",
      { className: "quiet", role: "status" },
      summary.filter(Boolean).join(", "),
    );
    table.replaceChildren(
      caption,
      ...(rows.length
        ? [
            make(
              "table",
              {},
              make("thead", {}, make("tr", {}, ...head)),
              make("tbody", {}, ...rows),
            ),
          ]
        : []),
    );
    if (focused) table.querySelector(`[aria-label="${focused}"]`)?.focus();
  }

  function row(wall) {
    const double = walls.includes(wall);
    const go = () => {
      point(wall.middle_m.slice(0, 2));
      change(cutAt(wall));
      document.getElementById("views").scrollIntoView({ block: "nearest" });
    };
    const text = wall.middle_m.map((x) => x.toFixed(1)).join(" ");
    return make(
      "tr",
      {},
      make(
        "td",
        {},
        make(
          "button",
          { type: "button", className: "go", onclick: go, ariaLabel: `Go to ${text}` },
          text,
        ),
      ),
      make("td", { className: double ? "bad" : "good" }, double ? "✕ double" : "✓ single"),
      make("td", { className: "number" }, cm(wall.separation_m)),
      make("td", { className: "number" }, cm(wall.limit_m)),
      make("td", { className: "number" }, cm(wall.sigma_m)),
      make("td", { className: "number" }, wall.bimodality.toFixed(1)),
      make("td", { className: "number" }, `${(wall.share * 100).toFixed(0)} %`),
      make(
        "td",
        {},
        `${wall.spans_s.map(span).join(" and ")}; ` +
          `multiframes ${wall.frames.map(range).join(" and ")}`,
      ),
    );
  }

  return {
    element: make(
      "div",
      {},
      hint,
      make("div", { className: "row" }, button, which, where),
      message,
      list,
      table,
    ),
    show: () => where.value === "slice" && listed(),
  };
}
