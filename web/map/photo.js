// A photo of a note, made small enough to send: the server keeps at most 2048 px anyway.

import { t } from "../shared/texts.js";
const SIDE_PX = 2048;
const MOST_BYTES = 660_000; // as base64 below the limit of a request

/**
 * A JPEG file of a photo, as base64.
 * @param {File} file
 */
export async function smallPhoto(file) {
  const image = await createImageBitmap(file, { imageOrientation: "from-image" }).catch(() => {
    throw new Error(t("no-photo", { file: file.name }));
  });
  for (let side = SIDE_PX; side >= 256; side /= 1.3) {
    const blob = await drawn(image, Math.min(1, side / Math.max(image.width, image.height)));
    if (blob.size <= MOST_BYTES) return base64Of(await blob.arrayBuffer());
  }
  throw new Error(t("photo-too-large", { file: file.name }));
}

/**
 * @param {ImageBitmap} image
 * @param {number} scale
 */
async function drawn(image, scale) {
  const canvas = document.createElement("canvas");
  canvas.width = Math.max(1, Math.round(image.width * scale));
  canvas.height = Math.max(1, Math.round(image.height * scale));
  const context = canvas.getContext("2d");
  if (!context) throw new Error("this browser draws no photos");
  context.fillStyle = "white";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  const blob = await new Promise((/** @type {(blob: Blob | null) => void} */ done) =>
    canvas.toBlob(done, "image/jpeg", 0.85),
  );
  if (!blob) throw new Error("this browser cannot write the photo");
  return blob;
}

function base64Of(/** @type {ArrayBuffer} */ buffer) {
  const bytes = new Uint8Array(buffer);
  let text = "";
  for (let k = 0; k < bytes.length; k += 0x8000)
    text += String.fromCharCode(...bytes.subarray(k, k + 0x8000));
  return btoa(text);
}
