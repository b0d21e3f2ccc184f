// Marks that are made without a link: this phone keeps them, and sends them once there is a link.

import { keep, kept } from "../shared/address.js";
import { markHere } from "../shared/api.js";
import { ApiError } from "../shared/http.js";

/**
 * @import {NewMark} from "../shared/http_types"
 * @typedef {object} KeptMark
 * @property {string} project that is being recorded
 * @property {NewMark["what"]} what
 * @property {string} text
 * @property {number} at_ms when the operator was there, on the clock of this phone
 */

const KEPT = "recon4.live.marks";
const OLDEST_S = 3600; // an older mark gets this age
const AGAIN_MS = 2000; // from a try in vain to the next one
const LATER = [0, 401, 403, 408, 429]; // answers after which the same mark may be taken
const sending = { on: false, again_ms: 0 };

/** @returns {KeptMark[]} */
export const keptMarks = () => JSON.parse(kept(KEPT) ?? "[]");

const keepMarks = (/** @type {KeptMark[]} */ marks) => keep(KEPT, JSON.stringify(marks));

function send(/** @type {KeptMark} */ { what, text, at_ms }) {
  const ago_s = Math.min(Math.max(0, (Date.now() - at_ms) / 1000), OLDEST_S);
  return markHere({ what, text, ago_s });
}

/**
 * Sends a mark; without a link it is kept.
 * @param {KeptMark} mark
 * @returns {Promise<boolean>} whether it was sent
 */
export async function sendOrKeep(mark) {
  try {
    await send(mark);
    return true;
  } catch (error) {
    if (!(error instanceof ApiError) || error.status !== 0) throw error;
    keepMarks([...keptMarks(), mark]);
    return false;
  }
}

/**
 * Tries to send a mark; it may be sent later without a link, to a busy server, or after a login.
 * @param {KeptMark} mark
 * @returns {Promise<"sent" | "later" | "refused">}
 */
async function tried(mark) {
  try {
    await send(mark);
    return "sent";
  } catch (error) {
    const { status } = /** @type {ApiError} */ (error);
    return status >= 500 || LATER.includes(status) ? "later" : "refused";
  }
}

/**
 * Sends the kept marks of the capture, in their order.
 * @param {string} project that is being recorded
 * @returns {Promise<{left: number, refused: KeptMark[]}>} how many are still kept, and those that
 *   the server will never take: of an earlier capture, or refused
 */
export async function sendKept(project) {
  if (sending.on || Date.now() < sending.again_ms) return { left: keptMarks().length, refused: [] };
  sending.on = true;
  const refused = keptMarks().filter((mark) => mark.project !== project);
  keepMarks(keptMarks().filter((mark) => mark.project === project));
  while (keptMarks().length) {
    const [mark] = keptMarks();
    const outcome = await tried(mark);
    if (outcome === "refused") refused.push(mark);
    sending.again_ms = outcome === "later" ? Date.now() + AGAIN_MS : 0;
    if (sending.again_ms) break;
    keepMarks(keptMarks().slice(1));
  }
  sending.on = false;
  return { left: keptMarks().length, refused };
}
