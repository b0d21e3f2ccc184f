// How a reference file is read: its frame and unit, and for a table its columns, before it is used.

import { addReference, previewReference } from "../shared/api.js";
import { attempt, html, nothing } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { choice, columnTable, missing, UNITS } from "./columns.js";

/**
 * @import {ListedReference, ReferenceFile, TablePreview} from "../shared/http_types"
 * @import {Columns, Unit} from "./columns.js"
 * @typedef {NonNullable<ReferenceFile["frame"]>} Frame
 * @typedef {{file: ReferenceFile, table: TablePreview}} Reading a table that is to be confirmed
 */

/** @type {Array<[string, string]>} */
const FRAMES = [
  ["auto", t("frame-auto")],
  ["map", t("frame-map")],
  ["crs", t("frame-crs")],
];

/** Reads files as references. */
export class ReferenceReader {
  #state = {
    frame: /** @type {Frame} */ ("auto"),
    unit: /** @type {Unit | ""} */ (""),
    reading: /** @type {Reading | null} */ (null),
    busy: false, // until the server has read the rows with a choice
  };
  #id;
  #on;

  /**
   * @param {string} id of the project
   * @param {{draw: () => void, message: () => HTMLElement,
   *   added: (reference: ListedReference) => Promise<void>}} on `draw` is called after changes
   */
  constructor(id, on) {
    this.#id = id;
    this.#on = on;
  }

  /** The choices of frame and unit. */
  get fields() {
    const { frame, unit } = this.#state;
    const setFrame = (/** @type {string} */ value) =>
      this.#change({ frame: /** @type {Frame} */ (value) });
    const setUnit = (/** @type {string} */ value) =>
      this.#change({ unit: /** @type {Unit | ""} */ (value) });
    return [
      choice(t("coordinates-of-reference"), FRAMES, frame, setFrame),
      choice(t("unit-of-reference"), [["", t("unit-auto")], ...UNITS], unit, setUnit),
    ];
  }

  /** Shows the rows of a table first; other files state what they hold. */
  async read(/** @type {string} */ path) {
    const { frame, unit } = this.#state;
    this.#change({ reading: null });
    const file = { path, frame, columns: [], unit: unit || null };
    const { table } = await previewReference(this.#id, file);
    if (table) this.#change({ reading: { file, table } });
    else await this.#use(file);
  }

  /** The rows of a table, with a question if its columns are not certain. */
  get element() {
    const { reading, busy } = this.#state;
    if (!reading) return nothing;
    const { file, table } = reading;
    const use = () =>
      attempt(this.#on.message(), () => this.#use({ ...file, columns: table.columns }));
    const blocked = busy || Boolean(table.question && missing(table.columns));
    return html`<p><strong>${file.path.split("/").at(-1)}</strong></p>
      ${columnTable(table, (columns, unit) => this.#again(reading, columns, unit))}
      <div class="buttons">
        <button type="button" ?disabled=${blocked} @click=${use}>${t("use-columns")}</button
        ><button type="button" @click=${() => this.#change({ reading: null })}>
          ${t("cancel")}
        </button>
      </div>`;
  }

  /**
   * Reads the rows with other columns or another unit, once the columns are complete.
   * @param {Reading} reading
   * @param {Columns} columns
   * @param {Unit | null} unit
   */
  async #again({ file, table }, columns, unit) {
    const next = { ...file, columns, unit: unit ?? file.unit };
    const open = missing(columns);
    if (open) {
      const asked = { ...table, columns, question: `${open}.` };
      return this.#change({ reading: { file: next, table: asked } });
    }
    this.#change({ busy: true });
    const fresh = await attempt(this.#on.message(), () => previewReference(this.#id, next));
    const reading = fresh?.table ? { file: next, table: fresh.table } : { file, table };
    this.#change({ busy: false, reading });
  }

  async #use(/** @type {ReferenceFile} */ file) {
    const reference = await addReference(this.#id, file);
    this.#change({ reading: null });
    await this.#on.added(reference);
  }

  #change(/** @type {object} */ changes) {
    Object.assign(this.#state, changes);
    this.#on.draw();
  }
}
