// When to look for changes by others: regularly, and when a job of the project changes its state.

import { watchJobs } from "../shared/api.js";
import { only } from "../shared/dom.js";

const POLL_MS = 4000; // others decide too, in other browsers or through another server

/**
 * Calls `poll` when something may have changed; the page head shows whether the server answers.
 * @param {string} id
 * @param {() => unknown} poll
 */
export function watchProject(id, poll) {
  const states = new Map();
  watchJobs(
    ({ job }) => {
      if (job.project !== id || states.get(job.id) === job.state) return;
      states.set(job.id, job.state);
      poll();
    },
    (linked) => {
      only("page-head").linked = linked;
    },
  );
  setInterval(() => document.hidden || poll(), POLL_MS);
}
