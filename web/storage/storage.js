// What takes space on the server: projects, recordings, unfinished uploads, the trash.

import {
  deleteRecording,
  projectUrl,
  readStorage,
  removeProject,
  removeUpload,
  restoreProject,
} from "../shared/api.js";
import { attempt, byId, html, nothing, render, repeat, succeeds } from "../shared/dom.js";
import { bytes, when } from "../shared/format.js";
import "../shared/page_head.js";
import { t } from "../shared/texts.js";

/** @import {StoredItem} from "../shared/http_types" */

/** @type {Record<string, string>} */
const KINDS = {
  project: t("head-project"),
  recording: t("kind-recording"),
  upload: t("kind-upload"),
  deleted: t("kind-deleted"),
};

/**
 * Asks once; resolves to whether it is to be done.
 * @returns {Promise<boolean>}
 * @param {string} title
 * @param {string} text
 */
function confirmed(title, text) {
  const dialog = byId("confirm", HTMLDialogElement);
  byId("confirm-title").textContent = title;
  byId("confirm-text").textContent = text;
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) =>
    dialog.addEventListener("close", () => resolve(dialog.returnValue === "delete"), {
      once: true,
    }),
  );
}

async function deleteAfterwards(/** @type {StoredItem} */ { kind, name, id, used_by }) {
  const consequence = used_by.length
    ? `${t("recording-used", { projects: used_by.join(", ") })} `
    : "";
  /** @type {Record<string, string>} */
  const texts = {
    recording: `${consequence}${t("restorable")}`,
    upload: t("upload-goes"),
    deleted: t("not-restorable"),
  };
  /** @type {Record<string, (id: string) => Promise<unknown>>} */
  const requests = { recording: deleteRecording, upload: removeUpload, deleted: removeProject };
  if (!(await confirmed(t("delete-ask", { name }), texts[kind] ?? ""))) return;
  if (await succeeds(byId("message"), () => requests[kind]?.(id))) await reload();
}

function actions(/** @type {StoredItem} */ item) {
  const { kind, id, name } = item;
  if (kind === "project") return html`<a class="button" href=${projectUrl(id)}>${t("open")}</a>`;
  const label = kind === "deleted" ? t("delete-now") : t("delete-open");
  /**
   * @param {string} text
   * @param {() => unknown} onclick
   */
  const button = (text, onclick) =>
    html`<button type="button" aria-label="${text} ${name}" @click=${onclick}>${text}</button>`;
  const restore = async () => {
    if (await succeeds(byId("message"), () => restoreProject(id))) await reload();
  };
  return [
    kind === "deleted" ? button(t("restore-it"), restore) : nothing,
    button(label, () => deleteAfterwards(item)),
  ];
}

function row(/** @type {StoredItem} */ item) {
  const { kind, name, bytes: size, used_by, expires } = item;
  const uses = expires ? t("until", { when: when(expires) }) : used_by.join(", ");
  return html`<tr>
    <th scope="row">${name}</th>
    <td data-label=${t("kind")}>${KINDS[kind]}</td>
    <td data-label=${t("size")}>${bytes(size)}</td>
    <td data-label=${t("used-by")}>${uses || "–"}</td>
    <td><div class="actions">${actions(item)}</div></td>
  </tr>`;
}

async function reload() {
  const view = await attempt(byId("message"), readStorage);
  if (!view) return;
  const { disk_bytes, free_bytes, server_bytes, items } = view;
  const listed = items.reduce((sum, one) => sum + one.bytes, 0);
  byId("disk").textContent = t("disk-is", {
    free: bytes(free_bytes),
    disk: bytes(disk_bytes),
    listed: bytes(listed),
    server: bytes(server_bytes),
  });
  render(
    repeat(items, ({ kind, id }) => `${kind} ${id}`, row),
    byId("items"),
  );
  byId("nothing").hidden = items.length > 0;
}

reload();
