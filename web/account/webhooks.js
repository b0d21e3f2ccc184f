// For admins: addresses to which finished jobs and approvals are posted.

import { addWebhook, listWebhooks, removeWebhook, testWebhook } from "../shared/api.js";
import {
  attempt,
  byId,
  fields,
  html,
  nothing,
  onSubmit,
  render,
  repeat,
  succeeds,
} from "../shared/dom.js";
import { when } from "../shared/format.js";
import { withPassword } from "./recent_login.js";
import { t } from "../shared/texts.js";

/** @import {EventKind, Webhook} from "../shared/http_types" */

/** @type {Record<EventKind, string>} */
const EVENTS = {
  "job.finished": t("event-jobs"),
  "approval.signed": t("event-approvals"),
  test: t("event-tests"),
};
const listeners = { changed: () => {} };

function row(/** @type {Webhook} */ webhook) {
  const { id, url, waiting, problem } = webhook;
  /**
   * @param {string} text
   * @param {() => Promise<unknown>} action
   */
  const button = (text, action) =>
    html`<button type="button" aria-label="${text} ${url}" @click=${() => change(action)}>
      ${text}
    </button>`;
  return html`<tr>
    <th scope="row"><code>${url}</code></th>
    <td data-label=${t("takes")}>${webhook.events.map((kind) => EVENTS[kind]).join(", ")}</td>
    <td data-label=${t("state")} class=${waiting ? "bad" : "good"}>
      ${waiting ? `▲ ${t("undelivered", { count: String(waiting) })}` : `✓ ${t("delivered")}`}
      ${problem ? html`<p class="quiet">${problem}</p>` : nothing}
    </td>
    <td data-label=${t("since")}>
      ${t("added-by", { when: when(webhook.created), who: webhook.by })}
    </td>
    <td>
      <div class="actions">
        ${button(t("test"), () => testWebhook(id))}
        ${button(t("remove"), () => withPassword(() => removeWebhook(id)))}
      </div>
    </td>
  </tr>`;
}

async function change(/** @type {() => Promise<unknown>} */ action) {
  if (!(await succeeds(byId("webhooks-message"), action))) return;
  await reload();
  listeners.changed();
}

async function reload() {
  const webhooks = await attempt(byId("webhooks-message"), listWebhooks);
  if (!webhooks) return;
  render(
    repeat(webhooks, ({ id }) => id, row),
    byId("webhooks"),
  );
  byId("no-webhooks").hidden = webhooks.length > 0;
}

/** Fills the section; `onChange` is called after each change. */
export async function showWebhooks(/** @type {() => void} */ onChange) {
  listeners.changed = onChange;
  const form = byId("add-webhook", HTMLFormElement);
  onSubmit(form, async (event) => {
    event.preventDefault();
    const { url } = fields(form);
    const add = () => withPassword(() => addWebhook({ url: url.value.trim() }));
    const added = await attempt(byId("add-webhook-message"), add);
    if (!added) return;
    form.reset();
    byId("webhook-secret").hidden = false;
    byId("webhook-secret-text").textContent = added.secret;
    await reload();
    listeners.changed();
  });
  await reload();
}
