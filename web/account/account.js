// The account of the signed-in person: sessions and password.

import { changePassword, endMySession, listMySessions, readCurrentUser } from "../shared/api.js";
import { attempt, byId, fields, only, onSubmit } from "../shared/dom.js";
import "../shared/page_head.js";
import "./session_list.js";

const list = only("session-list");
const form = byId("password", HTMLFormElement);

const me = await attempt(byId("message"), readCurrentUser);
if (me)
  byId("title").textContent = me.login ? `${me.name}, ${me.role}` : "This server has no login";
for (const section of document.querySelectorAll("section")) section.hidden = !me?.login;
list.source = { read: listMySessions, end: endMySession };

onSubmit(form, async (event) => {
  event.preventDefault();
  byId("password-done").textContent = "";
  const { old, fresh } = fields(form);
  if (!(await attempt(byId("password-message"), () => changePassword(old.value, fresh.value))))
    return;
  form.reset();
  byId("password-done").textContent = "The password is changed; your other sessions have ended";
  list.reload();
});
