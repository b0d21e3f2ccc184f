// The only module that talks to the server.

export class ApiError extends Error {
  constructor(status, { error, detail }) {
    super(typeof detail === "string" ? detail : detail.map((one) => `${one.loc.at(-1)}: ${one.msg}`).join("; "));
    this.name = error ?? "Invalid";
    this.status = status;
  }
}

async function request(method, path, body) {
  const options = { method, headers: {} };
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
  if (!response.ok) throw new ApiError(response.status, json ? answer : { detail: answer });
  return answer;
}

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
  source.addEventListener("error", () => onLink(false));
}
