// Sends the files of one recording, resumes after an interruption, reports progress. No DOM.

import {
  ApiError,
  beginUpload,
  createFile,
  deleteRecording,
  listUploadFiles,
  listUploads,
  readOffset,
  readUpload,
  removeUpload,
  sendBytes,
} from "../shared/api.js";
import { t } from "../shared/texts.js";

/**
 * @import {UploadView} from "../shared/http_types"
 * @import {Picked} from "../slices/picking.js"
 * @typedef {"waiting" | "sending" | "paused" | "trying" | "failed" | "done" | "removed"}
 *   SendingState
 * @typedef {{url: string, offset: number}} KnownFile a file that is on the server in part
 */

export const CHUNK = 8 << 20;
const SMALLEST_CHUNK = 512 << 10;
const AT_ONCE = 3;
const RATE_OVER_S = 10;
const LONGEST_WAIT_S = 30;
const SYSTEM_FILES = new Set(["Thumbs.db", "desktop.ini"]);

/**
 * Of picked or dropped {file, name}: the name of the whole, the files with names below it, and how
 * many were left out.
 */
export function sorted(/** @type {Picked[]} */ picked) {
  const meant = picked.filter(({ name }) =>
    name.split("/").every((part) => !part.startsWith(".") && !SYSTEM_FILES.has(part)),
  );
  const tops = new Set(meant.map(({ name }) => name.split("/")[0]));
  const folder = tops.size === 1 && meant.every(({ name }) => name.includes("/"));
  const files = meant
    .map(({ file, name }) => ({ file, name: folder ? name.slice(name.indexOf("/") + 1) : name }))
    .sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));
  const name = folder
    ? ([...tops][0] ?? "")
    : files.length === 1
      ? (files[0]?.name ?? "")
      : "recording";
  return { name, files, leftOut: picked.length - meant.length };
}

/** A key by which the same files are recognized after an interruption. */
export async function fingerprint(/** @type {Picked[]} */ files) {
  const text = JSON.stringify(files.map(({ file, name }) => [name, file.size, file.lastModified]));
  const digest = await crypto.subtle?.digest("SHA-256", new TextEncoder().encode(text));
  if (!digest) return text.slice(0, 200);
  return [...new Uint8Array(digest)].map((one) => one.toString(16).padStart(2, "0")).join("");
}

export class Sending extends EventTarget {
  /** @type {SendingState} */
  state = "waiting";
  text = "";
  error = /** @type {unknown} */ (null); // why it failed
  sent = 0;
  recording = "";
  /** @type {UploadView | null} */
  #upload = null;
  /** @type {Map<string, KnownFile>} */
  #known = new Map(); // by name
  /** @type {Array<{t: number, sent: number}>} */
  #samples = [];
  #chunk = CHUNK;
  /** @type {AbortController | null} */
  #stop = null;
  #run = Promise.resolve(); // one at a time

  constructor(/** @type {{name: string, files: Picked[]}} */ { name, files }) {
    super();
    this.name = name;
    this.files = files;
    this.total = files.reduce((sum, { file }) => sum + file.size, 0);
  }

  /** Recent bytes per second; 0 = not known. */
  get rate() {
    const [first, last] = [this.#samples[0], this.#samples.at(-1)];
    return first && last && last.t > first.t ? (last.sent - first.sent) / (last.t - first.t) : 0;
  }

  get eta() {
    return this.rate > 0 ? (this.total - this.sent) / this.rate : null;
  }

  /** Sends what is not on the server yet. */
  start() {
    const stop = new AbortController();
    const before = this.#run;
    this.#stop = stop;
    this.#tell("sending", "");
    this.#run = before.then(() => this.#go(stop));
    return this.#run;
  }

  async #go(/** @type {AbortController} */ stop) {
    this.#samples = [];
    try {
      const upload = await this.#find(stop.signal);
      if (!upload.finished) await this.#sendAll(upload.id, stop.signal);
      const sent = await this.#again(stop.signal, () => readUpload(upload.id));
      this.recording = sent.recording;
      this.#tell("done", "");
    } catch (error) {
      this.error = error;
      if (!stop.signal.aborted) this.#tell("failed", messageOf(error));
      stop.abort();
    }
  }

  pause() {
    this.#tell("paused", "");
    this.#stop?.abort();
  }

  async remove() {
    if (this.#upload && (this.#upload.finished || this.state === "done")) {
      await deleteRecording(this.#upload.folder);
    } else {
      this.pause();
      if (this.#upload) await removeUpload(this.#upload.id);
    }
    this.#tell("removed", "");
  }

  /** The upload of these files: one begun before, or a new one. */
  async #find(/** @type {AbortSignal} */ signal) {
    const mark = await fingerprint(this.files);
    const uploads = await this.#again(signal, listUploads);
    const same = (/** @type {UploadView} */ one) =>
      one.fingerprint === mark && one.bytes === this.total && one.files === this.files.length;
    const upload =
      uploads.find(same) ??
      (await beginUpload({
        name: this.name,
        files: this.files.length,
        bytes: this.total,
        fingerprint: mark,
      }));
    this.#upload = upload;
    if (upload.finished) return upload;
    const rows = await this.#again(signal, () => listUploadFiles(upload.id));
    this.#known = new Map(rows.map((row) => [row.name, row]));
    this.#count();
    return upload;
  }

  /**
   * @param {string} upload
   * @param {AbortSignal} signal
   */
  async #sendAll(upload, signal) {
    const waiting = this.files.filter(
      ({ file, name }) => this.#known.get(name)?.offset !== file.size || !this.#known.has(name),
    );
    const lane = async () => {
      for (let next = waiting.shift(); next; next = waiting.shift())
        await this.#sendFile(upload, next, signal);
    };
    await Promise.all(Array.from({ length: AT_ONCE }, lane));
  }

  /**
   * @param {string} upload
   * @param {Picked} picked
   * @param {AbortSignal} signal
   */
  async #sendFile(upload, { file, name }, signal) {
    do {
      await this.#again(signal, async (again) => {
        const row = this.#known.get(name);
        if (row && again) row.offset = await readOffset(row.url);
        if (row && row.offset === file.size) return;
        const from = row?.offset ?? 0;
        const began = performance.now();
        const bytes = await readBytes(file.slice(from, from + this.#chunk), name);
        if (row) row.offset = await sendBytes(row.url, from, bytes, signal);
        else this.#known.set(name, await createFile(upload, name, file.size, bytes, signal));
        this.#suit((performance.now() - began) / 1000);
        this.#count();
      });
    } while ((this.#known.get(name)?.offset ?? 0) < file.size);
  }

  /** Chunks take about a second or more: a slow line shows progress, a fast one is used. */
  #suit(/** @type {number} */ tookS) {
    if (tookS > 4) this.#chunk = Math.max(this.#chunk / 2, SMALLEST_CHUNK);
    else if (tookS < 1) this.#chunk = Math.min(this.#chunk * 2, CHUNK);
  }

  /**
   * Tries again as long as another try can help.
   * @template T
   * @param {AbortSignal} signal
   * @param {(again: boolean) => Promise<T>} action
   */
  async #again(signal, action) {
    for (let wait = 1, again = false; ; wait = Math.min(wait * 2, LONGEST_WAIT_S), again = true) {
      if (signal.aborted) throw new Error("stopped");
      try {
        const result = await action(again);
        if (this.state === "trying") this.#tell("sending", "");
        return result;
      } catch (error) {
        const status = error instanceof ApiError ? error.status : NaN;
        const helps = [0, 409, 423, 429, 460, 502, 503, 504].includes(status);
        if (!helps || signal.aborted) throw error;
        this.#tell("trying", t("upload-again", { why: messageOf(error), seconds: String(wait) }));
        await pauseFor(wait, signal);
      }
    }
  }

  #count() {
    this.sent = [...this.#known.values()].reduce((sum, row) => sum + row.offset, 0);
    const t = performance.now() / 1000;
    this.#samples.push({ t, sent: this.sent });
    while (this.#samples.length > 2 && t - (this.#samples[0]?.t ?? t) > RATE_OVER_S)
      this.#samples.shift();
    this.#tell(this.state === "trying" ? "sending" : this.state, "");
  }

  /**
   * @param {SendingState} state
   * @param {string} text
   */
  #tell(state, text) {
    this.state = state;
    this.text = text;
    this.dispatchEvent(new Event("change"));
  }
}

const messageOf = (/** @type {unknown} */ error) =>
  error instanceof Error ? error.message : String(error);

/**
 * @param {Blob} blob
 * @param {string} name
 */
async function readBytes(blob, name) {
  try {
    return await blob.arrayBuffer();
  } catch {
    throw new Error(t("upload-unreadable", { name }));
  }
}

/**
 * @returns {Promise<void>}
 * @param {number} seconds
 * @param {AbortSignal} signal
 */
function pauseFor(seconds, signal) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, seconds * 1000);
    signal.addEventListener("abort", () => {
      clearTimeout(timer);
      reject(new Error("stopped"));
    });
  });
}
