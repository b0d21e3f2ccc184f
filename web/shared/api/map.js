// Requests to the server: the points of a map.

import { at } from "../address.js";
import { name, readBytes, request } from "../http.js";

/** @import {RayRequest} from "../http_types" */

const map = (/** @type {string} */ id) => at(`/api/projects/${name(id)}/map`);

export const readMapIndex = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/map", { path: { project_id } });
export const readMapWalk = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/map/walk", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {RayRequest} ray
 */
export const pickOnMap = (project_id, ray) =>
  request("POST /api/projects/{project_id}/map/pick", { path: { project_id }, body: ray });

/**
 * Reads the binary points of a map; the addresses name the map's hash, so browsers keep them.
 * @param {string} id
 * @param {string} key
 */
export const pointReader = (id, key) => ({
  sample: (/** @type {string} */ stored) =>
    readBytes(`${map(id)}/${name(key)}/sample?stored=${stored}`),
  part: (
    /** @type {string} */ stored,
    /** @type {number} */ tile,
    /** @type {{start: number, stop: number}} */ { start, stop },
  ) =>
    readBytes(
      `${map(id)}/${name(key)}/points?stored=${stored}&tile=${tile}&start=${start}&stop=${stop}`,
    ),
});

/** The page of the map. */
export const mapUrl = (/** @type {string} */ id) => at(`/projects/${name(id)}/map/`);
