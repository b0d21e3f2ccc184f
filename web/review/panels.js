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
  judgeText,
  length,
  mapText,
  percent,
  permissionMissing,
  plain,
  seconds,
  verdictText,
} from "./captions.js";
import { html, messagePlace, nothing, render, within } from "../shared/dom.js";
import { language, t } from "../shared/texts.js";

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
 * @param {{row?: Row, facts?: PairFacts | null, found?: AlignmentView | null, hint?: string}} pair
 *   or what leads to one
 * @param {number} path_limit_m
 */
export function showPair(panel, { row, facts, found, hint }, path_limit_m) {
  if (!row) {
    const none = html`<h2>${t("no-pair")}</h2>
      <p class="quiet">${hint}</p>`;
    return render(none, panel);
  }
  const figures = found ?? row;
  const contradicted = row.verification_m !== null && row.verification_m > path_limit_m;
  render(
    html`<h2>${row.title}</h2>
      <p>${decisionText(row, path_limit_m)}</p>
      <dl>
        ${figureRow(t("influence"), length(row.influence_m), "", t("influence-hint"))}
        ${figureRow(t("overlap"), percent(figures.overlap), "", t("overlap-hint"))}
        ${figureRow(
          t("registration-error"),
          checked(over(figures), length(figures.error_m)),
          figures.limit_m === null ? "" : t("limit-is", { limit: length(figures.limit_m) }),
          t("registration-error-hint"),
        )}
        ${figureRow(
          t("degeneracy"),
          plain(figures.degeneracy, 2),
          t("degeneracy-scale"),
          t("degeneracy-hint"),
        )}
        ${figureRow(
          t("path-discrepancy"),
          checked(contradicted, length(row.verification_m)),
          t("median-of-paths", { paths: String(row.paths ?? 0) }),
          t("path-discrepancy-hint"),
        )}
        ${figureRow(t("chi-square"), plain(row.chi2), "", t("chi-square-hint"))}
        ${figureRow(
          t("residual-to-graph"),
          facts ? length(facts.apart_m) : "…",
          facts ? degrees(facts.apart_rad, 2) : "",
          t("residual-hint"),
        )}
        ${figureRow(t("decided-by"), row.who || judgeText("program"), row.why)}
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
      <b>${judgeText(by)}</b>
      ${verdictText(verdict)}${why ? html`<small> ${why}</small>` : nothing}${
        pending ? html`<small> ${t("not-in-map-yet")}</small>` : nothing
      }
    </li>`;
  return html`<details ?open=${judgments.length > 1}>
    <summary>${t("history-of-verdict", { count: judgments.length })}</summary>
    <ol class="history">
      ${judgments.map(line)}
    </ol>
  </details>`;
}

function pathList(/** @type {PairFacts} */ { paths, path_count }) {
  const line = (/** @type {PairFacts["paths"][number]} */ path) =>
    html`<li><span>${path.frames.join(" → ")}</span><b>${length(path.residual_m)}</b></li>`;
  return html`<details>
    <summary>${t("alternative-paths", { count: String(path_count) })}</summary>
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
      ${
        items.length > MANY
          ? html`<li>${t("and-more", { count: items.length - MANY })}</li>`
          : nothing
      }
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
    const none = html`<h2>${t("effect")}</h2>
      <p class="quiet">${working ? t("solving") : t("no-decisions")}</p>`;
    return render(none, panel);
  }
  const { last, all, conflicts, missing, changed } = effect;
  const pair = (/** @type {Pair} */ p) =>
    html`<button type="button" class="link" @click=${() => choose(p)}>
      ${t("multiframes", { i: String(p[0]), j: String(p[1]) })}
    </button>`;
  const conflictTexts = conflicts.map(
    (one) =>
      html`${pair(one.pair)}
      ${t("conflict", {
        length: length(one.residual_m),
        angle: degrees(one.residual_rad),
        who: one.who,
      })}`,
  );
  const moveTexts = last.moves.slice(0, 5).map((move) =>
    t("move", {
      length: length(move.moved_m),
      frame: String(move.frame_id),
      time: seconds(move.t_s),
    }),
  );
  render(
    html`<h2>${t(working ? "effect-solving" : "effect")}</h2>
      <dl>
        ${figureRow(t("chi-last"), `${plain(last.chi2_before, 4)} → ${plain(last.chi2_after, 4)}`)}
        ${figureRow(t("edges-in-graph"), `${last.edges_before} → ${last.edges_after}`)}
        ${figureRow(t("chi-all"), `${plain(all.chi2_before, 4)} → ${plain(all.chi2_after, 4)}`)}
        ${figureRow(t("largest-move"), length(all.moves[0]?.moved_m ?? 0))}
      </dl>
      ${shortList(t("does-not-fit"), conflictTexts, "bad")}
      ${shortList(t("without-effect"), missing.map(pair))}
      ${shortList(t("registered-again"), changed.map(pair))}
      ${shortList(t("rejected-as-consequence"), all.rejected_automatically.map(pair))}
      ${shortList(t("accepted-as-consequence"), all.accepted_automatically.map(pair))}
      ${shortList(t("largest-moves"), moveTexts)}`,
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
    html`<h2>${t("map")}</h2>
      <p>${mapText(state)}</p>
      <p class="approval ${approvalLine(approval).level}">${approvalText(approval)}</p>
      ${approval.detail ? html`<p class="quiet approval-detail">${approval.detail}</p>` : nothing}
      ${approval.hash ? html`<p class="quiet hash">${approval.hash}</p>` : nothing}
      <div class="buttons">
        <button
          type="button"
          id="remake"
          ?disabled=${busy || in_map || !may_process}
          title=${may_process ? "" : permissionMissing("may-process")}
          @click=${() => remake(within(panel, ".error"))}
        >
          ${t("rebuild-map")}</button
        ><button
          type="button"
          id="approve"
          ?disabled=${Boolean(obstacle)}
          title=${obstacle}
          @click=${approve}
        >
          ${t("approve-map")}
        </button>
      </div>
      ${
        explained
          ? html`<p class="quiet">
              ${t("approval-obstacle", { obstacle: withinSentence(obstacle) })}
            </p>`
          : nothing
      }
      ${messagePlace()}`,
    panel,
  );
}

/** A sentence after a colon: in English it begins small. */
const withinSentence = (/** @type {string} */ text) =>
  language() === "en" ? text.charAt(0).toLowerCase() + text.slice(1) : text;

/** What a row of the journal is about. */
function kindText(/** @type {RowView} */ { kind, frame_i, frame_j }) {
  const pair = frame_i === null ? "" : t("did-pair", { i: String(frame_i), j: String(frame_j) });
  return KINDS[kind] ? t(KINDS[kind], { pair }) : kind + pair;
}

/**
 * What another person did meanwhile: the last of `count` new rows of the journal.
 * @param {RowView} row
 * @param {number} count
 */
export function journalNews(row, count) {
  const given = { who: row.who, did: kindText(row) };
  return count > 1 ? t("meanwhile-after", { ...given, others: count - 1 }) : t("meanwhile", given);
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
