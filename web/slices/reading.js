// How a reference file is read: its frame and unit, and for a table its columns, before it is used.

import { addReference, previewReference } from "../shared/api.js";
import { attempt, make } from "../shared/dom.js";
import { choice, columnTable, missing, UNITS } from "./columns.js";

/** @type {Array<[string, string]>} */
const FRAMES = [
  ["auto", "Frame: as the file says"],
  ["map", "In the map's frame"],
  ["crs", "In the map's CRS"],
];

/** Reads files as references; `added(reference)` is called with each new one. */
export function referenceReader({ id, message, added }) {
  const asked = { frame: "auto", unit: "" };
  const frame = choice("Coordinates of the reference", FRAMES, "auto", (value) => {
    asked.frame = value;
  });
  const unit = choice(
    "Unit of the reference",
    [["", "Unit: as the file says"], ...UNITS],
    "",
    (value) => {
      asked.unit = value;
    },
  );
  const table = make("div", { hidden: true });

  function close() {
    table.hidden = true;
    table.replaceChildren();
  }

  /** Shows the rows of a table first; other files state what they hold. */
  async function read(path) {
    close();
    const file = { path, frame: asked.frame, columns: [], unit: asked.unit || null };
    const { table: found } = await previewReference(id, file);
    if (found) show(file, found);
    else await use(file);
  }

  function show(file, found) {
    const button = (text, action) => {
      const made = make("button", { type: "button" }, text);
      made.addEventListener("click", async () => {
        made.disabled = true;
        await attempt(message, action);
        made.disabled = false;
      });
      return made;
    };
    const again = async (columns, chosen) => {
      start.disabled = true; // until the server has read the rows with this choice
      const open = missing(columns);
      const next = { ...file, columns, unit: chosen ?? file.unit };
      if (open) return show(next, { ...found, columns, question: `${open}.` });
      const fresh = await attempt(message, () => previewReference(id, next));
      return fresh ? show(next, fresh.table) : show(file, found);
    };
    const start = button("Use these columns", () => use({ ...file, columns: found.columns }));
    start.disabled = Boolean(found.question && missing(found.columns));
    table.hidden = false;
    table.replaceChildren(
      make("p", {}, make("strong", {}, file.path.split("/").at(-1))),
      columnTable(found, again),
      make(
        "div",
        { className: "buttons" },
        start,
        button("Cancel", async () => close()),
      ),
    );
  }

  async function use(file) {
    const reference = await addReference(id, file);
    close();
    await added(reference);
  }

  return { read, fields: [frame, unit], element: table };
}
