// Control and check points: import, pick in the slice, residuals with pass or fail.

import {
  controlFileUrl,
  keepControl,
  previewControl,
  readControl,
  readControlReport,
  readSurface,
} from "../shared/api.js";
import { attempt, make } from "../shared/dom.js";

const MAX_ROWS = 300;
const MAX_NAMED = 10;
const cm = (m) => (m * 100).toFixed(1);
/** Error ellipse and height: long axis x short axis at the azimuth of the long one, height. */
const stated = (one) =>
  one
    ? `${cm(one.major_m)} × ${cm(one.minor_m)} at ${one.azimuth_deg.toFixed(0)}°, ${cm(one.up_m)}`
    : "–";
const named = (ids) =>
  ids.slice(0, MAX_NAMED).join(", ") +
  (ids.length > MAX_NAMED ? ` and ${ids.length - MAX_NAMED} more` : "");

export function controlPanel({ id, change, point: pointAt, measured }) {
  const message = make("p", { className: "error", role: "alert" });
  const preview = make("div", {});
  const table = make("div", {});
  const file = make("input", { type: "file", accept: ".csv,.txt", ariaLabel: "Survey file" });
  /** @type {import("../shared/http_types").ControlState} */
  let kept = { points: [], frame: "map", picks: {}, version: 0 };
  let last = Promise.resolve();
  let georeferenced = false;

  file.addEventListener(
    "change",
    () => file.files[0] && attempt(message, () => look(file.files[0])),
  );

  async function look(chosen, order = null) {
    const data = new Uint8Array(await chosen.arrayBuffer());
    if (data.length > 600_000)
      throw new Error("The file has more than 600 kB; a list of points is smaller");
    let binary = "";
    for (const one of data) binary += String.fromCharCode(one);
    const found = await previewControl(id, { name: chosen.name, base64: btoa(binary), order });
    const rows = found.points
      .slice(0, 5)
      .map((one) =>
        make(
          "tr",
          {},
          make("th", { scope: "row" }, one.id),
          ...one.xyz_m.map((x) => make("td", { className: "number" }, x.toFixed(3))),
        ),
      );
    const button = (text, action) =>
      make("button", { type: "button", onclick: () => attempt(message, action) }, text);
    const use = (frame) => () => keep(() => ({ points: found.points, frame, picks: {} }));
    preview.replaceChildren(
      make(
        "p",
        {},
        `${found.points.length} points, separated by "${found.delimiter}", ` +
          `decimal "${found.decimal}"`,
      ),
      make(
        "table",
        {},
        make(
          "thead",
          {},
          make(
            "tr",
            {},
            ...["Point", "East, x", "North, y", "Height"].map((text, k) =>
              make("th", { scope: "col", className: k ? "number" : "" }, text),
            ),
          ),
        ),
        make("tbody", {}, ...rows),
      ),
      ...found.skipped.slice(0, 5).map((text) => make("p", { className: "error" }, text)),
      found.question ? make("p", {}, found.question) : "",
      make(
        "div",
        { className: "buttons" },
        button("Swap east and north", () => look(chosen, found.order === "NE" ? "EN" : "NE")),
        button("Use, in the map's frame", use("map")),
        ...(georeferenced ? [button("Use, in the map's CRS", use("crs"))] : []),
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
      if (error.status !== 409 || !tries) throw error;
      kept = await readControl(id);
      return write(edit, tries - 1);
    }
    preview.replaceChildren();
    return report();
  }

  const put = (places) => keep((now) => ({ ...now, picks: { ...now.picks, ...places } }));

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
    const head = ["Point", "Role", "dE", "dN", "dU", "2D", "3D", "1 σ stated [cm]", ""].map(
      (text, k) => make("th", { scope: "col", className: k > 1 ? "number" : "" }, text),
    );
    const all = make(
      "button",
      { type: "button", onclick: () => attempt(message, () => everySurface(all)) },
      "All on the nearest surface",
    );
    const file = (ending, text, more) =>
      make("a", { className: "button", href: controlFileUrl(id, ending), ...more }, text);
    table.replaceChildren(
      verdict(found),
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
        file("csv", "Residuals as CSV", { download: "" }),
        file("html", "Sheet to print and sign", { target: "_blank", rel: "noopener" }),
      ),
    );
  }

  function verdict({ passed, judged_by, missing, outdated }) {
    const left = [
      missing.length ? `${missing.length} not measured yet` : "",
      outdated.length
        ? `${outdated.length} measured in an earlier map only, not counted: measure them again`
        : "",
    ].filter(Boolean);
    const text =
      passed === null
        ? "– No check point measured yet"
        : passed
          ? `✓ Within the limits at the ${judged_by} points`
          : `✕ Outside the limits at the ${judged_by} points`;
    return make(
      "p",
      { className: `verdict ${passed === null ? "" : passed ? "good" : "bad"}` },
      [text, ...left].join(" · "),
    );
  }

  async function everySurface(button) {
    button.disabled = true;
    const places = {};
    const without = [];
    for (const one of kept.points) {
      button.textContent = `${one.id}…`;
      const { surface } = await readSurface(id, one.id);
      if (surface) places[one.id] = surface;
      else without.push(one.id);
    }
    await put(places);
    if (without.length) message.textContent = `No surface within 30 cm of ${named(without)}`;
  }

  function row(one, residual, earlier) {
    const values = residual
      ? [residual.east_m, residual.north_m, residual.up_m, residual.d2_m, residual.d3_m]
          .map(cm)
          .concat(stated(residual.stated))
      : ["", "", "", "", "", ""];
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
      ...(earlier
        ? [make("td", { colSpan: values.length, className: "quiet" }, "found in an earlier map")]
        : values.map((text) => make("td", { className: "number" }, text))),
      make(
        "td",
        {},
        make(
          "span",
          { className: "buttons" },
          button("Go", () => go(one), `Go to ${one.id}`),
          button("Here", () => pick(one), `${one.id} is the picked point`),
          button("Surface", () => surface(one), `${one.id} on the nearest surface`),
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
    await put({ [one.id]: picked.p_map });
  }

  async function surface(one) {
    const { surface: at } = await readSurface(id, one.id);
    if (!at) throw new Error(`No surface within 30 cm of ${one.id}`);
    await put({ [one.id]: at });
  }

  /** The limits of one role, with what was measured. */
  function figures(one) {
    const cell = (text) => make("td", { className: "number" }, text);
    const line = (limit) =>
      make(
        "tr",
        {},
        make("th", { scope: "row" }, limit.label),
        make(
          "td",
          { className: limit.holds ? "good" : "bad" },
          limit.holds ? "✓ holds" : "✕ exceeded",
        ),
        cell(cm(limit.value_m)),
        cell(`≤ ${Math.round(limit.limit_m * 100)}`),
      );
    const head = [
      `${one.points} ${one.role} point${one.points === 1 ? "" : "s"}`,
      "",
      "Measured [cm]",
      "Limit",
    ].map((text, k) => make("th", { scope: "col", className: k > 1 ? "number" : "" }, text));
    return make(
      "div",
      { className: "figures" },
      make(
        "div",
        { className: "scroll" },
        make(
          "table",
          {},
          make("thead", {}, make("tr", {}, ...head)),
          make("tbody", {}, ...one.requirements.map(line)),
        ),
      ),
      make(
        "p",
        { className: "quiet" },
        `RMSE ${one.rmse_m.map((rmse, axis) => `${"ENU"[axis]} ${cm(rmse)}`).join("  ")}  ` +
          `3D ${cm(one.rmse_3d_m)} cm`,
      ),
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
