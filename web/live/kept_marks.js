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
export const OLDEST_S = 3600; // an older mark gets this age
const sending = { on: false };

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
 * Sends the kept marks of the capture, in their order; those of an earlier one are forgotten.
 * @param {string} project that is being recorded
 * @returns {Promise<number>} how many are still kept
 */
export async function sendKept(project) {
  if (sending.on || !keptMarks().length) return keptMarks().length;
  sending.on = true;
  try {
    keepMarks(keptMarks().filter((mark) => mark.project === project));
    for (const mark of keptMarks()) {
      await send(mark);
      keepMarks(keptMarks().slice(1));
    }
  } catch (error) {
    if (!(error instanceof ApiError) || error.status !== 0) keepMarks(keptMarks().slice(1));
  } finally {
    sending.on = false;
  }
  return keptMarks().length;
}
