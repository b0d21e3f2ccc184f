// The API as a page, made from openapi.json: works without internet.

import { readMe, readOpenApi } from "./api.js";
import { attempt, byId, make } from "./dom.js";
import { example, limits, typeText } from "../projects/schema.js";
import "./page_head.js";

const api = await attempt(byId("message"), readOpenApi);
const me = await readMe();
const schemas = api?.components?.schemas ?? {};
const EXAMPLES = {
  "Tus-Resumable": "1.0.0",
  "Upload-Offset": "0",
  "Upload-Length": "114359304",
};
const anchor = (text) => text.replace(/[^A-Za-z0-9]+/g, "-").toLowerCase();

function table(heads, rows) {
  const head = make(
    "thead",
    {},
    make("tr", {}, ...heads.map((text) => make("th", { scope: "col" }, text))),
  );
  return make(
    "div",
    { className: "scroll", tabIndex: 0, role: "group", ariaLabel: heads.join(", ") },
    make("table", {}, head, make("tbody", {}, ...rows)),
  );
}

const row = (name, ...cells) =>
  make(
    "tr",
    {},
    make("th", { scope: "row" }, make("code", {}, name)),
    ...cells.map((cell) => make("td", {}, cell)),
  );

/** A type, linked to its record. */
function typeLink(schema) {
  const text = typeText(schema);
  const record = text.split(" ").find((word) => schemas[word]);
  return record ? make("a", { href: `#record-${record}` }, text) : text;
}

/** The description as plain text. */
const plain = (text = "") => text.replaceAll("`", "");

const RIGHTS = {
  look: "",
  process: "who may process",
  capture: "who may record",
  review: "who may review",
  administer: "admins",
};

/** The permission an operation needs, and whether the signed-in person lacks it. */
function rights(needed = []) {
  const text = needed
    .map((one) => RIGHTS[one] ?? one)
    .filter(Boolean)
    .join(" and ");
  if (!text) return null;
  const mine = needed.every((one) => me.may.includes(one));
  return make("span", { className: "needs" }, mine ? text : `✕ ${text}, not you`);
}

const code = (text) => make("pre", { tabIndex: 0 }, text);

function copyable(text) {
  const button = make(
    "button",
    {
      type: "button",
      onclick: async () => {
        await navigator.clipboard.writeText(text);
        button.textContent = "Copied";
      },
    },
    "Copy",
  );
  return make("div", { className: "copy" }, code(text), button);
}

function fields(record) {
  const needed = new Set(record.required ?? []);
  return Object.entries(record.properties ?? {}).map(([name, one]) =>
    row(
      name,
      typeLink(one),
      [needed.has(name) ? "required" : "", limits(one)].filter(Boolean).join(", "),
      plain(one.description),
    ),
  );
}

/** A command line that calls the operation. */
function curl(path, method, operation, body) {
  const query = (operation.parameters ?? []).filter((one) => one.in === "query" && one.required);
  const values = {
    ...Object.fromEntries(
      (operation.parameters ?? []).map((one) => [
        one.name,
        example(one.schema ?? {}, schemas, one.name),
      ]),
    ),
  };
  const filled = path.replace(/\{(\w+)\}/g, (_, name) => encodeURIComponent(values[name] ?? name));
  const asked = query.length
    ? `?${query.map((one) => `${one.name}=${encodeURIComponent(values[one.name])}`).join("&")}`
    : "";
  const headers = (operation.parameters ?? []).filter((one) => one.in === "header" && one.required);
  const parts = ["curl"];
  if (method !== "get") parts.push(`-X ${method.toUpperCase()}`);
  if (me.login)
    parts.push("-b cookies.txt", ...(method === "get" ? [] : ["-H 'X-Recon4-Token: TOKEN'"]));
  for (const one of headers) parts.push(`-H '${one.name}: ${EXAMPLES[one.name] ?? "…"}'`);
  if (body?.json)
    parts.push("-H 'Content-Type: application/json'", `-d '${JSON.stringify(body.json)}'`);
  if (body?.binary) parts.push(`-H 'Content-Type: ${body.binary}'`, "--data-binary @walk.pcap");
  return `${parts.join(" ")} '${location.origin}${filled}${asked}'`;
}

function bodyOf({ requestBody }) {
  const content = requestBody?.content ?? {};
  const json = content["application/json"]?.schema;
  if (json) return { json: example(json, schemas), schema: json };
  const [binary] = Object.keys(content);
  return binary ? { binary } : null;
}

function answers({ responses = {} }) {
  const rows = Object.entries(responses).map(([status, one]) => {
    const [[kind, content] = []] = Object.entries(one.content ?? {});
    const text = content?.schema ? typeLink(content.schema) : (kind ?? "nothing");
    return row(status, text, one.description ?? "");
  });
  return [make("h3", {}, "Answers"), table(["Status", "What", ""], rows)];
}

function parts(path, method, operation) {
  const body = bodyOf(operation);
  const given = operation.parameters ?? [];
  const inputs = given.map((one) =>
    row(
      one.name,
      one.in,
      typeText(one.schema),
      [one.required ? "required" : "", limits(one.schema ?? {})].filter(Boolean).join(", "),
      plain(one.description),
    ),
  );
  const record = body?.schema?.$ref && schemas[typeText(body.schema)];
  const ok = Object.entries(operation.responses ?? {}).find(([status]) =>
    status.startsWith("2"),
  )?.[1]?.content?.["application/json"]?.schema;
  return [
    make("p", {}, plain(operation.description)),
    ...(inputs.length
      ? [make("h3", {}, "Parameters"), table(["Name", "Where", "Type", "Limits", ""], inputs)]
      : []),
    ...(record
      ? [
          make("h3", {}, "Body, JSON"),
          table(["Field", "Type", "Limits", ""], fields(record)),
          code(JSON.stringify(body.json, null, 1)),
        ]
      : []),
    ...(body?.binary ? [make("h3", {}, "Body"), make("p", {}, make("code", {}, body.binary))] : []),
    ...answers(operation),
    ...(ok && Object.keys(ok).length
      ? [
          make("h3", {}, "Example of a response"),
          code(JSON.stringify(example(ok, schemas), null, 1)),
        ]
      : []),
    make("h3", {}, "Try it"),
    copyable(curl(path, method, operation, body)),
  ];
}

function route(path, method, operation) {
  const inside = make("div");
  const summary = make(
    "summary",
    {},
    make("span", { className: `method ${method}` }, method.toUpperCase()),
    make("code", {}, path),
    make("span", { className: "quiet" }, operation.summary ?? ""),
    rights(operation["x-needs"]),
  );
  const details = make(
    "details",
    { className: "route", id: anchor(`${method} ${path}`) },
    summary,
    inside,
  );
  details.addEventListener("toggle", () => {
    if (!inside.childElementCount) inside.append(...parts(path, method, operation));
  });
  return details;
}

const tags = new Map();
for (const [path, methods] of Object.entries(api?.paths ?? {})) {
  for (const [method, operation] of Object.entries(methods)) {
    const tag = operation.tags?.[0] ?? "other";
    tags.set(tag, [...(tags.get(tag) ?? []), route(path, method, operation)]);
  }
}
const title = (text) => text[0].toUpperCase() + text.slice(1);
const records = Object.entries(schemas).map(([name, one]) =>
  make(
    "details",
    { className: "route", id: `record-${name}` },
    make("summary", {}, make("code", {}, name)),
    make(
      "div",
      {},
      make("p", {}, plain(one.description)),
      table(["Field", "Type", "Limits", ""], fields(one)),
    ),
  ),
);
byId("groups").append(
  ...[...tags.keys(), "records"].map((tag) => make("a", { href: `#tag-${tag}` }, title(tag))),
);
byId("paths").append(
  ...[...tags].flatMap(([tag, routes]) => [
    make("h2", { id: `tag-${tag}` }, title(tag)),
    ...routes,
  ]),
  make("h2", { id: "tag-records" }, "Records"),
  ...records,
);

/** Opens the section that the # of the address names. */
function openNamed() {
  const named = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!named) return;
  if (named instanceof HTMLDetailsElement) named.open = true;
  named.scrollIntoView();
}
addEventListener("hashchange", openNamed);
openNamed();
