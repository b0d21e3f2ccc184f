// The account of the signed-in person: sessions and password.

import { changePassword, endMySession, listMySessions, readCurrentUser } from "../shared/api.js";
import { attempt, byId, fields, only, onSubmit } from "../shared/dom.js";
import "../shared/page_head.js";
import { offerTokens } from "./access_tokens.js";
import "./session_list.js";
import { t, wordOf } from "../shared/texts.js";

const list = only("session-list");
const form = byId("password", HTMLFormElement);

const me = await attempt(byId("message"), readCurrentUser);
if (me)
  byId("title").textContent = me.login ? `${me.name}, ${wordOf("role", me.role)}` : t("no-login");
for (const section of document.querySelectorAll("section")) section.hidden = !me?.login;
if (me?.login) offerTokens(me, () => list.reload());
list.source = { read: listMySessions, end: endMySession };

onSubmit(form, async (event) => {
  event.preventDefault();
  byId("password-done").textContent = "";
  const { old, fresh } = fields(form);
  if (!(await attempt(byId("password-message"), () => changePassword(old.value, fresh.value))))
    return;
  form.reset();
  byId("password-done").textContent = t("password-changed");
  list.reload();
});
