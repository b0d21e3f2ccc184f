// The figures of a pair, the effect of the decisions, and the journal. Takes data, makes elements.

import { approvalLine } from "../shared/approval.js";
import { fill, make } from "../shared/dom.js";
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

const put = (panel, ...children) => panel.replaceChildren(...children.filter(Boolean));
/** A row of a list of figures; `note` stands beside the value, `title` explains the term. */
const figureRow = (term, value, note = "", title = "") =>
  make(
    "div",
    { title },
    make("dt", {}, term),
    make("dd", {}, value, note ? make("small", {}, ` ${note}`) : null),
  );
const over = (row) => row.error_m !== null && row.limit_m !== null && row.error_m > row.limit_m;

/** The selected pair: figures of the program, and of a registration made on this page. */
export function showPair(panel, row, details, registration, path_limit_m) {
  if (!row)
    return put(
      panel,
      make("h2", {}, "No pair selected"),
      make("p", { className: "quiet" }, "Press J for the first one"),
    );
  const checked = (bad, text) => (bad ? make("span", { className: "bad" }, "✕ ", text) : text);
  const figures = registration ?? row;
  const contradicted = row.verification_m !== null && row.verification_m > path_limit_m;
  put(
    panel,
    make("h2", {}, row.title),
    make("p", {}, decisionText(row, path_limit_m)),
    make(
      "dl",
      {},
      figureRow(
        "Influence on the map",
        length(row.influence_m),
        "",
        "How far the map moves if this edge is rejected instead of accepted, or the reverse",
      ),
      figureRow(
        "Overlap",
        percent(figures.overlap),
        "",
        "Part of the view volume of the first place that the second one sees too",
      ),
      figureRow(
        "Registration error",
        checked(over(figures), length(figures.error_m)),
        figures.limit_m === null ? "" : `limit ${length(figures.limit_m)}`,
        "Mean distance of the matched features",
      ),
      figureRow(
        "Degeneracy",
        plain(figures.degeneracy, 2),
        "0 unobservable, 0.33 isotropic",
        "Smallest eigenvalue of the normalized information; near 0 the places can slide",
      ),
      figureRow(
        "Path discrepancy",
        checked(contradicted, length(row.verification_m)),
        `median of ${row.paths ?? 0} alternative paths`,
        "Distance between this edge and the other paths through the graph between its ends",
      ),
      figureRow(
        "Chi-square contribution",
        plain(row.chi2),
        "",
        "Squared residual of this edge, weighted by its information",
      ),
      figureRow(
        "Residual to the graph",
        details ? length(details.apart_m) : "…",
        details ? degrees(details.apart_rad, 2) : "",
        "Difference between this edge and the relative pose in the optimized graph",
      ),
      figureRow("Decided by", row.who || "program", row.why),
    ),
    details ? historyList(historyOf(details.history, row)) : null,
    details?.paths.length ? pathList(details) : null,
  );
}

/** Who judged the pair, in order: a list that is open where more than the search did. */
function historyList(judgments) {
  if (!judgments.length) return null;
  const line = ({ by, verdict, why, pending }) =>
    make(
      "li",
      { className: verdict },
      make("b", {}, by),
      ` ${verdict}`,
      why ? make("small", {}, ` ${why}`) : null,
      pending ? make("small", {}, " (not in the map yet)") : null,
    );
  return make(
    "details",
    { open: judgments.length > 1 },
    make("summary", {}, `History of the verdict (${judgments.length})`),
    make("ol", { className: "history" }, ...judgments.map(line)),
  );
}

function pathList({ paths, path_count }) {
  const line = (path) =>
    make(
      "li",
      {},
      make("span", {}, path.frames.join(" → ")),
      make("b", {}, length(path.residual_m)),
    );
  return make(
    "details",
    {},
    make("summary", {}, `Alternative paths (${path_count})`),
    make("ul", { className: "paths" }, ...paths.slice(0, 20).map(line)),
  );
}

/** The effect of the decisions on the graph. */
export function showEffect(panel, effect, { working, choose }) {
  if (!effect)
    return put(
      panel,
      make("h2", {}, "Effect"),
      make("p", { className: "quiet" }, working ? "Solving the graph…" : "No decisions yet"),
    );
  const { last, all, missing: ineffective, changed: reregistered } = effect;
  const pair = (p) =>
    make(
      "button",
      { type: "button", className: "link", onclick: () => choose(p) },
      `multiframes ${p[0]} and ${p[1]}`,
    );
  const list = (text, pairs, name) =>
    pairs.length
      ? make(
          "div",
          { className: name ?? "" },
          make("h3", {}, text),
          make(
            "ul",
            {},
            ...pairs.slice(0, 8).map((one) => make("li", {}, ...one)),
            pairs.length > 8 ? make("li", {}, `and ${pairs.length - 8} more`) : null,
          ),
        )
      : null;
  put(
    panel,
    make("h2", {}, working ? "Effect (solving…)" : "Effect"),
    make(
      "dl",
      {},
      figureRow(
        "Chi-square, last decision",
        `${plain(last.chi2_before, 4)} → ${plain(last.chi2_after, 4)}`,
      ),
      figureRow("Edges in the graph", `${last.edges_before} → ${last.edges_after}`),
      figureRow(
        "Chi-square, all decisions",
        `${plain(all.chi2_before, 4)} → ${plain(all.chi2_after, 4)}`,
      ),
      figureRow("Largest move, all decisions", length(all.moves[0]?.moved_m ?? 0)),
    ),
    list(
      "✕ Accepted, but does not fit the graph",
      effect.conflicts.map((one) => [
        pair(one.pair),
        ` residual ${length(one.residual_m)}, ${degrees(one.residual_rad)}, by ${one.who}`,
      ]),
      "bad",
    ),
    list(
      "Without effect: not in this graph, or not registered",
      ineffective.map((p) => [pair(p)]),
    ),
    list(
      "Registered again since the decision",
      reregistered.map((p) => [pair(p)]),
    ),
    list(
      "Rejected automatically as a consequence",
      all.rejected_automatically.map((p) => [pair(p)]),
    ),
    list(
      "Accepted automatically as a consequence",
      all.accepted_automatically.map((p) => [pair(p)]),
    ),
    list(
      "Largest moves of the last decision",
      last.moves
        .slice(0, 5)
        .map((move) => [
          `${length(move.moved_m)} at multiframe ${move.frame_id} (${seconds(move.t_s)})`,
        ]),
    ),
  );
}

/** Whether the decisions are in the map, and who approved it. */
export function showApproval(panel, state, { remake, approve }) {
  const { approval } = state;
  const obstacle = approvalObstacle(state);
  fill(
    panel,
    make("h2", {}, "Map"),
    make("p", {}, mapText(state)),
    make("p", { className: `approval ${approvalLine(approval).level}` }, approvalText(approval)),
    approval.detail ? make("p", { className: "quiet approval-detail" }, approval.detail) : null,
    approval.hash ? make("p", { className: "quiet hash" }, approval.hash) : null,
    make(
      "div",
      { className: "buttons" },
      make(
        "button",
        {
          type: "button",
          id: "remake",
          disabled: state.busy || state.in_map || !state.may_process,
          title: state.may_process ? "" : permissionMissing("process"),
        },
        "Rebuild map",
      ),
      make(
        "button",
        {
          type: "button",
          id: "approve",
          disabled: Boolean(obstacle),
          title: obstacle,
        },
        "Approve map…",
      ),
    ),
    obstacle && !state.busy && approval.kind !== "approved"
      ? make(
          "p",
          { className: "quiet" },
          `Approval: ${obstacle[0].toLowerCase()}${obstacle.slice(1)}`,
        )
      : null,
    make("p", { className: "error", role: "alert" }),
  );
  panel.querySelector("#remake").onclick = () => remake(panel.querySelector(".error"));
  panel.querySelector("#approve").onclick = () => approve();
}

const about = (row) =>
  row.frame_i === null ? "" : ` multiframes ${row.frame_i} and ${row.frame_j}`;

/** What another person did meanwhile: the last of `count` new rows of the journal. */
export function journalNews(row, count) {
  const more =
    count > 1 ? `, after ${count - 1} other ${count > 2 ? "decisions" : "decision"}` : "";
  return `Meanwhile ${row.who} ${KINDS[row.kind] ?? row.kind}${about(row)}${more}`;
}

export function showJournal(list, rows) {
  fill(
    list,
    ...rows.map((row) =>
      make(
        "li",
        { value: row.seq },
        make("b", {}, row.who),
        ` ${KINDS[row.kind] ?? row.kind}${about(row)}`,
        make("small", {}, ` ${when(row.time)}`),
        row.why ? make("q", {}, row.why) : null,
      ),
    ),
  );
}
