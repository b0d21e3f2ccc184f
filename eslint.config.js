import js from "@eslint/js";
import globals from "globals";

import textsFromCatalog from "./tools/eslint_texts.js";

export default [
  { ignores: ["web/shared/vendor/**"] }, // of others, as published
  js.configs.recommended,
  {
    languageOptions: { ecmaVersion: 2024, sourceType: "module", globals: globals.browser },
    rules: { eqeqeq: ["error", "smart"] },
  },
  {
    files: ["web/**"],
    rules: {
      "no-restricted-syntax": [
        "error",
        {
          selector:
            "Program > VariableDeclaration[kind='let'], ExportNamedDeclaration > VariableDeclaration[kind='let']",
          message: "State of a page is a field of one const record, with its type.",
        },
      ],
    },
  },
  {
    files: ["web/**"],
    ignores: ["web/shared/api_page.js", "web/projects/schema.js"], // HTTP API, in English
    plugins: { recon4: { rules: { "texts-from-catalog": textsFromCatalog } } },
    rules: { "recon4/texts-from-catalog": "error" },
  },
  { files: ["tests/web/**"], languageOptions: { globals: globals.node } },
];
