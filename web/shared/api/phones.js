// Requests to the server: pairing of phones.

import { request } from "../http.js";

/** @import {NewInvitation, PairingApproval} from "../http_types" */

export const readPairing = () => request("GET /api/pairing");
export const invitePhone = (/** @type {NewInvitation["role"]} */ role) =>
  request("POST /api/pairing/invitations", { body: { role } });
/**
 * @param {string} code
 * @param {PairingApproval["role"]} role
 */
export const approvePhone = (code, role) =>
  request("POST /api/pairing/approve", { body: { code, role } });
export const redeemInvitation = (/** @type {string} */ token) =>
  request("POST /api/pairing/redeem", { body: { token } });
export const requestPairing = (/** @type {string} */ phone) =>
  request("POST /api/pairing/requests", { body: { name: phone } });
export const claimPairing = (/** @type {string} */ token) =>
  request("POST /api/pairing/claim", { body: { token } });
