// Requests to the server: rigs and calibrations.

import { at } from "../address.js";
import { name, request } from "../http.js";

/** @import {CalibratedVersion, NewRig, NewVersion, RigContent} from "../http_types" */

export const rigUrl = (/** @type {string} */ id) => at(`/rigs/${name(id)}/`);
/**
 * @param {string} id
 * @param {number} number
 */
export const rigFileUrl = (id, number) => at(`/api/rigs/${name(id)}/versions/${number}/file`);
export const listRigs = () => request("GET /api/rigs");
export const listSensorModels = () => request("GET /api/sensor-models");
/**
 * @param {string} rig_id
 * @param {number | undefined} version
 */
export const readRig = (rig_id, version) =>
  request("GET /api/rigs/{rig_id}", { path: { rig_id }, query: { version } });
export const checkRig = (/** @type {RigContent} */ content) =>
  request("POST /api/rigs/check", { body: content });
export const createRig = (/** @type {NewRig} */ rig) => request("POST /api/rigs", { body: rig });
/**
 * @param {string} rig_id
 * @param {NewVersion} version
 */
export const addRigVersion = (rig_id, version) =>
  request("POST /api/rigs/{rig_id}/versions", { path: { rig_id }, body: version });
export const readCalibration = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/calibration", { path: { project_id } });
export const readCalibrationSlices = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/calibration/slices", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {CalibratedVersion} version
 */
export const saveCalibratedRig = (project_id, version) =>
  request("POST /api/projects/{project_id}/calibration/rig", {
    path: { project_id },
    body: version,
  });
