// Volumes over a plane: the server computes each once, from all points of the heights shown.

import { idHere } from "../shared/address.js";
import { readVolume } from "../shared/api.js";
import { asError } from "../shared/dom.js";
import { page } from "./page.js";

/**
 * @import {MapVolume, VolumeRequest} from "../shared/http_types"
 * @import {Measurement} from "./measure.js"
 */

const id = idHere();

/** @returns {VolumeRequest} */
function askOf(/** @type {Measurement} */ { points, figure }) {
  const [low_m, high_m] = page.state.clip.heights;
  return {
    key: page.index?.key ?? "",
    polygon: points.map(([x, y]) => /** @type {[number, number]} */ ([x, y])),
    base_m: figure ?? null,
    low_m,
    high_m,
  };
}

const nameOf = (/** @type {Measurement} */ one) => JSON.stringify(askOf(one));

/** The volume, if it has been computed. */
export function volumeOf(/** @type {Measurement} */ one) {
  if (one.kind !== "volume") return null;
  const found = page.volumes[nameOf(one)];
  return found && !(found instanceof Error) ? found : null;
}

/** Why it cannot be computed; empty if it can. */
export function volumeProblem(/** @type {Measurement} */ one) {
  const found = one.kind === "volume" ? page.volumes[nameOf(one)] : null;
  return found instanceof Error ? found.message : "";
}

/** Asks for the volumes that are not known yet; what was refused stays so until it is changed. */
export function askVolumes(/** @type {() => void} */ draw) {
  for (const one of page.state.measurements.filter(({ kind }) => kind === "volume")) {
    const name = nameOf(one);
    if (name in page.volumes) continue;
    page.volumes[name] = null;
    readVolume(id, askOf(one))
      .catch(asError)
      .then((found) => {
        page.volumes[name] = /** @type {MapVolume | Error} */ (found);
        draw();
      });
  }
}
