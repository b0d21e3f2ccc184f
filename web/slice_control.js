// Control and check points: import, pick in the slice, residuals with pass or fail.

import { keepControl, lookAtControl, readControl, readControlReport, readSurface } from "./api.js";
import { attempt, make } from "./dom.js";

const cm = (m) => (m * 100).toFixed(1);

export function controlPanel({ id, change, point: pointAt, measured }) {
  const message = make("p", { className: "error", role: "alert" });
  const preview = make("div", {});
  const table = make("div", {});
  const file = make("input", { type: "file", accept: ".csv,.txt", ariaLabel: "Survey file" });
  let kept = { points: [], frame: "map", picks: {} };
  let georeferenced = false;

  file.addEventListener("change", () => file.files[0] && attempt(message, () => look(file.files[0])));

  async function look(chosen, order = null) {
    const data = new Uint8Array(await chosen.arrayBuffer());
    if (data.length > 600_000) throw new Error("The file has more than 600 kB; a list of points is smaller");
    let binary = "";
    for (const one of data) binary += String.fromCharCode(one);
    const found = await lookAtControl(id, { name: chosen.name, base64: btoa(binary), order });
    const rows = found.points.slice(0, 5).map((one) => make("tr", {}, make("th", { scope: "row" }, one.id), ...one.xyz_m.map((x) => make("td", { className: "number" }, x.toFixed(3)))));
    const button = (words, action) => make("button", { type: "button", onclick: () => attempt(message, action) }, words);
    const use = (frame) => () => keep({ points: found.points, frame, picks: {} });
    preview.replaceChildren(
      make("p", {}, `${found.points.length} points, separated by "${found.delimiter}", decimal "${found.decimal}"`),
      make("table", {}, make("thead", {}, make("tr", {}, ...["Point", "East, x", "North, y", "Height"].map((words, k) => make("th", { scope: "col", className: k ? "number" : "" }, words)))), make("tbody", {}, ...rows)),
      ...found.skipped.slice(0, 5).map((words) => make("p", { className: "error" }, words)),
      found.question ? make("p", {}, found.question) : "",
      make("div", { className: "buttons" },
        button("Swap east and north", () => look(chosen, found.order === "NE" ? "EN" : "NE")),
        button("Use, in the map's frame", use("map")),
        ...(georeferenced ? [button("Use, in the map's CRS", use("crs"))] : []),
      ),
    );
  }

  async function keep(next) {
    kept = await keepControl(id, next);
    preview.replaceChildren();
    await report();
  }

  async function report() {
    if (!kept.points.length) {
      table.replaceChildren(make("p", { className: "quiet" }, "No points yet. ID,X,Y,Z[,Radius]; with ; and decimal comma too."));
      return;
    }
    const found = await readControlReport(id);
    const residuals = new Map(found.rows.map((one) => [one.id, one]));
    const head = ["Point", "Role", "dE", "dN", "dU", "2D", "3D [cm]", ""].map((words, k) => make("th", { scope: "col", className: k > 1 ? "number" : "" }, words));
    table.replaceChildren(
      make("div", { className: "wide" }, make("table", {}, make("thead", {}, make("tr", {}, ...head)), make("tbody", {}, ...kept.points.slice(0, 300).map((one) => row(one, residuals.get(one.id)))))),
      ...found.figures.map(figures),
    );
  }

  function row(one, residual) {
    const values = residual ? [residual.east_m, residual.north_m, residual.up_m, residual.d2_m, residual.d3_m].map(cm) : ["", "", "", "", ""];
    const role = make("select", { ariaLabel: `Role of ${one.id}` }, make("option", { value: "check" }, "check"), make("option", { value: "control" }, "control"));
    role.value = one.role;
    role.addEventListener("change", () => attempt(message, () => keep({ ...kept, points: kept.points.map((p) => (p.id === one.id ? { ...p, role: role.value } : p)) })));
    const button = (words, action, label) => make("button", { type: "button", className: "go", ariaLabel: label, onclick: () => attempt(message, action) }, words);
    return make("tr", {},
      make("th", { scope: "row" }, one.id), make("td", {}, role),
      ...values.map((words) => make("td", { className: "number" }, words)),
      make("td", { className: "buttons" }, button("Go", () => go(one), `Go to ${one.id}`), button("Here", () => pick(one), `${one.id} is the picked point`), button("Surface", () => surface(one), `${one.id} on the nearest surface`)),
    );
  }

  async function go(one) {
    const { p_map } = await readSurface(id, one.id);
    pointAt(p_map.slice(0, 2));
    change({ kind: "horizontal", z: p_map[2], u: p_map[0], v: p_map[1], m: 0.005 });
  }

  async function pick(one) {
    const picked = measured();
    if (!picked) throw new Error(`Pick ${one.id} in the slice first`);
    await keep({ ...kept, picks: { ...kept.picks, [one.id]: picked.p_map } });
  }

  async function surface(one) {
    const found = await readSurface(id, one.id);
    if (!found.surface) throw new Error(`No surface within 30 cm of ${one.id}`);
    await keep({ ...kept, picks: { ...kept.picks, [one.id]: found.surface } });
  }

  function figures(one) {
    const verdicts = Object.entries(one.passed).map(([words, good]) => make("li", { className: good ? "good" : "bad" }, `${good ? "✓" : "✕"} ${words}`));
    return make("div", { className: "figures" },
      make("h3", {}, `${one.points} ${one.role} points`),
      make("p", {}, `RMSE E ${cm(one.rmse_m[0])}  N ${cm(one.rmse_m[1])}  U ${cm(one.rmse_m[2])}  3D ${cm(one.rmse_3d_m)} cm · mean 2D ${cm(one.mean_2d_m)}, height ${cm(one.mean_up_m)} · largest 2D ${cm(one.max_2d_m)}, height ${cm(one.max_up_m)} cm`),
      make("ul", { className: "verdicts" }, ...verdicts),
    );
  }

  attempt(message, async () => {
    kept = await readControl(id);
    await report();
  });
  return {
    element: make("div", {}, file, preview, message, table),
    facts: (facts) => (georeferenced = Boolean(facts.crs)),
  };
}
