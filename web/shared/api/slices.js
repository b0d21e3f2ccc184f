// Requests to the server: slices of a map, references and control points.

import { at } from "../address.js";
import { name, request } from "../http.js";

/**
 * @import {
 *   AddReference, AlignRequest, CompareRequest, ControlFile, ControlState, PickRequest,
 *   ReferenceFile, SliceImageRequest
 * } from "../http_types"
 */

const slices = (/** @type {string} */ id) => at(`/api/projects/${name(id)}/slices`);
const asQuery = (/** @type {object} */ settings) => name(JSON.stringify(settings));

export const readSliceFacts = (/** @type {string} */ project_id, source = "") =>
  request("GET /api/projects/{project_id}/slices", { path: { project_id }, query: { source } });
/**
 * @param {string} project_id
 * @param {SliceImageRequest} settings
 */
export const readSlice = (project_id, settings) =>
  request("POST /api/projects/{project_id}/slices/image", { path: { project_id }, body: settings });
/**
 * @param {string} id
 * @param {string} version
 */
export const aboveUrl = (id, version) => `${slices(id)}/overview?v=${name(version)}`;
export const readAboveWindow = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/slices/overview/window", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {PickRequest} pick
 */
export const pickOnSlice = (project_id, pick) =>
  request("POST /api/projects/{project_id}/slices/pick", { path: { project_id }, body: pick });
/** Positions of the walk between two times [s]. */
export const readStretch = (
  /** @type {string} */ project_id,
  /** @type {[number, number]} */ [start_s, end_s],
) =>
  request("GET /api/projects/{project_id}/slices/walk", {
    path: { project_id },
    query: { start_s, end_s },
  });
export const readDoubleWalls = (/** @type {string} */ project_id, source = "") =>
  request("GET /api/projects/{project_id}/slices/doubles", {
    path: { project_id },
    query: { source },
  });
/**
 * @param {string} project_id
 * @param {CompareRequest} settings
 */
export const compareSlices = (project_id, settings) =>
  request("POST /api/projects/{project_id}/slices/compare", {
    path: { project_id },
    body: settings,
  });
/**
 * @param {string} id
 * @param {CompareRequest} settings
 */
export const compareCsvUrl = (id, settings) => `${slices(id)}/compare.csv?ask=${asQuery(settings)}`;
/**
 * @param {string} id
 * @param {string} ending
 * @param {object} settings
 */
export const sliceFileUrl = (id, ending, settings) =>
  `${slices(id)}/export.${ending}?ask=${asQuery(settings)}`;
/**
 * @param {string} project_id
 * @param {AddReference} reference
 */
export const addReference = (project_id, reference) =>
  request("POST /api/projects/{project_id}/slices/references", {
    path: { project_id },
    body: reference,
  });
/**
 * @param {string} project_id
 * @param {ReferenceFile} file
 */
export const previewReference = (project_id, file) =>
  request("POST /api/projects/{project_id}/slices/references/preview", {
    path: { project_id },
    body: file,
  });
/**
 * @param {string} project_id
 * @param {string} reference_id
 */
export const removeReference = (project_id, reference_id) =>
  request("DELETE /api/projects/{project_id}/slices/references/{reference_id}", {
    path: { project_id, reference_id },
  });
/**
 * @param {string} project_id
 * @param {string} reference_id
 * @param {AlignRequest} settings
 */
export const alignReference = (project_id, reference_id, settings) =>
  request("POST /api/projects/{project_id}/slices/references/{reference_id}/align", {
    path: { project_id, reference_id },
    body: settings,
  });
/**
 * @param {string} project_id
 * @param {string} reference_id
 */
export const readAlignPoints = (project_id, reference_id) =>
  request("GET /api/projects/{project_id}/slices/references/{reference_id}/points", {
    path: { project_id, reference_id },
  });
/**
 * @param {string} project_id
 * @param {ControlFile} file
 */
export const previewControl = (project_id, file) =>
  request("POST /api/projects/{project_id}/slices/control/preview", {
    path: { project_id },
    body: file,
  });
export const readControl = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/slices/control", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {ControlState} state
 */
export const keepControl = (project_id, state) =>
  request("PUT /api/projects/{project_id}/slices/control", { path: { project_id }, body: state });
export const readControlReport = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/slices/control/report", { path: { project_id } });
/**
 * @param {string} id
 * @param {string} ending
 */
export const controlFileUrl = (id, ending, draft = false) =>
  `${slices(id)}/control/report.${ending}${draft ? "?draft=true" : ""}`;
/**
 * @param {string} project_id
 * @param {string} crs
 */
export const trySite = (project_id, crs) =>
  request("GET /api/projects/{project_id}/slices/control/site", {
    path: { project_id },
    query: { crs },
  });
/**
 * @param {string} project_id
 * @param {string} crs
 */
export const putOnSite = (project_id, crs) =>
  request("POST /api/projects/{project_id}/slices/control/site", {
    path: { project_id },
    body: { crs },
  });
export const takeOffSite = (/** @type {string} */ project_id) =>
  request("DELETE /api/projects/{project_id}/slices/control/site", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {string} point
 */
export const readSurface = (project_id, point) =>
  request("GET /api/projects/{project_id}/slices/control/surface", {
    path: { project_id },
    query: { point },
  });
