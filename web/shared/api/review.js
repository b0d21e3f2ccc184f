// Requests to the server: the review of a project.

import { ApiError, NO_RESPONSE, request, urlOf } from "../http.js";

/**
 * @import {
 *   Approve, CorrectionSpec, LikeSpec, Looking, NewAcknowledgment, NewCorrection, NewDecision,
 *   NewWork, PointPairs, PredictedPose, Step
 * } from "../http_types"
 */

export const readReview = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/review", { path: { project_id } });
export const readAcknowledgments = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/review/acknowledgments", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {NewAcknowledgment} body
 */
export const acknowledge = (project_id, body) =>
  request("POST /api/projects/{project_id}/review/acknowledgments", { path: { project_id }, body });
export const readQueue = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/review/queue", { path: { project_id } });
export const readWalk = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/review/walk", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {[number, number]} given
 */
export const readPair = (project_id, [frame_i, frame_j]) =>
  request("GET /api/projects/{project_id}/review/pair", {
    path: { project_id },
    query: { frame_i, frame_j },
  });
export const readEffect = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/review/effect", { path: { project_id } });
export const readJournal = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/review/journal", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {NewDecision} decision
 */
export const decide = (project_id, decision) =>
  request("POST /api/projects/{project_id}/review/decisions", {
    path: { project_id },
    body: decision,
  });
/**
 * @param {string} project_id
 * @param {Step["after_seq"]} after_seq
 */
export const undoDecision = (project_id, after_seq) =>
  request("POST /api/projects/{project_id}/review/undo", {
    path: { project_id },
    body: { after_seq },
  });
/**
 * @param {string} project_id
 * @param {Step["after_seq"]} after_seq
 */
export const redoDecision = (project_id, after_seq) =>
  request("POST /api/projects/{project_id}/review/redo", {
    path: { project_id },
    body: { after_seq },
  });
/**
 * @param {string} project_id
 * @param {[number, number]} given
 * @param {PredictedPose["T_i_j"]} T_i_j
 */
export const alignPair = (project_id, [frame_i, frame_j], T_i_j) =>
  request("POST /api/projects/{project_id}/review/align", {
    path: { project_id },
    body: { frame_i, frame_j, T_i_j },
  });
/**
 * @param {string} project_id
 * @param {PointPairs["p_i"]} p_i
 * @param {PointPairs["p_j"]} p_j
 */
export const fitPoints = (project_id, p_i, p_j) =>
  request("POST /api/projects/{project_id}/review/fit", {
    path: { project_id },
    body: { p_i, p_j },
  });
export const remakeMap = (/** @type {string} */ project_id) =>
  request("POST /api/projects/{project_id}/remake", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {Approve} approval
 */
export const approveMap = (project_id, approval) =>
  request("POST /api/projects/{project_id}/review/approve", {
    path: { project_id },
    body: approval,
  });

export const readCorrections = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/review/classes", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {CorrectionSpec} spec
 */
export const countCorrection = (project_id, spec) =>
  request("POST /api/projects/{project_id}/review/classes/count", {
    path: { project_id },
    body: spec,
  });
/**
 * @param {string} project_id
 * @param {LikeSpec} spec
 */
export const findAlike = (project_id, spec) =>
  request("POST /api/projects/{project_id}/review/classes/like", {
    path: { project_id },
    body: spec,
  });
/**
 * @param {string} project_id
 * @param {NewCorrection} correction
 */
export const correctClasses = (project_id, correction) =>
  request("POST /api/projects/{project_id}/review/classes", {
    path: { project_id },
    body: correction,
  });
/**
 * @param {string} project_id
 * @param {string} correction
 */
export const withdrawCorrection = (project_id, correction) =>
  request("DELETE /api/projects/{project_id}/review/classes/{correction}", {
    path: { project_id, correction },
  });

/**
 * Points of both places of a pair, {i, j}: Float32Array of x y z in the body frame of each [m].
 * @param {string} project_id
 * @param {[number, number]} given
 * @param {number} reach
 */
export async function readPoints(project_id, [frame_i, frame_j], reach) {
  const path = { project_id };
  const query = { frame_i, frame_j, reach };
  const url = urlOf("/api/projects/{project_id}/review/points", path, query);
  const response = await fetch(url).catch(() => {
    throw new ApiError(0, { detail: NO_RESPONSE });
  });
  if (!response.ok) throw new ApiError(response.status, await response.json());
  const data = await response.arrayBuffer();
  const head = new DataView(data);
  const [counted, other] = [head.getUint32(8, true), head.getUint32(12, true)];
  return {
    i: new Float32Array(data, 16, 3 * counted),
    j: new Float32Array(data, 16 + 12 * counted, 3 * other),
  };
}

/**
 * @param {string} project_id
 * @param {NewWork} body
 */
export const shareWork = (project_id, body) =>
  request("POST /api/projects/{project_id}/review/work", { path: { project_id }, body });
/**
 * @param {string} project_id
 * @param {[number, number]} pair
 */
export const readComments = (project_id, [frame_i, frame_j]) =>
  request("GET /api/projects/{project_id}/review/comments", {
    path: { project_id },
    query: { frame_i, frame_j },
  });
export const readReviewers = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/review/people", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {Looking} body
 */
export const look = (project_id, body) =>
  request("POST /api/projects/{project_id}/review/looking", { path: { project_id }, body });
