// To be imported first: the English texts of modules under test, as the server puts them into a
// page. "./english.js?live" has those of live.ftl with those that all pages share.

import { readFileSync } from "node:fs";

import { addTexts } from "../../web/shared/texts.js";

const files = ["shared", ...new URL(import.meta.url).search.slice(1).split("&")].filter(Boolean);
const read = (file) => readFileSync(`recon4/locales/en/${file}.ftl`, "utf8");
addTexts("en", files.map(read).join("\n"));
