// The API in words, made from openapi.json: works without internet.

import { readOpenApi } from "./api.js";
import { make } from "./dom.js";
import "./page_head.js";

function operation(path, method, { summary, description, parameters = [], requestBody }) {
  const inputs = parameters.map((one) => `${one.name} (${one.in})`);
  const body = requestBody?.content["application/json"]?.schema.$ref?.split("/").at(-1);
  if (body) inputs.push(`body: ${body}`);
  return make(
    "section", { className: "panel" },
    make("h2", {}, make("code", {}, `${method.toUpperCase()} ${path}`)),
    make("p", {}, description ?? summary ?? ""),
    inputs.length ? make("p", { className: "quiet" }, `Takes ${inputs.join(", ")}`) : null,
  );
}

function schema(name, { description, properties = {} }) {
  const rows = Object.entries(properties).map(([key, one]) =>
    make("tr", {}, make("th", { scope: "row" }, key), make("td", {}, one.type ?? one.$ref?.split("/").at(-1) ?? ""), make("td", {}, one.description ?? "")),
  );
  return make("section", { className: "panel" }, make("h2", {}, name), make("p", {}, description ?? ""), make("table", {}, make("tbody", {}, ...rows)));
}

const api = await readOpenApi();
document.getElementById("paths").append(
  ...Object.entries(api.paths).flatMap(([path, methods]) => Object.entries(methods).map(([method, one]) => operation(path, method, one))),
  make("h1", {}, "Records"),
  ...Object.entries(api.components.schemas).map(([name, one]) => schema(name, one)),
);
