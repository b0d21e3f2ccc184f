// Dialogs that are made when they are needed, and are gone when they close.

import { html, render, targetOf } from "./dom.js";
import { t } from "./texts.js";

/** @import {Content} from "./dom.js" */

/**
 * Opens a dialog with a title and what is below it.
 * @param {string} title
 * @param {Content} content
 */
export function openDialog(title, content) {
  const dialog = document.createElement("dialog");
  dialog.setAttribute("aria-labelledby", "dialog-title");
  render(
    html`<h2 id="dialog-title">${title}</h2>
      ${content}`,
    dialog,
  );
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}

/** The dialog an event began in. */
const dialogOf = (/** @type {Event} */ event) =>
  /** @type {HTMLDialogElement} */ (targetOf(event).closest("dialog"));

/** A button that closes its dialog. */
export const closeButton = (text = t("cancel")) =>
  html`<button type="button" @click=${(/** @type {Event} */ event) => dialogOf(event).close()}>
    ${text}
  </button>`;
