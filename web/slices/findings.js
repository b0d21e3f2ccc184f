// Findings in slices: double walls, distances to a reference, control points; and exported files.

import { make } from "../shared/dom.js";
import { controlPanel } from "./control.js";
import { doublesPanel } from "./doubles.js";
import { exportPanel } from "./export.js";
import { referencePanel } from "./reference.js";

/** Fills the section; returns callbacks for changes of the slice, the map and the picked point. */
export function findings(root, page) {
  /** @type {Array<[string, any]>} */
  const panels = [
    ["Double walls", doublesPanel(page)],
    ["Compare with a reference", referencePanel(page)],
    ["Control and check points", controlPanel(page)],
    ["Export", exportPanel(page)],
  ];
  root.replaceChildren(
    ...panels.map(([text, { element }]) =>
      make("details", { className: "panel" }, make("summary", {}, text), element),
    ),
  );
  const forward = (what) => (value) => panels.forEach(([, panel]) => panel[what]?.(value));
  return { show: forward("show"), facts: forward("facts"), picked: forward("picked") };
}
