// Requests to the server: uploads: JSON for what is sent, tus 1.0 for the bytes.

import { at } from "../address.js";
import { request, tus } from "../http.js";

/** @import {NewUpload} from "../http_types" */

export const listUploads = () => request("GET /api/uploads");
export const readUpload = (/** @type {string} */ upload_id) =>
  request("GET /api/uploads/{upload_id}", { path: { upload_id } });
export const beginUpload = (/** @type {NewUpload} */ upload) =>
  request("POST /api/uploads", { body: upload });
export const listUploadFiles = (/** @type {string} */ upload_id) =>
  request("GET /api/uploads/{upload_id}/files", { path: { upload_id } });
export const removeUpload = (/** @type {string} */ upload_id) =>
  request("DELETE /api/uploads/{upload_id}", { path: { upload_id } });

async function bytesHeaders(/** @type {ArrayBuffer} */ bytes) {
  const type = { "Content-Type": "application/offset+octet-stream" };
  if (!crypto.subtle) return type;
  const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
  return { ...type, "Upload-Checksum": `sha256 ${btoa(String.fromCharCode(...digest))}` };
}

const base64 = (/** @type {string} */ text) =>
  btoa(String.fromCharCode(...new TextEncoder().encode(text)));

/**
 * Announces a file of an upload, with its first bytes; gives {url, offset}.
 * @param {string} upload
 * @param {string} path
 * @param {number} length
 * @param {ArrayBuffer} bytes
 * @param {AbortSignal} signal
 */
export async function createFile(upload, path, length, bytes, signal) {
  const headers = {
    "Upload-Length": String(length),
    "Upload-Metadata": `upload ${base64(upload)},relativePath ${base64(path)}`,
    ...(await bytesHeaders(bytes)),
  };
  const response = await tus("POST", at("/api/uploads/files"), { headers, body: bytes, signal });
  return {
    url: response.headers.get("Location") ?? "",
    offset: Number(response.headers.get("Upload-Offset")),
  };
}

/**
 * Sends bytes of a file; gives the offset the server has now.
 * @param {string} url
 * @param {number} offset
 * @param {ArrayBuffer} bytes
 * @param {AbortSignal} signal
 */
export async function sendBytes(url, offset, bytes, signal) {
  const headers = { "Upload-Offset": String(offset), ...(await bytesHeaders(bytes)) };
  const response = await tus("PATCH", url, { headers, body: bytes, signal });
  return Number(response.headers.get("Upload-Offset"));
}

export const readOffset = async (/** @type {string} */ url) =>
  Number((await tus("HEAD", url)).headers.get("Upload-Offset"));
