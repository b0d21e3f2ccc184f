// The sheet of the calibration dance, drawn again with every message while it is open.

import { byId, html, render } from "../shared/dom.js";
import { axisRows, next, steps } from "./dance_captions.js";

/** @import {Message} from "./messages" */

const dialog = byId("dance", HTMLDialogElement);

/** Opens the sheet. */
export function showDance(/** @type {Message} */ newest) {
  byId("more", HTMLDialogElement).close();
  dialog.showModal();
  drawDance(newest);
}

/** Draws the sheet if it is open. */
export function drawDance(/** @type {Message} */ { motion, loop }) {
  if (!dialog.open) return;
  render(next(motion, loop), byId("dance-next"));
  render(
    steps(motion, loop).map(
      ({ name, text, done, now }) =>
        html`<li class=${done ? "good" : ""}>
          <b>${done ? "✓ " : ""}${name}</b> ${text}<small>${now}</small>
        </li>`,
    ),
    byId("dance-steps"),
  );
  render(
    axisRows(motion).map(
      ([quantity, ...cells]) =>
        html`<tr>
          <th scope="row">${quantity}</th>
          ${cells.map((cell) => html`<td class=${cell.startsWith("✓") ? "good" : ""}>${cell}</td>`)}
        </tr>`,
    ),
    byId("dance-axes"),
  );
}
