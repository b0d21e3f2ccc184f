// Access tokens: a person lets a program or an assistant act, with a role and until a day.

import { makeAccessToken } from "../shared/api.js";
import { wholeUrl } from "../shared/address.js";
import { attempt, byId, fields, html, nothing, onSubmit, render } from "../shared/dom.js";
import { withPassword } from "./recent_login.js";
import { t } from "../shared/texts.js";

/** @import {Me, Permission, Role} from "../shared/http_types" */

/** @type {{role: Role, needs: Permission, text: string}[]} Roles of programs: who may give them. */
const ROLES = [
  { role: "viewer", needs: "look", text: t("token-role-viewer") },
  { role: "operator", needs: "capture", text: t("token-role-operator") },
  { role: "reviewer", needs: "review", text: t("token-role-reviewer") },
];
const SCHEME = "Bearer";
const DAYS = [1, 7, 30, 90, 365];
const USUAL_DAYS = 30;

/** What most programs that host an assistant are configured with. */
const hostEntry = (/** @type {string} */ token) =>
  JSON.stringify(
    {
      mcpServers: {
        recon4: { url: wholeUrl("/mcp"), headers: { Authorization: [SCHEME, token].join(" ") } },
      },
    },
    null,
    2,
  );

function draw(/** @type {Me} */ me) {
  const roles = ROLES.filter(({ needs }) => me.may.includes(needs));
  const option = (/** @type {string | number} */ value, /** @type {string} */ text) =>
    html`<option value=${value} ?selected=${value === USUAL_DAYS}>${text}</option>`;
  render(
    html`<label
        ><span>${t("token-for")}</span
        ><input
          name="label"
          maxlength="64"
          required
          autocomplete="off"
          placeholder=${t("token-example")}
      /></label>
      <label
        ><span>${t("token-may")}</span
        ><select name="role">
          ${roles.map(({ role, text }) => option(role, text))}
        </select></label
      >
      <label
        ><span>${t("token-days")}</span
        ><select name="days">
          ${DAYS.map((days) => option(days, t("share-days", { days })))}
        </select></label
      >
      <button>${t("token-make")}</button>
      <p class="error" id="token-message" role="alert"></p>`,
    byId("make-token"),
  );
}

function show(/** @type {string} */ token) {
  render(
    token
      ? html`<p>${t("token-made")}</p>
          <p><code id="token">${token}</code></p>
          <p>${t("token-assistant")}</p>
          <pre tabindex="0">${hostEntry(token)}</pre>`
      : nothing,
    byId("made-token"),
  );
  byId("made-token").hidden = !token;
}

/** Fills the section; `onChange` is called after a token was made. */
export function offerTokens(/** @type {Me} */ me, /** @type {() => void} */ onChange) {
  const form = byId("make-token", HTMLFormElement);
  draw(me);
  onSubmit(form, async (event) => {
    event.preventDefault();
    const { label, role, days } = fields(form);
    const made = await attempt(byId("token-message"), () =>
      withPassword(() =>
        makeAccessToken({
          label: label.value.trim(),
          role: /** @type {Role} */ (role.value),
          days: Number(days.value),
        }),
      ),
    );
    if (!made) return;
    form.reset();
    show(made.token);
    onChange();
  });
}
