// Control and check points: import, pick in the slice, residuals with pass or fail.

import {
  controlFileUrl,
  keepControl,
  previewControl,
  readControl,
  readControlReport,
  readSurface,
} from "../shared/api.js";
import { isRefused } from "../shared/approval.js";
import { attempt, make } from "../shared/dom.js";
import { checked } from "../shared/download.js";
import { columnTable, missing } from "./columns.js";
import { limitsForm } from "./limits.js";
import { combined } from "./measured.js";
import { figures, residualCells } from "./residual_table.js";

const MAX_ROWS = 300;
const MAX_NAMED = 10;
const without = (record, key) =>
  Object.fromEntries(Object.entries(record).filter(([name]) => name !== key));
const named = (ids) =>
  ids.slice(0, MAX_NAMED).join(", ") +
  (ids.length > MAX_NAMED ? ` and ${ids.length - MAX_NAMED} more` : "");

/** How many points were read, and where the first of them lies. */
function firstPoint(points) {
  if (!points.length) return "";
  const [one] = points;
  const [x, y, z] = one.xyz_m.map((value) => value.toFixed(3));
  return `${points.length} points; the first, ${one.id}: east ${x}, north ${y}, height ${z} m`;
}

export function controlPanel({ id, change, point: pointAt, measured }) {
  const message = make("p", { className: "error", role: "alert" });
  const status = make("p", { className: "quiet", role: "status" });
  const preview = make("div", {});
  const table = make("div", {});
  const file = make("input", { type: "file", accept: ".csv,.txt", ariaLabel: "Survey file" });
  /** @type {import("../shared/http_types").ControlState} */
  let kept = { points: [], frame: "map", picks: {}, along: {}, version: 0 };
  let mapKey = "";
  let refused = false;
  let last = Promise.resolve();
  let georeferenced = false;

  file.addEventListener(
    "change",
    () => file.files[0] && attempt(message, () => look(file.files[0])),
  );

  async function look(chosen, columns = [], unit = null) {
    const data = new Uint8Array(await chosen.arrayBuffer());
    if (data.length > 600_000)
      throw new Error("The file has more than 600 kB; a list of points is smaller");
    let binary = "";
    for (const one of data) binary += String.fromCharCode(one);
    const asked = { name: chosen.name, base64: btoa(binary), columns, unit };
    show(chosen, await previewControl(id, asked), unit);
  }

  /** The first rows of a survey file, its columns and its points, to be confirmed. */
  function show(chosen, found, unit) {
    const button = (text, action) =>
      make("button", { type: "button", onclick: () => attempt(message, action) }, text);
    const use = (frame) => () =>
      keep((now) => ({ points: found.points, frame, picks: {}, along: {}, limits: now.limits }));
    const again = (columns, other) => {
      const open = missing(columns);
      const table = { ...found.table, columns, question: `${open}.` };
      if (open) return show(chosen, { ...found, points: [], table }, other ?? unit);
      return attempt(message, () => look(chosen, columns, other ?? unit));
    };
    const swapped = { x: "y", y: "x", "-x": "-y", "-y": "-x" };
    const swap = () =>
      look(
        chosen,
        found.table.columns.map((one) => swapped[one] ?? one),
        unit,
      );
    preview.replaceChildren(
      columnTable(found.table, again),
      make("p", {}, firstPoint(found.points)),
      ...found.skipped.slice(0, 5).map((text) => make("p", { className: "error" }, text)),
      make(
        "div",
        { className: "buttons" },
        button("Swap east and north", swap),
        ...(found.points.length ? [button("Use, in the map's frame", use("map"))] : []),
        ...(found.points.length && georeferenced
          ? [button("Use, in the map's CRS", use("crs"))]
          : []),
      ),
    );
  }

  /** Applies changes one after the other to the stored state, which others may change too. */
  function keep(edit) {
    const done = last.then(() => write(edit));
    last = done.catch(() => {});
    return done;
  }

  async function write(edit, tries = 5) {
    try {
      kept = await keepControl(id, { ...edit(kept), version: kept.version });
    } catch (error) {
      if (error.status !== 409) throw error;
      kept = await readControl(id);
      if (tries) return write(edit, tries - 1);
      await report();
      throw new Error("Others change these points too: they are read again, do it once more");
    }
    preview.replaceChildren();
    return report();
  }

  /** Stores measurements {id: {p, along}}, each joined with what was measured there before. */
  const put = (measurements) =>
    keep((now) => {
      const [picks, along] = [{ ...now.picks }, { ...now.along }];
      for (const [name, one] of Object.entries(measurements)) {
        const here = now.found_in?.[name] === mapKey && along[name];
        const joined = combined(here ? { p: picks[name], along: along[name] } : null, one);
        [picks[name], along[name]] = [joined.p, joined.along];
      }
      return { ...now, picks, along };
    });

  const drop = (name) =>
    keep((now) => ({
      ...now,
      picks: without(now.picks, name),
      along: without(now.along, name),
    }));

  async function report() {
    if (!kept.points.length) {
      table.replaceChildren(
        make(
          "p",
          { className: "quiet" },
          "No points yet. ID,X,Y,Z[,Radius]; with ; and decimal comma too.",
        ),
      );
      return;
    }
    const found = /** @type {any} */ (await readControlReport(id));
    const residuals = new Map(found.rows.map((one) => [one.id, one]));
    const earlier = new Set(found.outdated);
    const head = [
      ...["Point", "Role", "dE", "dN", "dU", "2D", "3D", "Across"],
      ...["1 σ stated [cm]", "Residual / σ", ""],
    ].map((text, k) => make("th", { scope: "col", className: k > 1 ? "number" : "" }, text));
    const all = make(
      "button",
      { type: "button", onclick: () => attempt(message, () => everySurface(all)) },
      "All on the nearest surface",
    );
    const file = (ending, text, more) =>
      make(
        "a",
        { className: "button", href: controlFileUrl(id, ending, refused), ...more },
        refused ? `${text}, as a draft` : text,
      );
    table.replaceChildren(
      make("p", { className: `verdict ${found.verdict.level}` }, found.verdict.text),
      earlier.size
        ? make(
            "p",
            {},
            `Measured in an earlier map or version only, not counted: ${named(found.outdated)}. `,
            "Measure them again.",
          )
        : "",
      limitsForm(kept.limits, found.limits, setLimits),
      found.hint ? make("p", { className: "bad" }, `✕ ${found.hint}`) : "",
      ...found.figures.map(figures),
      make(
        "div",
        { className: "scroll" },
        make(
          "table",
          {},
          make("thead", {}, make("tr", {}, ...head)),
          make(
            "tbody",
            {},
            ...kept.points
              .slice(0, MAX_ROWS)
              .map((one) => row(one, residuals.get(one.id), earlier.has(one.id))),
          ),
        ),
      ),
      make(
        "p",
        { className: "quiet" },
        "Map minus survey [cm]. – = not measured, counts nowhere: a point on a surface is ",
        "measured across it only (Across); a point picked in a slice, in the plane of the slice. ",
        "Pick it in a second slice for the third component.",
      ),
      kept.points.length > MAX_ROWS
        ? make(
            "p",
            { className: "quiet" },
            `The first ${MAX_ROWS} of ${kept.points.length} points; the files have all.`,
          )
        : "",
      make(
        "div",
        { className: "buttons" },
        all,
        checked(file("csv", "Residuals as CSV", { download: "" }), { message, status }),
        file("html", "Sheet to print and sign", { target: "_blank", rel: "noopener" }),
      ),
    );
  }

  /** null = the usual limits. */
  const setLimits = (limits) =>
    attempt(message, () => keep((now) => (limits ? { ...now, limits } : without(now, "limits"))));

  async function everySurface(button) {
    button.disabled = true;
    const places = {};
    const without = [];
    for (const one of kept.points) {
      button.textContent = `${one.id}…`;
      const { surface, normal } = await readSurface(id, one.id);
      if (surface) places[one.id] = { p: surface, along: [normal] };
      else without.push(one.id);
    }
    await put(places);
    if (without.length) message.textContent = `No flat surface within 30 cm of ${named(without)}`;
  }

  function row(one, residual, earlier) {
    const role = make(
      "select",
      { ariaLabel: `Role of ${one.id}` },
      make("option", { value: "check" }, "check"),
      make("option", { value: "control" }, "control"),
    );
    role.value = one.role;
    role.addEventListener("change", () =>
      attempt(message, () =>
        keep((now) => ({
          ...now,
          points: now.points.map((p) => (p.id === one.id ? { ...p, role: role.value } : p)),
        })),
      ),
    );
    const button = (text, action, label) =>
      make(
        "button",
        {
          type: "button",
          className: "go",
          ariaLabel: label,
          onclick: () => attempt(message, action),
        },
        text,
      );
    return make(
      "tr",
      {},
      make("th", { scope: "row" }, one.id),
      make("td", {}, role),
      ...residualCells(residual, earlier),
      make(
        "td",
        {},
        make(
          "span",
          { className: "buttons" },
          button("Go", () => go(one), `Go to ${one.id}`),
          button("Here", () => pick(one), `${one.id} is the picked point`),
          button("Surface", () => surface(one), `${one.id} on the nearest surface`),
          residual || earlier ? button("Clear", () => drop(one.id), `Clear ${one.id}`) : "",
        ),
      ),
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
    await put({ [one.id]: { p: picked.p_map, along: picked.along } });
  }

  async function surface(one) {
    const { surface: at, normal } = await readSurface(id, one.id);
    if (!at)
      throw new Error(`No flat surface within 30 cm of ${one.id}: pick it in the slice, then Here`);
    await put({ [one.id]: { p: at, along: [normal] } });
  }

  attempt(message, async () => {
    kept = await readControl(id);
    await report();
  });
  return {
    element: make("div", {}, file, preview, status, message, table),
    facts: (facts) => {
      [georeferenced, mapKey] = [Boolean(facts.crs), facts.key];
      if (refused === isRefused(facts.approval)) return;
      refused = !refused;
      attempt(message, report);
    },
  };
}
