// The stream of jobs as they change.

import { at } from "../address.js";
import { request } from "../http.js";
import { readJob } from "./projects.js";

/** @import {Job, JobView} from "../http_types" */

const RECONNECT_MS = 3000;

/**
 * Calls `onJob` with every job now and at each change, `onLink` with whether the server answers,
 * and `onExport` with a job that makes a file of a map at each change.
 * The stream does not repeat jobs that finished while it was cut: those are requested.
 * Returns a function for views that came another way, so that these jobs are requested too.
 * @param {(view: JobView) => void} onJob
 * @param {(linked: boolean) => void} onLink
 * @param {(view: JobView) => void} onExport
 */
export function watchJobs(onJob, onLink, onExport = () => {}) {
  const newest = new Map(); // project -> its newest job among those received
  const receive = (/** @type {JobView} */ view) => {
    const { job } = view;
    const known = newest.get(job.project);
    if (known && known.id !== job.id && known.created > job.created) return;
    newest.set(job.project, job);
    onJob(view);
  };
  const requestAgain = async (/** @type {Job} */ { id }) => {
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
    source.addEventListener("export", (event) => onExport(JSON.parse(event.data)));
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
