// References: add, align, remove; the table of slices against one (V Table 3.2).

import {
  alignReference,
  browse,
  compareCsvUrl,
  compareSlices,
  removeReference,
} from "../shared/api.js";
import { attempt, make } from "../shared/dom.js";
import { bytes, count } from "../shared/format.js";
import { Sending, sorted } from "../projects/resumable_upload.js";
import { openAlignment } from "./align.js";
import { comparison, METHODS } from "./comparison.js";
import { ofInput } from "./picking.js";
import { referenceReader } from "./reading.js";
import { planeOf, moved } from "./state.js";

const KINDS = ".ply,.pcd,.las,.laz,.e57,.xyz,.txt,.csv,.obj,.stl";

export function referencePanel({ id, change, state, reload }) {
  const message = make("p", { className: "error", role: "alert" });
  const list = make("div", {});
  const path = make("input", {
    placeholder: "Path on this computer",
    ariaLabel: "Path of the reference",
    autocomplete: "off",
    spellcheck: false,
  });
  const folder = make("div", { className: "folder", hidden: true });
  const reader = referenceReader({ id, message, added });
  const which = make(
    "select",
    { ariaLabel: "Slices to compare" },
    make("option", { value: "usual" }, "8 slices over the map, 2 cm"),
    make("option", { value: "this" }, "This slice"),
    make("option", { value: "repeated" }, "This slice, repeated"),
  );
  const method = make(
    "select",
    { ariaLabel: "Method of the distances" },
    ...Object.entries(METHODS).map(([key, text]) =>
      make("option", { value: key }, `Distances ${text}`),
    ),
  );
  const table = make("div", {});
  const busy = (button, action) => async () => {
    button.disabled = true;
    await attempt(message, action);
    button.disabled = false;
  };
  const make_ = (text, action) => {
    const button = make("button", { type: "button" }, text);
    button.addEventListener("click", busy(button, action));
    return button;
  };

  const file = make("input", {
    type: "file",
    hidden: true,
    accept: KINDS,
    ariaLabel: "Reference file",
    onchange: () => attempt(message, upload),
  });
  const text = make("span", { role: "status" });
  const bar = make("progress", { max: 1, ariaLabel: "Upload of the reference" });
  const stop = make("button", { type: "button" }, "Stop");
  const sendingNow = make("div", { className: "row", hidden: true }, text, bar, stop);
  const choose = make("button", { type: "button", onclick: () => file.click() }, "Upload file…");

  /** Sends the file like a recording (it goes on after a break), then uses it. */
  async function upload() {
    const sending = new Sending(sorted(ofInput(file)));
    file.value = ""; // the same file may be chosen again
    stop.onclick = () => attempt(message, () => sending.remove());
    sending.addEventListener("change", () => {
      text.textContent =
        sending.text || `${sending.name}: ${bytes(sending.sent)} of ${bytes(sending.total)}`;
      bar.value = sending.total ? sending.sent / sending.total : 1;
    });
    choose.disabled = true;
    sendingNow.hidden = false;
    try {
      await sending.start();
      if (sending.state === "failed") {
        sending.error.message += "; choose the same file again to go on";
        throw sending.error;
      }
      if (sending.state !== "done") return;
      text.textContent = `${sending.name} is being read`;
      path.value = sending.recording;
      await add();
    } finally {
      choose.disabled = false;
      sendingNow.hidden = true;
    }
  }

  const add = () => reader.read(path.value);

  async function added(reference) {
    path.value = "";
    await reload();
    change({ ref: reference.id, color: "distance", lo: null, hi: null }, { keep: true });
  }

  async function openFolder(at) {
    const entries = await browse(at);
    folder.hidden = false;
    const up = at
      ? [
          make(
            "button",
            {
              type: "button",
              onclick: () =>
                attempt(message, () => openFolder(at.split("/").slice(0, -1).join("/"))),
            },
            "‥ Up",
          ),
        ]
      : [];
    folder.replaceChildren(
      ...up,
      ...entries.map((entry) => {
        const open = () => {
          if (entry.folder) return attempt(message, () => openFolder(entry.path));
          path.value = entry.path;
          folder.hidden = true;
        };
        return make(
          "button",
          { type: "button", onclick: open },
          make("span", {}, entry.folder ? `${entry.name}/` : entry.name),
          entry.folder ? null : make("small", {}, bytes(entry.bytes)),
        );
      }),
    );
  }

  async function align(one, how) {
    await alignReference(id, one.id, { how });
    await realigned();
  }

  async function realigned() {
    table.replaceChildren(); // of the alignment before
    await reload();
    change({}, { keep: true });
  }

  async function remove(one) {
    await removeReference(id, one.id);
    if (state().ref === one.id) change({ ref: "", color: "height" }, { keep: true });
    await reload();
  }

  function planes() {
    const now = state();
    if (which.value === "usual") return [];
    if (which.value === "this") return [planeOf(now)];
    return Array.from({ length: now.count }, (_, k) => planeOf(moved(now, k * now.spacing)));
  }

  async function compare() {
    const ask = {
      reference: state().ref,
      method: method.value,
      planes: planes(),
      source: state().source,
    };
    if (!ask.reference) throw new Error("Choose a reference first");
    change({ method: method.value }, { keep: true });
    const found = await compareSlices(id, ask);
    table.replaceChildren(...comparison(found, compareCsvUrl(id, ask)));
  }

  function rows(facts) {
    list.replaceChildren(
      ...facts.references.map((one) => {
        const size = one.points
          ? `${count(one.points)} points`
          : `${count(one.triangles)} triangles`;
        return make(
          "div",
          { className: "reference-row" },
          make("strong", {}, one.name),
          make("span", { className: "quiet" }, `${size}, alignment: ${one.alignment}`),
          one.notes?.length ? make("small", { className: "quiet" }, one.notes.join(" ")) : null,
          one.fit
            ? make("span", { className: one.fit.startsWith("✕") ? "bad" : "quiet" }, one.fit)
            : null,
          make(
            "span",
            { className: "buttons" },
            make_("Show", async () =>
              change({ ref: one.id, color: "distance", lo: null, hi: null }, { keep: true }),
            ),
            make_("Align by ICP", () => align(one, "icp")),
            make_("Align by pairs", () => openAlignment(id, one, realigned)),
            one.can_undo ? make_("Undo alignment", () => align(one, "undo")) : null,
            make_("No alignment", () => align(one, "none")),
            make_("Remove", () => remove(one)),
          ),
        );
      }),
    );
  }

  const element = make(
    "div",
    {},
    list,
    make(
      "div",
      { className: "row" },
      choose,
      file,
      path,
      make_("Browse…", () => openFolder("")),
      ...reader.fields,
      make_("Add reference", add),
    ),
    sendingNow,
    folder,
    reader.element,
    make(
      "p",
      { className: "quiet" },
      "PLY, LAZ, LAS, E57, PCD, XYZ, CSV, OBJ or STL. Nothing is aligned unless you ask for it.",
    ),
    make("div", { className: "row" }, which, method, make_("Compare", compare)),
    message,
    table,
  );
  return { element, facts: rows };
}
