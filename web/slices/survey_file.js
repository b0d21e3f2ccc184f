// A survey file as it is sent, and what was read of it. No DOM.

import { decimal, t } from "../shared/texts.js";

/** @import {ControlPreview} from "../shared/http_types" */

const MOST_BYTES = 600_000;

/** How many points were read, and where the first of them lies. */
export function firstPoint(/** @type {ControlPreview} */ { points, crs }) {
  const [one] = points;
  if (!one) return "";
  const put = crs ? ` ${t("degrees-put", { crs })}` : "";
  const [x = "", y = "", z = ""] = one.xyz_m.map((value) => decimal(value, 3));
  return t("first-point", { count: points.length, name: one.id, x, y, z, put });
}

/** The bytes of a file, as a request has them. */
export async function base64Of(/** @type {File} */ file) {
  const data = new Uint8Array(await file.arrayBuffer());
  if (data.length > MOST_BYTES) throw new Error(t("list-too-large"));
  return btoa(Array.from(data, (one) => String.fromCharCode(one)).join(""));
}
