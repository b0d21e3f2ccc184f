// What takes space on the server: projects, recordings, unfinished uploads, the trash.

import {
  deleteRecording,
  projectUrl,
  readStorage,
  removeProject,
  removeUpload,
  restoreProject,
} from "../shared/api.js";
import { attempt, byId, make, succeeds } from "../shared/dom.js";
import { bytes, when } from "../shared/format.js";
import "../shared/page_head.js";

const KINDS = {
  project: "Project",
  recording: "Recording, uploaded",
  upload: "Unfinished upload",
  deleted: "Deleted",
};

/** Asks once; resolves to whether it is to be done. */
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

async function deleteAfterwards({ kind, name, id, used_by }) {
  const consequence = used_by.length
    ? `${used_by.join(", ")} keep their maps, but cannot be processed from it again. `
    : "";
  const texts = {
    recording: `${consequence}It can be restored for a week.`,
    upload: "What was received is removed at once.",
    deleted: "It cannot be restored afterwards.",
  };
  const requests = { recording: deleteRecording, upload: removeUpload, deleted: removeProject };
  if (!(await confirmed(`Delete ${name}?`, texts[kind]))) return;
  if (await succeeds(byId("message"), () => requests[kind](id))) await reload();
}

function actions(item) {
  const { kind, id, name } = item;
  if (kind === "project") return [make("a", { className: "button", href: projectUrl(id) }, "Open")];
  const label = kind === "deleted" ? "Delete now" : "Delete…";
  const button = (text, onclick) =>
    make("button", { type: "button", ariaLabel: `${text} ${name}`, onclick }, text);
  const restore = async () => {
    if (await succeeds(byId("message"), () => restoreProject(id))) await reload();
  };
  return [
    ...(kind === "deleted" ? [button("Restore", restore)] : []),
    button(label, () => deleteAfterwards(item)),
  ];
}

function row(item) {
  const { kind, name, bytes: size, used_by, expires } = item;
  const uses = expires ? `until ${when(expires)}` : used_by.join(", ");
  return make(
    "tr",
    {},
    make("th", { scope: "row" }, name),
    make("td", { "data-label": "Kind" }, KINDS[kind]),
    make("td", { "data-label": "Size" }, bytes(size)),
    make("td", { "data-label": "Used by" }, uses || "–"),
    make("td", {}, make("div", { className: "actions" }, ...actions(item))),
  );
}

async function reload() {
  const view = await attempt(byId("message"), readStorage);
  if (!view) return;
  const { disk_bytes, free_bytes, server_bytes, items } = view;
  const listed = items.reduce((sum, one) => sum + one.bytes, 0);
  byId("disk").textContent =
    `${bytes(free_bytes)} of ${bytes(disk_bytes)} are free. Listed here: ${bytes(listed)}; ` +
    `queue, logs and caches of the server: ${bytes(server_bytes)}.`;
  byId("items").replaceChildren(...items.map(row));
  byId("nothing").hidden = items.length > 0;
}

reload();
