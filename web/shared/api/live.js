// Requests to the server: the live capture.

import { socketUrl } from "../address.js";
import { request } from "../http.js";

/** The capture that runs or the last one; null if there was none. */
export const readCapture = () => request("GET /api/live");
export const readCaptureChoices = () => request("GET /api/live/choices");
export const startCapture = (/** @type {NewCapture} */ capture) =>
  request("POST /api/live", { body: capture });
/** @param {"stop" | "pause" | "resume" | "process"} what */
export const steerCapture = (what) => request(`POST /api/live/${what}`);
export const markHere = (/** @type {NewMark} */ mark) =>
  request("POST /api/live/marks", { body: mark });

/**
 * @import {NewCapture, NewMark} from "../http_types"
 * @typedef {object} LiveListeners
 * @property {(message: any) => void} onMessage
 * @property {(data: ArrayBuffer) => void} onPoints
 * @property {(event: CloseEvent) => void} onClose
 */

/**
 * Opens the stream of a capture; `have` is what this page has, the server sends what is new.
 * @param {Record<string, any>} have
 * @param {LiveListeners} given
 */
export function openLiveStream(have, { onMessage, onPoints, onClose }) {
  const socket = new WebSocket(socketUrl("/api/live/stream"));
  socket.binaryType = "arraybuffer";
  socket.addEventListener("open", () => socket.send(JSON.stringify({ have })));
  socket.addEventListener("message", ({ data }) =>
    typeof data === "string" ? onMessage(JSON.parse(data)) : onPoints(data),
  );
  socket.addEventListener("close", onClose);
  return socket;
}
