// Requests to the server: the points of a map.

import { at } from "../address.js";
import { name, readBytes, request } from "../http.js";

/** @import {MapIndex, PointsInMap, RayRequest, VolumeRequest} from "../http_types" */

const map = (/** @type {string} */ id) => at(`/api/projects/${name(id)}/map`);

/**
 * @param {string} project_id
 * @param {string} key of an earlier map; empty = the latest
 */
export const readMapIndex = (project_id, key = "") =>
  request("GET /api/projects/{project_id}/map", { path: { project_id }, query: { key } });
export const readMapWalk = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/map/walk", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {RayRequest} ray
 */
export const pickOnMap = (project_id, ray) =>
  request("POST /api/projects/{project_id}/map/pick", { path: { project_id }, body: ray });
/**
 * @param {string} project_id
 * @param {PointsInMap} points
 */
export const putIntoCrs = (project_id, points) =>
  request("POST /api/projects/{project_id}/map/crs", { path: { project_id }, body: points });
/**
 * @param {string} project_id
 * @param {VolumeRequest} volume
 */
export const readVolume = (project_id, volume) =>
  request("POST /api/projects/{project_id}/map/volume", { path: { project_id }, body: volume });

/**
 * Reads the binary points of a map. The addresses name the map's hash and the layout of the bytes,
 * so browsers keep them, and never take those of another layout.
 * @param {string} id
 * @param {Pick<MapIndex, "key" | "version">} index
 */
export const pointReader = (id, { key, version }) => ({
  sample: (/** @type {string} */ stored) =>
    readBytes(`${map(id)}/${name(key)}/sample?stored=${stored}&version=${version}`),
  /** @param {Array<{ofCube: boolean, row: number, start: number, stop: number}>} wanted */
  parts: (/** @type {string} */ stored, wanted) =>
    readBytes(
      `${map(id)}/${name(key)}/${wanted[0].ofCube ? "cubes" : "points"}` +
        `?stored=${stored}&version=${version}&parts=` +
        wanted.map(({ row, start, stop }) => `${row}:${start}:${stop}`).join(","),
    ),
});

/** The page of the map. */
export const mapUrl = (/** @type {string} */ id) => at(`/projects/${name(id)}/map/`);
/**
 * The page of the map at a stretch or place, as of a finding.
 * @param {string} id
 * @param {string} stretch
 */
export const mapPlaceUrl = (id, stretch) => `${mapUrl(id)}?${stretch}`;
