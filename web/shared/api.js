// The only module that talks to the server.

export class ApiError extends Error {
  constructor(status, { error, detail, problems = {} }) {
    super(detail);
    this.name = error ?? "Invalid";
    this.status = status;
    this.problems = problems;
  }
}

async function request(method, path, body) {
  const options = { method, headers: await changeHeaders(method) };
  if (body !== undefined) {
    options.body = JSON.stringify(body);
    options.headers["Content-Type"] = "application/json";
  }
  let response;
  try {
    response = await fetch(path, options);
  } catch {
    throw new ApiError(0, {
      error: "Offline",
      detail: "The server does not answer. Is it still running?",
    });
  }
  const json =
    response.status !== 204 && response.headers.get("Content-Type")?.startsWith("application/json");
  const answer = json ? await response.json() : await response.text();
  if (response.ok) return answer;
  const error = new ApiError(response.status, json ? answer : { detail: answer });
  if (error.name === "Unknown") leaveForLogin();
  if (error.name === "StaleToken") whoami = null;
  throw error;
}

// -- who asks

let whoami = null;

/** Who is signed in: {name, role, may, login, token}; asked once a page, or `again`. */
export const readMe = (again = false) =>
  again ? request("GET", "/api/me") : (whoami ??= request("GET", "/api/me"));

/** Whether somebody is signed in already; for the login page. */
export const isSignedIn = async () => (await fetch("/api/me")).ok;

const BEFORE_LOGIN = ["/login", "/pair"];

/** Headers a request that changes something must carry; for those that do not go through here. */
export async function changeHeaders(method = "POST") {
  if (method === "GET" || BEFORE_LOGIN.includes(location.pathname)) return {};
  const { token } = await readMe();
  return token ? { "X-Recon4-Token": token } : {};
}

function leaveForLogin() {
  if (BEFORE_LOGIN.includes(location.pathname)) return;
  const paired = location.pathname === liveUrl; // a phone may have no password: the page of pairing has both
  location.assign(paired ? "/pair#again" : `/login#next=${encodeURIComponent(location.pathname)}`);
}

/** Keeps who is signed in from an answer that tells: the token has changed. */
async function become(answer) {
  const me = await answer;
  whoami = Promise.resolve(me);
  return me;
}

export const signIn = (who, password) =>
  become(request("POST", "/api/login", { name: who, password }));
export const setUp = (token, who, password) =>
  become(request("POST", "/api/setup", { token, name: who, password }));
export const signInAgain = (password) => become(request("POST", "/api/login/again", { password }));
export const signOut = () => request("POST", "/api/logout");
export const changePassword = (old, fresh) =>
  become(request("POST", "/api/me/password", { old, new: fresh }));
export const listMySessions = () => request("GET", "/api/me/sessions");
export const endMySession = (id) => request("DELETE", `/api/me/sessions/${name(id)}`);
export const listPeople = () => request("GET", "/api/people");
export const addPerson = (person) => request("POST", "/api/people", person);
export const changePerson = (who, changes) => request("PATCH", `/api/people/${name(who)}`, changes);
export const listSessions = () => request("GET", "/api/sessions");
export const endSession = (id) => request("DELETE", `/api/sessions/${name(id)}`);
export const readAudit = (before) =>
  request("GET", `/api/audit?most=25${before ? `&before=${before}` : ""}`);

const name = encodeURIComponent;

export const listProjects = () => request("GET", "/api/projects");
export const readProject = (id) => request("GET", `/api/projects/${name(id)}`);
export const readChoices = () => request("GET", "/api/choices");
export const browse = (folder) => request("GET", `/api/recordings?folder=${name(folder)}`);
export const addJob = (job) => request("POST", "/api/jobs", job);
export const cancelJob = (id) => request("POST", `/api/jobs/${name(id)}/cancel`);
export const retryJob = (id) => request("POST", `/api/jobs/${name(id)}/retry`);
export const readLog = (id, offset) =>
  request("GET", `/api/jobs/${name(id)}/log/since?offset=${offset}`);
export const logUrl = (id) => `/api/jobs/${name(id)}/log/file`;
export const readJob = (id) => request("GET", `/api/jobs/${name(id)}`);
export const listJobsOf = (id) => request("GET", `/api/projects/${name(id)}/jobs`);
export const lookAt = (path) => request("GET", `/api/look?path=${name(path)}`);
export const readSettings = (preset) => request("GET", `/api/settings?of=${name(preset)}`);
export const checkSettings = (preset, settings) =>
  request("POST", "/api/settings/check", { preset, settings });
export const renameProject = (id, words) =>
  request("PATCH", `/api/projects/${name(id)}`, { name: words });
export const deleteProject = (id) => request("DELETE", `/api/projects/${name(id)}`);
export const listTrash = () => request("GET", "/api/trash");
export const restoreProject = (id) => request("POST", `/api/trash/${name(id)}/restore`);
export const removeProject = (id) => request("DELETE", `/api/trash/${name(id)}`);
export const readServer = () => request("GET", "/api/server");
export const readOpenApi = () => request("GET", "/openapi.json");

// -- uploads: JSON for what is sent, tus 1.0 for the bytes

export const listUploads = () => request("GET", "/api/uploads");
export const readUpload = (id) => request("GET", `/api/uploads/${name(id)}`);
export const beginUpload = (upload) => request("POST", "/api/uploads", upload);
export const listUploadFiles = (id) => request("GET", `/api/uploads/${name(id)}/files`);
export const removeUpload = (id) => request("DELETE", `/api/uploads/${name(id)}`);

async function tus(method, path, { headers = {}, body, signal } = {}) {
  let response;
  try {
    const all = {
      "Tus-Resumable": "1.0.0",
      ...(method === "HEAD" ? {} : await changeHeaders(method)),
      ...headers,
    };
    response = await fetch(path, { method, headers: all, body, signal, cache: "no-store" });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new ApiError(0, { error: "Offline", detail: "The server does not answer" });
  }
  if (response.ok) return response;
  const text = await response.text();
  let answer = { detail: text || `The server says ${response.status}` };
  try {
    answer = JSON.parse(text);
  } catch {
    // not ours: a proxy in between, or the answer to HEAD, which has no body
  }
  if (response.status === 401) leaveForLogin();
  throw new ApiError(response.status, answer);
}

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
  const answer = await tus("POST", "/api/uploads/files", { headers, body: bytes, signal });
  return {
    url: answer.headers.get("Location"),
    offset: Number(answer.headers.get("Upload-Offset")),
  };
}

/** Sends bytes of a file; gives the offset the server has now. */
export async function sendBytes(url, offset, bytes, signal) {
  const headers = { "Upload-Offset": String(offset), ...(await bytesHeaders(bytes)) };
  const answer = await tus("PATCH", url, { headers, body: bytes, signal });
  return Number(answer.headers.get("Upload-Offset"));
}

export const readOffset = async (url) =>
  Number((await tus("HEAD", url)).headers.get("Upload-Offset"));

export const projectUrl = (id) => `/projects/${name(id)}/`;
export const viewerUrl = (id) => `/projects/${name(id)}/viewer/`;
export const reportUrl = (id) => `/api/projects/${name(id)}/report`;
export const thumbnailUrl = (id, version) =>
  `/api/projects/${name(id)}/thumbnail?v=${name(version)}`;
export const fileUrl = (id, file) => `/api/projects/${name(id)}/files/${name(file)}`;

const ANEW_MS = 3000;

/**
 * Calls `onJob` with every job now and at each change, `onLink` with whether the server answers.
 * The stream tells nothing of jobs that succeeded while it was cut: those are asked for.
 */
export function watchJobs(onJob, onLink) {
  const newest = new Map(); // project -> its newest job, as far as it was told
  const tell = (view) => {
    const { job } = view;
    const known = newest.get(job.project);
    if (known && known.id !== job.id && known.created > job.created) return;
    newest.set(job.project, job);
    onJob(view);
  };
  const askAgain = async ({ id }) => {
    const view = await readJob(id);
    if (view.job.finished) tell(view);
  };
  const connect = () => {
    const source = new EventSource("/api/events");
    let givenUp = false;
    const anew = () => {
      if (givenUp) return;
      givenUp = true;
      source.close();
      onLink(false);
      setTimeout(connect, ANEW_MS);
    };
    source.addEventListener("job", (event) => tell(JSON.parse(event.data)));
    source.addEventListener("open", () => {
      const asked = [...newest.values()].filter((job) => !job.finished).map(askAgain);
      Promise.all(asked).then(() => onLink(source.readyState === EventSource.OPEN), anew);
    });
    source.addEventListener("error", () => {
      onLink(false);
      if (source.readyState !== EventSource.CLOSED) return; // it tries again by itself
      request("GET", "/api/me").catch(() => {}); // signed out?
      anew();
    });
  };
  connect();
}

// -- review

const review = (id, path = "") => `/api/projects/${name(id)}/review${path}`;
const ofPair = ([i, j]) => `frame_i=${i}&frame_j=${j}`;

export const readReview = (id) => request("GET", review(id));
export const readQueue = (id) => request("GET", review(id, "/queue"));
export const readWalk = (id) => request("GET", review(id, "/walk"));
export const readPair = (id, pair) => request("GET", review(id, `/pair?${ofPair(pair)}`));
export const readEffect = (id) => request("GET", review(id, "/effect"));
export const readJournal = (id) => request("GET", review(id, "/journal"));
export const decide = (id, decision) => request("POST", review(id, "/decisions"), decision);
export const stepBack = (id, seq) => request("POST", review(id, "/undo"), { after_seq: seq });
export const stepForth = (id, seq) => request("POST", review(id, "/redo"), { after_seq: seq });
export const alignPair = (id, [i, j], guess) =>
  request("POST", review(id, "/align"), { frame_i: i, frame_j: j, T_i_j: guess });
export const fitPoints = (id, p_i, p_j) => request("POST", review(id, "/fit"), { p_i, p_j });
export const remakeMap = (id) => request("POST", `/api/projects/${name(id)}/remake`);
export const approveMap = (id, signed) => request("POST", review(id, "/approve"), signed);

/** Points of both places of a pair, {i, j}: Float32Array of x y z in the body frame of each [m]. */
export async function readPoints(id, pair, reach) {
  const response = await fetch(review(id, `/points?${ofPair(pair)}&reach=${reach}`)).catch(() => {
    throw new ApiError(0, { detail: "The server does not answer. Is it still running?" });
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

export const readPairing = () => request("GET", "/api/pairing");
export const invitePhone = (role) => request("POST", "/api/pairing/invitations", { role });
export const approvePhone = (code, role) => request("POST", "/api/pairing/approve", { code, role });
export const redeemInvitation = (token) => request("POST", "/api/pairing/redeem", { token });
export const askToPair = (phone) => request("POST", "/api/pairing/requests", { name: phone });
export const claimPairing = (token) => request("POST", "/api/pairing/claim", { token });

// -- live capture

export const liveUrl = "/live";
/** The capture that runs or the last one; null if there was none. */
export const readCapture = () => request("GET", "/api/live");
export const readCaptureChoices = () => request("GET", "/api/live/choices");
export const startCapture = (capture) => request("POST", "/api/live", capture);
export const steerCapture = (what) => request("POST", `/api/live/${name(what)}`);
export const markHere = (mark) => request("POST", "/api/live/marks", mark);

/** Opens the stream of a capture; tell it what this page has, it tells what is new. */
export function openLiveStream(have, { onMessage, onPoints, onClose }) {
  const socket = new WebSocket(
    `${location.protocol.replace("http", "ws")}//${location.host}/api/live/stream`,
  );
  socket.binaryType = "arraybuffer";
  socket.addEventListener("open", () => socket.send(JSON.stringify({ have })));
  socket.addEventListener("message", ({ data }) =>
    typeof data === "string" ? onMessage(JSON.parse(data)) : onPoints(data),
  );
  socket.addEventListener("close", onClose);
  return socket;
}

// -- slices

const slices = (id) => `/api/projects/${name(id)}/slices`;
const asked = (ask) => name(JSON.stringify(ask));

export const readSliceFacts = (id, source = "") =>
  request("GET", `${slices(id)}?source=${name(source)}`);
export const readSlice = (id, ask) => request("POST", `${slices(id)}/image`, ask);
export const aboveUrl = (id, version) => `${slices(id)}/overview?v=${name(version)}`;
export const readAboveWindow = (id) => request("GET", `${slices(id)}/overview/window`);
export const pickOnSlice = (id, ask) => request("POST", `${slices(id)}/pick`, ask);
export const readDoubleWalls = (id, source = "") =>
  request("GET", `${slices(id)}/doubles?source=${name(source)}`);
export const compareSlices = (id, ask) => request("POST", `${slices(id)}/compare`, ask);
export const compareCsvUrl = (id, ask) => `${slices(id)}/compare.csv?ask=${asked(ask)}`;
export const sliceFileUrl = (id, ending, ask) => `${slices(id)}/export.${ending}?ask=${asked(ask)}`;
export const addReference = (id, add) => request("POST", `${slices(id)}/references`, add);
export const removeReference = (id, one) =>
  request("DELETE", `${slices(id)}/references/${name(one)}`);
export const alignReference = (id, one, ask) =>
  request("POST", `${slices(id)}/references/${name(one)}/align`, ask);
export const lookAtControl = (id, file) => request("POST", `${slices(id)}/control/preview`, file);
export const readControl = (id) => request("GET", `${slices(id)}/control`);
export const keepControl = (id, state) => request("PUT", `${slices(id)}/control`, state);
export const readControlReport = (id) => request("GET", `${slices(id)}/control/report`);
export const controlFileUrl = (id, ending) => `${slices(id)}/control/report.${ending}`;
export const readSurface = (id, point) =>
  request("GET", `${slices(id)}/control/surface?point=${name(point)}`);
