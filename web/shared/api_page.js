// The API as a page, made from openapi.json: works without internet.

import { wholeUrl } from "./address.js";
import { readCurrentUser, readOpenApi } from "./api.js";
import { attempt, byId, make } from "./dom.js";
import { example, limits, typeText } from "../projects/schema.js";
import "./page_head.js";

const api = await attempt(byId("message"), readOpenApi);
const me = await readCurrentUser();
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

/** A type, linked to its schema. */
function typeLink(schema) {
  const text = typeText(schema);
  const named = text.split(" ").find((word) => schemas[word]);
  return named ? make("a", { href: `#schema-${named}` }, text) : text;
}

/** A description as plain text. */
const withoutBackticks = (text = "") => text.replaceAll("`", "");

/** The permission an operation requires, and whether the signed-in person lacks it. */
function permissionNote(required = []) {
  const text = required.filter((one) => one !== "look").join(", ");
  if (!text) return null;
  const missing = required.some((one) => !me.may.includes(one));
  const note = `Requires the permission: ${text}${missing ? ". You do not have it." : ""}`;
  return make("span", { className: "needs" }, note);
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

function fieldRows(schema) {
  const needed = new Set(schema.required ?? []);
  return Object.entries(schema.properties ?? {}).map(([name, one]) =>
    row(
      name,
      typeLink(one),
      [needed.has(name) ? "required" : "", limits(one)].filter(Boolean).join(", "),
      withoutBackticks(one.description),
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
  return `${parts.join(" ")} '${wholeUrl(filled + asked)}'`;
}

function bodyOf({ requestBody }) {
  const content = requestBody?.content ?? {};
  const json = content["application/json"]?.schema;
  if (json) return { json: example(json, schemas), schema: json };
  const [binary] = Object.keys(content);
  return binary ? { binary } : null;
}

function responseTable({ responses = {} }) {
  const rows = Object.entries(responses).map(([status, one]) => {
    const [[kind, content] = []] = Object.entries(one.content ?? {});
    const text = content?.schema ? typeLink(content.schema) : (kind ?? "nothing");
    return row(status, text, one.description ?? "");
  });
  return [make("h3", {}, "Responses"), table(["Status", "What", ""], rows)];
}

function operationDetails(path, method, operation) {
  const body = bodyOf(operation);
  const given = operation.parameters ?? [];
  const inputs = given.map((one) =>
    row(
      one.name,
      one.in,
      typeText(one.schema),
      [one.required ? "required" : "", limits(one.schema ?? {})].filter(Boolean).join(", "),
      withoutBackticks(one.description),
    ),
  );
  const schema = body?.schema?.$ref && schemas[typeText(body.schema)];
  const ok = Object.entries(operation.responses ?? {}).find(([status]) =>
    status.startsWith("2"),
  )?.[1]?.content?.["application/json"]?.schema;
  return [
    make("p", {}, withoutBackticks(operation.description)),
    ...(inputs.length
      ? [make("h3", {}, "Parameters"), table(["Name", "In", "Type", "Constraints", ""], inputs)]
      : []),
    ...(schema
      ? [
          make("h3", {}, "Body, JSON"),
          table(["Field", "Type", "Constraints", ""], fieldRows(schema)),
          code(JSON.stringify(body.json, null, 1)),
        ]
      : []),
    ...(body?.binary ? [make("h3", {}, "Body"), make("p", {}, make("code", {}, body.binary))] : []),
    ...responseTable(operation),
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
    permissionNote(operation["x-needs"]),
  );
  const details = make(
    "details",
    { className: "route", id: anchor(`${method} ${path}`) },
    summary,
    inside,
  );
  details.addEventListener("toggle", () => {
    if (!inside.childElementCount) inside.append(...operationDetails(path, method, operation));
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
const schemaSections = Object.entries(schemas).map(([name, one]) =>
  make(
    "details",
    { className: "route", id: `schema-${name}` },
    make("summary", {}, make("code", {}, name)),
    make(
      "div",
      {},
      make("p", {}, withoutBackticks(one.description)),
      table(["Field", "Type", "Constraints", ""], fieldRows(one)),
    ),
  ),
);
byId("groups").append(
  ...[...tags.keys(), "schemas"].map((tag) => make("a", { href: `#tag-${tag}` }, title(tag))),
);
byId("paths").append(
  ...[...tags].flatMap(([tag, routes]) => [
    make("h2", { id: `tag-${tag}` }, title(tag)),
    ...routes,
  ]),
  make("h2", { id: "tag-schemas" }, "Schemas"),
  ...schemaSections,
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
