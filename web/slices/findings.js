// What is found with slices: double walls, distances to a reference, control points; and files to take away.

import { make } from "../shared/dom.js";
import { controlPanel } from "./control.js";
import { doublesPanel } from "./doubles.js";
import { exportPanel } from "./export.js";
import { referencePanel } from "./reference.js";

/** Fills the section; what it returns is told of every change. */
export function findings(root, page) {
  /** @type {Array<[string, any]>} */
  const panels = [
    ["Double walls", doublesPanel(page)],
    ["Compare with a reference", referencePanel(page)],
    ["Control and check points", controlPanel(page)],
    ["Export", exportPanel(page)],
  ];
  root.replaceChildren(
    ...panels.map(([words, { element }]) =>
      make("details", { className: "panel" }, make("summary", {}, words), element),
    ),
  );
  const tell = (what) => (value) => panels.forEach(([, panel]) => panel[what]?.(value));
  return { show: tell("show"), facts: tell("facts"), picked: tell("picked") };
}
