// The sheet of the calibration dance, drawn again with every message while it is open.

import { byId, make } from "../shared/dom.js";
import { axisRows, next, steps } from "./dance_captions.js";
import { fill } from "./health.js";

const dialog = byId("dance", HTMLDialogElement);

/** Opens the sheet. */
export function showDance(newest) {
  byId("more", HTMLDialogElement).close();
  dialog.showModal();
  drawDance(newest);
}

/**
 * Draws the sheet if it is open.
 * @param {{motion?: any, loop?: any}} newest
 */
export function drawDance({ motion, loop }) {
  if (!dialog.open) return;
  const text = next(motion, loop);
  if (byId("dance-next").textContent !== text) byId("dance-next").textContent = text;
  fill(byId("dance-steps"), steps(motion, loop), ({ name, text, done, now }) =>
    make(
      "li",
      { className: done ? "good" : "" },
      make("b", {}, `${done ? "✓ " : ""}${name}`),
      ` ${text}`,
      make("small", {}, now),
    ),
  );
  fill(byId("dance-axes"), axisRows(motion), ([quantity, ...cells]) =>
    make(
      "tr",
      {},
      make("th", { scope: "row" }, quantity),
      ...cells.map((cell) => make("td", { className: cell.startsWith("✓") ? "good" : "" }, cell)),
    ),
  );
}
