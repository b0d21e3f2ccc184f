// What the pages request of the server, one function for each operation.

import { at, forgetKept, socketUrl } from "./address.js";
import { ApiError, NO_RESPONSE, become, name, request, tus, urlOf } from "./http.js";

export {
  ApiError,
  LIVE_URL as liveUrl,
  changeHeaders,
  isSignedIn,
  readCurrentUser,
} from "./http.js";

// -- people and sessions

export const signIn = (who, password) =>
  become(request("POST /api/login", { body: { name: who, password } }));
export const setUp = (token, who, password) =>
  become(request("POST /api/setup", { body: { token, name: who, password } }));
export const signInAgain = (password) =>
  become(request("POST /api/login/again", { body: { password } }));
export async function signOut() {
  await request("POST /api/logout");
  forgetKept();
}
export const changePassword = (old, fresh) =>
  become(request("POST /api/me/password", { body: { old, new: fresh } }));
export const listMySessions = () => request("GET /api/me/sessions");
export const endMySession = (session_id) =>
  request("DELETE /api/me/sessions/{session_id}", { path: { session_id } });
export const listPeople = () => request("GET /api/people");
export const addPerson = (person) => request("POST /api/people", { body: person });
export const changePerson = (who, changes) =>
  request("PATCH /api/people/{name}", { path: { name: who }, body: changes });
export const listSessions = () => request("GET /api/sessions");
export const endSession = (session_id) =>
  request("DELETE /api/sessions/{session_id}", { path: { session_id } });
export const readAudit = (before) => request("GET /api/audit", { query: { most: 25, before } });
export const listTrustedKeys = () => request("GET /api/keys");
export const addTrustedKey = (key) => request("POST /api/keys", { body: key });
export const removeTrustedKey = (fingerprint) =>
  request("DELETE /api/keys/{fingerprint}", { path: { fingerprint } });

// -- projects and jobs

export const listProjects = () => request("GET /api/projects");
export const readProject = (project_id) =>
  request("GET /api/projects/{project_id}", { path: { project_id } });
export const readChoices = () => request("GET /api/choices");
export const browse = (folder) => request("GET /api/recordings", { query: { folder } });
export const addJob = (job) => request("POST /api/jobs", { body: job });
export const cancelJob = (job_id) =>
  request("POST /api/jobs/{job_id}/cancel", { path: { job_id } });
export const retryJob = (job_id) => request("POST /api/jobs/{job_id}/retry", { path: { job_id } });
export const readLog = (job_id, offset) =>
  request("GET /api/jobs/{job_id}/log/since", { path: { job_id }, query: { offset } });
export const logUrl = (id) => at(`/api/jobs/${name(id)}/log/file`);
export const readJob = (job_id) => request("GET /api/jobs/{job_id}", { path: { job_id } });
export const listJobsOf = (project_id) =>
  request("GET /api/projects/{project_id}/jobs", { path: { project_id } });
export const lookAt = (path) => request("GET /api/look", { query: { path } });
export const readSettings = (preset) => request("GET /api/settings", { query: { of: preset } });
export const checkSettings = (preset, settings) =>
  request("POST /api/settings/check", { body: { preset, settings } });
export const renameProject = (project_id, title) =>
  request("PATCH /api/projects/{project_id}", { path: { project_id }, body: { name: title } });
export const deleteProject = (project_id) =>
  request("DELETE /api/projects/{project_id}", { path: { project_id } });
export const listTrash = () => request("GET /api/trash");
export const restoreProject = (deleted_id) =>
  request("POST /api/trash/{deleted_id}/restore", { path: { deleted_id } });
export const removeProject = (deleted_id) =>
  request("DELETE /api/trash/{deleted_id}", { path: { deleted_id } });
export const readStorage = () => request("GET /api/storage");
export const deleteRecording = (name) =>
  request("DELETE /api/recordings/{name}", { path: { name } });
export const readServer = () => request("GET /api/server");
export const readOpenApi = async () => (await fetch(at("/openapi.json"))).json();

// -- uploads: JSON for what is sent, tus 1.0 for the bytes

export const listUploads = () => request("GET /api/uploads");
export const readUpload = (upload_id) =>
  request("GET /api/uploads/{upload_id}", { path: { upload_id } });
export const beginUpload = (upload) => request("POST /api/uploads", { body: upload });
export const listUploadFiles = (upload_id) =>
  request("GET /api/uploads/{upload_id}/files", { path: { upload_id } });
export const removeUpload = (upload_id) =>
  request("DELETE /api/uploads/{upload_id}", { path: { upload_id } });

async function bytesHeaders(bytes) {
  const type = { "Content-Type": "application/offset+octet-stream" };
  if (!crypto.subtle) return type;
  const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
  return { ...type, "Upload-Checksum": `sha256 ${btoa(String.fromCharCode(...digest))}` };
}

const base64 = (text) => btoa(String.fromCharCode(...new TextEncoder().encode(text)));

/** Announces a file of an upload, with its first bytes; gives {url, offset}. */
export async function createFile(upload, path, length, bytes, signal) {
  const headers = {
    "Upload-Length": String(length),
    "Upload-Metadata": `upload ${base64(upload)},relativePath ${base64(path)}`,
    ...(await bytesHeaders(bytes)),
  };
  const response = await tus("POST", at("/api/uploads/files"), { headers, body: bytes, signal });
  return {
    url: response.headers.get("Location"),
    offset: Number(response.headers.get("Upload-Offset")),
  };
}

/** Sends bytes of a file; gives the offset the server has now. */
export async function sendBytes(url, offset, bytes, signal) {
  const headers = { "Upload-Offset": String(offset), ...(await bytesHeaders(bytes)) };
  const response = await tus("PATCH", url, { headers, body: bytes, signal });
  return Number(response.headers.get("Upload-Offset"));
}

export const readOffset = async (url) =>
  Number((await tus("HEAD", url)).headers.get("Upload-Offset"));

export const projectUrl = (id) => at(`/projects/${name(id)}/`);
/** The page of a project with a stretch of its walk shown in the viewer. */
export const stretchUrl = (id, stretch) => `${projectUrl(id)}#${stretch}`;
export const slicesUrl = (id) => `${projectUrl(id)}slices/`;
/** What the code of a finding means. */
export const findingHelpUrl = (kind) =>
  at(`/docs/reference/findings.html#${name(kind.toLowerCase())}`);
export const viewerUrl = (id) => at(`/projects/${name(id)}/viewer/`);
export const reportUrl = (id) => at(`/api/projects/${name(id)}/report`);
export const findingsUrl = (id, ending) => at(`/api/projects/${name(id)}/findings.${ending}`);
export const thumbnailUrl = (id, version) =>
  at(`/api/projects/${name(id)}/thumbnail?v=${name(version)}`);
export const fileUrl = (id, file) => at(`/api/projects/${name(id)}/files/${name(file)}`);

const RECONNECT_MS = 3000;

/**
 * Calls `onJob` with every job now and at each change, `onLink` with whether the server answers.
 * The stream does not repeat jobs that finished while it was cut: those are requested.
 * Returns a function for views that came another way, so that these jobs are requested too.
 */
export function watchJobs(onJob, onLink) {
  const newest = new Map(); // project -> its newest job among those received
  const receive = (view) => {
    const { job } = view;
    const known = newest.get(job.project);
    if (known && known.id !== job.id && known.created > job.created) return;
    newest.set(job.project, job);
    onJob(view);
  };
  const requestAgain = async ({ id }) => {
    const view = await readJob(id);
    if (view.job.finished) receive(view);
  };
  const connect = () => {
    const source = new EventSource(at("/api/events"));
    let givenUp = false;
    const reconnect = () => {
      if (givenUp) return;
      givenUp = true;
      source.close();
      onLink(false);
      setTimeout(connect, RECONNECT_MS);
    };
    source.addEventListener("job", (event) => receive(JSON.parse(event.data)));
    source.addEventListener("open", () => {
      const requested = [...newest.values()].filter((job) => !job.finished).map(requestAgain);
      Promise.all(requested).then(() => onLink(source.readyState === EventSource.OPEN), reconnect);
    });
    source.addEventListener("error", () => {
      onLink(false);
      if (source.readyState !== EventSource.CLOSED) return; // the browser reconnects
      request("GET /api/me").catch(() => {}); // signed out?
      reconnect();
    });
  };
  connect();
  return receive;
}

// -- review

export const readReview = (project_id) =>
  request("GET /api/projects/{project_id}/review", { path: { project_id } });
export const readAcknowledgments = (project_id) =>
  request("GET /api/projects/{project_id}/review/acknowledgments", { path: { project_id } });
export const acknowledge = (project_id, body) =>
  request("POST /api/projects/{project_id}/review/acknowledgments", { path: { project_id }, body });
export const readQueue = (project_id) =>
  request("GET /api/projects/{project_id}/review/queue", { path: { project_id } });
export const readWalk = (project_id) =>
  request("GET /api/projects/{project_id}/review/walk", { path: { project_id } });
export const readPair = (project_id, [frame_i, frame_j]) =>
  request("GET /api/projects/{project_id}/review/pair", {
    path: { project_id },
    query: { frame_i, frame_j },
  });
export const readEffect = (project_id) =>
  request("GET /api/projects/{project_id}/review/effect", { path: { project_id } });
export const readJournal = (project_id) =>
  request("GET /api/projects/{project_id}/review/journal", { path: { project_id } });
export const decide = (project_id, decision) =>
  request("POST /api/projects/{project_id}/review/decisions", {
    path: { project_id },
    body: decision,
  });
export const undoDecision = (project_id, after_seq) =>
  request("POST /api/projects/{project_id}/review/undo", {
    path: { project_id },
    body: { after_seq },
  });
export const redoDecision = (project_id, after_seq) =>
  request("POST /api/projects/{project_id}/review/redo", {
    path: { project_id },
    body: { after_seq },
  });
export const alignPair = (project_id, [frame_i, frame_j], T_i_j) =>
  request("POST /api/projects/{project_id}/review/align", {
    path: { project_id },
    body: { frame_i, frame_j, T_i_j },
  });
export const fitPoints = (project_id, p_i, p_j) =>
  request("POST /api/projects/{project_id}/review/fit", {
    path: { project_id },
    body: { p_i, p_j },
  });
export const remakeMap = (project_id) =>
  request("POST /api/projects/{project_id}/remake", { path: { project_id } });
export const approveMap = (project_id, approval) =>
  request("POST /api/projects/{project_id}/review/approve", {
    path: { project_id },
    body: approval,
  });

/** Points of both places of a pair, {i, j}: Float32Array of x y z in the body frame of each [m]. */
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

// -- phones

export const readPairing = () => request("GET /api/pairing");
export const invitePhone = (role) => request("POST /api/pairing/invitations", { body: { role } });
export const approvePhone = (code, role) =>
  request("POST /api/pairing/approve", { body: { code, role } });
export const redeemInvitation = (token) => request("POST /api/pairing/redeem", { body: { token } });
export const requestPairing = (phone) =>
  request("POST /api/pairing/requests", { body: { name: phone } });
export const claimPairing = (token) => request("POST /api/pairing/claim", { body: { token } });

// -- live capture

/** The capture that runs or the last one; null if there was none. */
export const readCapture = () => request("GET /api/live");
export const readCaptureChoices = () => request("GET /api/live/choices");
export const startCapture = (capture) => request("POST /api/live", { body: capture });
/** @param {"stop" | "pause" | "resume" | "process"} what */
export const steerCapture = (what) => request(`POST /api/live/${what}`);
export const markHere = (mark) => request("POST /api/live/marks", { body: mark });

/** Opens the stream of a capture; `have` is what this page has, the server sends what is new. */
export function openLiveStream(have, { onMessage, onPoints, onClose }) {
  const socket = new WebSocket(socketUrl("/api/live/stream"));
  socket.binaryType = "arraybuffer";
  socket.addEventListener("open", () => socket.send(JSON.stringify({ have })));
  socket.addEventListener("message", ({ data }) =>
    typeof data === "string" ? onMessage(JSON.parse(data)) : onPoints(data),
  );
  socket.addEventListener("close", onClose);
  return socket;
}

// -- slices

const slices = (id) => at(`/api/projects/${name(id)}/slices`);
const asQuery = (settings) => name(JSON.stringify(settings));

export const readSliceFacts = (project_id, source = "") =>
  request("GET /api/projects/{project_id}/slices", { path: { project_id }, query: { source } });
export const readSlice = (project_id, settings) =>
  request("POST /api/projects/{project_id}/slices/image", { path: { project_id }, body: settings });
export const aboveUrl = (id, version) => `${slices(id)}/overview?v=${name(version)}`;
export const readAboveWindow = (project_id) =>
  request("GET /api/projects/{project_id}/slices/overview/window", { path: { project_id } });
export const pickOnSlice = (project_id, pick) =>
  request("POST /api/projects/{project_id}/slices/pick", { path: { project_id }, body: pick });
export const readDoubleWalls = (project_id, source = "") =>
  request("GET /api/projects/{project_id}/slices/doubles", {
    path: { project_id },
    query: { source },
  });
export const compareSlices = (project_id, settings) =>
  request("POST /api/projects/{project_id}/slices/compare", {
    path: { project_id },
    body: settings,
  });
export const compareCsvUrl = (id, settings) => `${slices(id)}/compare.csv?ask=${asQuery(settings)}`;
export const sliceFileUrl = (id, ending, settings) =>
  `${slices(id)}/export.${ending}?ask=${asQuery(settings)}`;
export const addReference = (project_id, reference) =>
  request("POST /api/projects/{project_id}/slices/references", {
    path: { project_id },
    body: reference,
  });
export const previewReference = (project_id, file) =>
  request("POST /api/projects/{project_id}/slices/references/preview", {
    path: { project_id },
    body: file,
  });
export const removeReference = (project_id, reference_id) =>
  request("DELETE /api/projects/{project_id}/slices/references/{reference_id}", {
    path: { project_id, reference_id },
  });
export const alignReference = (project_id, reference_id, settings) =>
  request("POST /api/projects/{project_id}/slices/references/{reference_id}/align", {
    path: { project_id, reference_id },
    body: settings,
  });
export const readAlignPoints = (project_id, reference_id) =>
  request("GET /api/projects/{project_id}/slices/references/{reference_id}/points", {
    path: { project_id, reference_id },
  });
export const previewControl = (project_id, file) =>
  request("POST /api/projects/{project_id}/slices/control/preview", {
    path: { project_id },
    body: file,
  });
export const readControl = (project_id) =>
  request("GET /api/projects/{project_id}/slices/control", { path: { project_id } });
export const keepControl = (project_id, state) =>
  request("PUT /api/projects/{project_id}/slices/control", { path: { project_id }, body: state });
export const readControlReport = (project_id) =>
  request("GET /api/projects/{project_id}/slices/control/report", { path: { project_id } });
export const controlFileUrl = (id, ending, draft = false) =>
  `${slices(id)}/control/report.${ending}${draft ? "?draft=true" : ""}`;
export const readSurface = (project_id, point) =>
  request("GET /api/projects/{project_id}/slices/control/surface", {
    path: { project_id },
    query: { point },
  });

// -- rigs

export const rigUrl = (id) => at(`/rigs/${name(id)}/`);
export const rigFileUrl = (id, number) => at(`/api/rigs/${name(id)}/versions/${number}/file`);
export const listRigs = () => request("GET /api/rigs");
export const listSensorModels = () => request("GET /api/sensor-models");
export const readRig = (rig_id, version) =>
  request("GET /api/rigs/{rig_id}", { path: { rig_id }, query: { version } });
export const checkRig = (content) => request("POST /api/rigs/check", { body: content });
export const createRig = (rig) => request("POST /api/rigs", { body: rig });
export const addRigVersion = (rig_id, version) =>
  request("POST /api/rigs/{rig_id}/versions", { path: { rig_id }, body: version });
export const readCalibration = (project_id) =>
  request("GET /api/projects/{project_id}/calibration", { path: { project_id } });
export const readCalibrationSlices = (project_id) =>
  request("GET /api/projects/{project_id}/calibration/slices", { path: { project_id } });
export const saveCalibratedRig = (project_id, version) =>
  request("POST /api/projects/{project_id}/calibration/rig", {
    path: { project_id },
    body: version,
  });
