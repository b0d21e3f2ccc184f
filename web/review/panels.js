// The figures of a pair, the effect of the decisions, and the journal. Takes data, makes elements.

import { approvalLine } from "../shared/approval.js";
import { when } from "../shared/format.js";
import { historyOf } from "./history.js";
import {
  KINDS,
  approvalObstacle,
  approvalText,
  decisionText,
  degrees,
  length,
  mapText,
  percent,
  permissionMissing,
  plain,
  seconds,
} from "./captions.js";
import { html, messagePlace, nothing, render, within } from "../shared/dom.js";

const MANY = 8; // of a list

/**
 * @import {AlignmentView, PairFacts, ReviewView, RowView} from "../shared/http_types"
 * @import {Content} from "../shared/dom.js"
 * @import {Verdicts} from "./history.js"
 * @import {Row, TimedEffect} from "./state.js"
 * @typedef {[number, number]} Pair
 */

/**
 * A row of a list of figures; `note` stands beside the value, `title` explains the term.
 * @param {string} term
 * @param {Content} value
 */
const figureRow = (term, value, note = "", title = "") =>
  html`<div title=${title}>
    <dt>${term}</dt>
    <dd>${value}${note ? html`<small> ${note}</small>` : nothing}</dd>
  </div>`;
const over = (/** @type {Pick<AlignmentView, "error_m" | "limit_m">} */ { error_m, limit_m }) =>
  error_m !== null && limit_m !== null && error_m > limit_m;

/**
 * @param {boolean} bad
 * @param {string} text
 */
const checked = (bad, text) => (bad ? html`<span class="bad">✕ ${text}</span>` : text);

/**
 * The selected pair: figures of the program, and of a registration made on this page.
 * @param {HTMLElement} panel
 * @param {{row?: Row, facts?: PairFacts | null, found?: AlignmentView | null}} pair
 * @param {number} path_limit_m
 */
export function showPair(panel, { row, facts, found }, path_limit_m) {
  if (!row) {
    const none = html`<h2>No pair selected</h2>
      <p class="quiet">Press J for the first one</p>`;
    return render(none, panel);
  }
  const figures = found ?? row;
  const contradicted = row.verification_m !== null && row.verification_m > path_limit_m;
  render(
    html`<h2>${row.title}</h2>
      <p>${decisionText(row, path_limit_m)}</p>
      <dl>
        ${figureRow(
          "Influence on the map",
          length(row.influence_m),
          "",
          "How far the map moves if this edge is rejected instead of accepted, or the reverse",
        )}
        ${figureRow(
          "Overlap",
          percent(figures.overlap),
          "",
          "Part of the view volume of the first place that the second one sees too",
        )}
        ${figureRow(
          "Registration error",
          checked(over(figures), length(figures.error_m)),
          figures.limit_m === null ? "" : `limit ${length(figures.limit_m)}`,
          "Mean distance of the matched features",
        )}
        ${figureRow(
          "Degeneracy",
          plain(figures.degeneracy, 2),
          "0 unobservable, 0.33 isotropic",
          "Smallest eigenvalue of the normalized information; near 0 the places can slide",
        )}
        ${figureRow(
          "Path discrepancy",
          checked(contradicted, length(row.verification_m)),
          `median of ${row.paths ?? 0} alternative paths`,
          "Distance between this edge and the other paths through the graph between its ends",
        )}
        ${figureRow(
          "Chi-square contribution",
          plain(row.chi2),
          "",
          "Squared residual of this edge, weighted by its information",
        )}
        ${figureRow(
          "Residual to the graph",
          facts ? length(facts.apart_m) : "…",
          facts ? degrees(facts.apart_rad, 2) : "",
          "Difference between this edge and the relative pose in the optimized graph",
        )}
        ${figureRow("Decided by", row.who || "program", row.why)}
      </dl>
      ${facts ? historyList(historyOf(facts.history, row)) : nothing}
      ${facts?.paths.length ? pathList(facts) : nothing}`,
    panel,
  );
}

/** Who judged the pair, in order: a list that is open where more than the search did. */
function historyList(/** @type {Verdicts[]} */ judgments) {
  if (!judgments.length) return nothing;
  const line = (/** @type {Verdicts} */ { by, verdict, why, pending }) =>
    html`<li class=${verdict}>
      <b>${by}</b> ${verdict}${why ? html`<small> ${why}</small>` : nothing}${
        pending ? html`<small> (not in the map yet)</small>` : nothing
      }
    </li>`;
  return html`<details ?open=${judgments.length > 1}>
    <summary>History of the verdict (${judgments.length})</summary>
    <ol class="history">
      ${judgments.map(line)}
    </ol>
  </details>`;
}

function pathList(/** @type {PairFacts} */ { paths, path_count }) {
  const line = (/** @type {PairFacts["paths"][number]} */ path) =>
    html`<li><span>${path.frames.join(" → ")}</span><b>${length(path.residual_m)}</b></li>`;
  return html`<details>
    <summary>Alternative paths (${path_count})</summary>
    <ul class="paths">
      ${paths.slice(0, 20).map(line)}
    </ul>
  </details>`;
}

/**
 * A list with a title, of at most eight things; nothing if there are none.
 * @param {string} title
 * @param {Content[]} items
 */
function shortList(title, items, className = "") {
  if (!items.length) return nothing;
  return html`<div class=${className}>
    <h3>${title}</h3>
    <ul>
      ${items.slice(0, MANY).map((one) => html`<li>${one}</li>`)}
      ${items.length > MANY ? html`<li>and ${items.length - MANY} more</li>` : nothing}
    </ul>
  </div>`;
}

/**
 * The effect of the decisions on the graph.
 * @param {HTMLElement} panel
 * @param {TimedEffect | null} effect
 * @param {{working: boolean, choose: (pair: Pair) => unknown}} options
 */
export function showEffect(panel, effect, { working, choose }) {
  if (!effect) {
    const none = html`<h2>Effect</h2>
      <p class="quiet">${working ? "Solving the graph…" : "No decisions yet"}</p>`;
    return render(none, panel);
  }
  const { last, all, conflicts, missing, changed } = effect;
  const pair = (/** @type {Pair} */ p) =>
    html`<button type="button" class="link" @click=${() => choose(p)}>
      multiframes ${p[0]} and ${p[1]}
    </button>`;
  const conflictTexts = conflicts.map(
    (one) =>
      html`${pair(one.pair)} residual ${length(one.residual_m)}, ${degrees(one.residual_rad)}, by
      ${one.who}`,
  );
  const moveTexts = last.moves
    .slice(0, 5)
    .map((move) => `${length(move.moved_m)} at multiframe ${move.frame_id} (${seconds(move.t_s)})`);
  render(
    html`<h2>${working ? "Effect (solving…)" : "Effect"}</h2>
      <dl>
        ${figureRow(
          "Chi-square, last decision",
          `${plain(last.chi2_before, 4)} → ${plain(last.chi2_after, 4)}`,
        )}
        ${figureRow("Edges in the graph", `${last.edges_before} → ${last.edges_after}`)}
        ${figureRow(
          "Chi-square, all decisions",
          `${plain(all.chi2_before, 4)} → ${plain(all.chi2_after, 4)}`,
        )}
        ${figureRow("Largest move, all decisions", length(all.moves[0]?.moved_m ?? 0))}
      </dl>
      ${shortList("✕ Accepted, but does not fit the graph", conflictTexts, "bad")}
      ${shortList("Without effect: not in this graph, or not registered", missing.map(pair))}
      ${shortList("Registered again since the decision", changed.map(pair))}
      ${shortList("Rejected automatically as a consequence", all.rejected_automatically.map(pair))}
      ${shortList("Accepted automatically as a consequence", all.accepted_automatically.map(pair))}
      ${shortList("Largest moves of the last decision", moveTexts)}`,
    panel,
  );
}

/**
 * Whether the decisions are in the map, and who approved it.
 * @param {HTMLElement} panel
 * @param {ReviewView} state
 * @param {{remake: (message: HTMLElement) => unknown, approve: () => unknown}} act
 */
export function showApproval(panel, state, { remake, approve }) {
  const { approval, busy, in_map, may_process } = state;
  const obstacle = approvalObstacle(state);
  const explained = obstacle && !busy && approval.kind !== "approved";
  render(
    html`<h2>Map</h2>
      <p>${mapText(state)}</p>
      <p class="approval ${approvalLine(approval).level}">${approvalText(approval)}</p>
      ${approval.detail ? html`<p class="quiet approval-detail">${approval.detail}</p>` : nothing}
      ${approval.hash ? html`<p class="quiet hash">${approval.hash}</p>` : nothing}
      <div class="buttons">
        <button
          type="button"
          id="remake"
          ?disabled=${busy || in_map || !may_process}
          title=${may_process ? "" : permissionMissing("process")}
          @click=${() => remake(within(panel, ".error"))}
        >
          Rebuild map</button
        ><button
          type="button"
          id="approve"
          ?disabled=${Boolean(obstacle)}
          title=${obstacle}
          @click=${approve}
        >
          Approve map…
        </button>
      </div>
      ${
        explained
          ? html`<p class="quiet">
              Approval: ${obstacle.charAt(0).toLowerCase()}${obstacle.slice(1)}
            </p>`
          : nothing
      }
      ${messagePlace()}`,
    panel,
  );
}

/** What a row of the journal is about. */
const kindText = (/** @type {RowView} */ row) =>
  (KINDS[row.kind] ?? row.kind) +
  (row.frame_i === null ? "" : ` multiframes ${row.frame_i} and ${row.frame_j}`);

/**
 * What another person did meanwhile: the last of `count` new rows of the journal.
 * @param {RowView} row
 * @param {number} count
 */
export function journalNews(row, count) {
  const more =
    count > 1 ? `, after ${count - 1} other ${count > 2 ? "decisions" : "decision"}` : "";
  return `Meanwhile ${row.who} ${kindText(row)}${more}`;
}

/**
 * @param {HTMLElement} list
 * @param {RowView[]} rows
 */
export const showJournal = (list, rows) =>
  render(
    rows.map(
      (row) =>
        html`<li value=${row.seq}>
          <b>${row.who}</b> ${kindText(row)}<small> ${when(row.time)}</small>${
            row.why ? html`<q>${row.why}</q>` : nothing
          }
        </li>`,
    ),
    list,
  );
