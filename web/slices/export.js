// Slices as files: sheets at a true scale, points, georeferenced images.

import { sliceFileUrl } from "../shared/api.js";
import { approvalLines } from "../shared/approval_lines.js";
import { fill, make } from "../shared/dom.js";
import { checked } from "../shared/download.js";

const KINDS = [
  ["png", "PNG", "sheet, 300 dpi"],
  ["svg", "SVG", "sheet"],
  ["pdf", "PDF", "sheet"],
  ["dxf", "DXF", "points, one layer per slice, meters"],
  ["tif", "GeoTIFF", "georeferenced image"],
  ["laz", "LAZ", "points, all fields"],
  ["csv", "CSV", "points"],
];
const SCALES = [10, 20, 25, 50, 100, 200, 250, 500, 1000];

export function exportPanel({ id, change, state, ask }) {
  const part = make(
    "select",
    { ariaLabel: "What is exported" },
    make("option", { value: "all" }, "Whole slice"),
    make("option", { value: "seen" }, "What is seen"),
  );
  const size = make(
    "select",
    { ariaLabel: "Paper" },
    ...["a4", "a3", "a2", "a1"].map((one) => make("option", { value: one }, one.toUpperCase())),
  );
  const scale = make(
    "select",
    { ariaLabel: "Scale" },
    make("option", { value: "0" }, "Largest scale that fits"),
    ...SCALES.map((one) => make("option", { value: String(one) }, `1 : ${one}`)),
  );
  const flat = make("input", { type: "checkbox", id: "flat" });
  const draft = make("input", { type: "checkbox", id: "draft" });
  const approval = make("div", {});
  const message = make("p", { className: "error", role: "alert" });
  const status = make("p", { className: "quiet", role: "status" });
  const count = make("input", {
    type: "number",
    min: 1,
    max: 200,
    value: "1",
    ariaLabel: "Number of slices",
  });
  const spacing = make("input", {
    type: "number",
    step: "0.05",
    value: "0.5",
    ariaLabel: "Spacing of slices",
  });
  const links = KINDS.map(([ending, name]) => [
    ending,
    checked(make("a", { download: "" }, name), { message, status }),
  ]);

  function wanted() {
    const { window, ...look } = ask();
    for (const key of ["width", "height", "ground"]) delete look[key]; // of the screen
    return {
      ...look,
      window: part.value === "seen" ? (window ?? null) : null,
      count: state().count,
      spacing_m: state().spacing,
      size: size.value,
      scale: Number(scale.value),
      flat: flat.checked,
      draft: draft.checked,
    };
  }

  /** The links stay: one that is replaced under the finger is not followed. */
  function draw() {
    for (const [ending, link] of links) link.href = sliceFileUrl(id, ending, wanted());
  }

  for (const control of [part, size, scale, flat, draft]) control.addEventListener("change", draw);
  count.addEventListener(
    "change",
    () =>
      count.valueAsNumber >= 1 &&
      change({ count: Math.round(count.valueAsNumber) }, { keep: true }),
  );
  spacing.addEventListener(
    "change",
    () =>
      Number.isFinite(spacing.valueAsNumber) &&
      change({ spacing: spacing.valueAsNumber }, { keep: true }),
  );
  const field = (text, control) => make("label", {}, make("span", {}, text), control);
  return {
    element: make(
      "div",
      {},
      make(
        "div",
        { className: "row" },
        field("Part", part),
        field("Paper", size),
        field("Scale", scale),
        field("Slices", count),
        field("Spacing [m]", spacing),
      ),
      make(
        "label",
        { className: "check" },
        flat,
        make("span", {}, "DXF laid flat: u, v instead of coordinates"),
      ),
      approval,
      make(
        "label",
        { className: "check" },
        draft,
        make("span", {}, "As a draft, without the approval of the map"),
      ),
      make(
        "ul",
        { className: "files" },
        ...links.map(([, link], k) => make("li", {}, link, make("small", {}, KINDS[k][2]))),
      ),
      status,
      message,
    ),
    show: draw,
    facts: (found) => fill(approval, ...approvalLines(found.approval)),
  };
}
