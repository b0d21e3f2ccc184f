// <job-workers>: who makes parts of a job on other processes or computers.

import { readCurrentUser, readWorkers } from "../shared/api.js";
import { html, nothing, render } from "../shared/dom.js";
import { seconds } from "../shared/format.js";
import { t } from "../shared/texts.js";

/** @import {JobView, JobWorkers, WorkerRecord} from "../shared/http_types" */

export class JobWorkersPart extends HTMLElement {
  /** @type {{of: JobWorkers | null, dashboard: string, asked: boolean}} */
  #state = { of: null, dashboard: "", asked: false };

  set view(/** @type {JobView} */ { workers }) {
    this.#state.of = workers;
    this.hidden = !workers.workers.length && !workers.problem;
    if (!this.hidden) this.#findDashboard();
    this.#draw();
  }

  /** Only administrators are shown the page of the scheduler: it may have no login of its own. */
  async #findDashboard() {
    if (this.#state.asked) return;
    this.#state.asked = true;
    const { may } = await readCurrentUser();
    if (!may.includes("administer")) return;
    this.#state.dashboard = (await readWorkers()).dashboard;
    this.#draw();
  }

  #draw() {
    const { of, dashboard } = this.#state;
    if (!of || this.hidden) return;
    render(
      html`<h2>${t("workers")}</h2>
        ${
          of.problem
            ? html`<p class="quiet">${t("workers-unused", { problem: of.problem })}</p>`
            : nothing
        }
        ${of.workers.length ? table(of.workers) : nothing}
        ${
          dashboard
            ? html`<p><a href=${dashboard} rel="noreferrer">${t("dashboard-of-scheduler")}</a></p>`
            : nothing
        }`,
      this,
    );
  }
}

const table = (/** @type {WorkerRecord[]} */ workers) =>
  html`<table>
    <thead>
      <tr>
        <th scope="col">${t("worker")}</th>
        <th scope="col">${t("worker-now")}</th>
        <th scope="col" class="number">${t("worker-made")}</th>
        <th scope="col" class="number">${t("time")}</th>
      </tr>
    </thead>
    <tbody>
      ${workers.map(row)}
    </tbody>
  </table>`;

const row = (/** @type {WorkerRecord} */ { name, part, made, failed, seconds: time_s }) =>
  html`<tr>
    <th scope="row">${name}</th>
    <td>${part || t("worker-idle")}</td>
    <td class="number">
      ${made}${
        failed
          ? html`<span class="bad"> ▲ ${t("worker-failed", { count: failed })}</span>`
          : nothing
      }
    </td>
    <td class="number">${seconds(time_s)}</td>
  </tr>`;

customElements.define("job-workers", JobWorkersPart);
