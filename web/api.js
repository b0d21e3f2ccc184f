// The only module that talks to the server.

export class ApiError extends Error {
  constructor(status, { error, detail }) {
    super(typeof detail === "string" ? detail : detail.map((one) => `${one.loc.at(-1)}: ${one.msg}`).join("; "));
    this.name = error ?? "Invalid";
    this.status = status;
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
    throw new ApiError(0, { error: "Offline", detail: "The server does not answer. Is it still running?" });
  }
  const json = response.headers.get("Content-Type")?.startsWith("application/json");
  const answer = json ? await response.json() : await response.text();
  if (response.ok) return answer;
  const error = new ApiError(response.status, json ? answer : { detail: answer });
  if (error.name === "Unknown") leaveForLogin();
  if (error.name === "StaleToken") whoami = null;
  throw error;
}

// -- who asks

let whoami = null;

/** Who is signed in: {name, role, may, login, token}; asked once a page. */
export const readMe = () => (whoami ??= request("GET", "/api/me"));

/** Whether somebody is signed in already; for the login page. */
export const isSignedIn = async () => (await fetch("/api/me")).ok;

/** Headers a request that changes something must carry; for those that do not go through here. */
export async function changeHeaders(method = "POST") {
  if (method === "GET" || location.pathname === "/login") return {};
  const { token } = await readMe();
  return token ? { "X-Recon4-Token": token } : {};
}

function leaveForLogin() {
  if (location.pathname !== "/login") location.assign(`/login#next=${encodeURIComponent(location.pathname)}`);
}

/** Keeps who is signed in from an answer that tells: the token has changed. */
async function become(answer) {
  const me = await answer;
  whoami = Promise.resolve(me);
  return me;
}

export const signIn = (who, password) => become(request("POST", "/api/login", { name: who, password }));
export const setUp = (token, who, password) => become(request("POST", "/api/setup", { token, name: who, password }));
export const signInAgain = (password) => become(request("POST", "/api/login/again", { password }));
export const signOut = () => request("POST", "/api/logout");
export const changePassword = (old, fresh) => become(request("POST", "/api/me/password", { old, new: fresh }));
export const listMySessions = () => request("GET", "/api/me/sessions");
export const endMySession = (id) => request("DELETE", `/api/me/sessions/${name(id)}`);
export const listPeople = () => request("GET", "/api/people");
export const addPerson = (person) => request("POST", "/api/people", person);
export const changePerson = (who, changes) => request("PATCH", `/api/people/${name(who)}`, changes);
export const listSessions = () => request("GET", "/api/sessions");
export const endSession = (id) => request("DELETE", `/api/sessions/${name(id)}`);
export const readAudit = (before) => request("GET", `/api/audit?most=50${before ? `&before=${before}` : ""}`);

const name = encodeURIComponent;

export const listProjects = () => request("GET", "/api/projects");
export const readProject = (id) => request("GET", `/api/projects/${name(id)}`);
export const readChoices = () => request("GET", "/api/choices");
export const browse = (folder) => request("GET", `/api/recordings?folder=${name(folder)}`);
export const addJob = (job) => request("POST", "/api/jobs", job);
export const cancelJob = (id) => request("POST", `/api/jobs/${name(id)}/cancel`);
export const retryJob = (id) => request("POST", `/api/jobs/${name(id)}/retry`);
export const readLog = (id) => request("GET", `/api/jobs/${name(id)}/log?lines=200`);
export const readOpenApi = () => request("GET", "/openapi.json");

export const projectUrl = (id) => `/projects/${name(id)}/`;
export const viewerUrl = (id) => `/projects/${name(id)}/viewer/`;
export const reportUrl = (id) => `/api/projects/${name(id)}/report`;
export const pictureUrl = (id, version) => `/api/projects/${name(id)}/picture?v=${name(version)}`;
export const fileUrl = (id, file) => `/api/projects/${name(id)}/files/${name(file)}`;

/** Calls `onJob` with every job now and at each change, `onLink` with whether the server answers. */
export function watchJobs(onJob, onLink) {
  const source = new EventSource("/api/events");
  source.addEventListener("job", (event) => onJob(JSON.parse(event.data)));
  source.addEventListener("open", () => onLink(true));
  source.addEventListener("error", () => {
    onLink(false);
    if (source.readyState === EventSource.CLOSED) request("GET", "/api/me").catch(() => {}); // signed out?
  });
}
