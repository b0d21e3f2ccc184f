import js from "@eslint/js";
import globals from "globals";

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
  { files: ["tests/web/**"], languageOptions: { globals: globals.node } },
];
