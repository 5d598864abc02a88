import js from "@eslint/js";
import globals from "globals";

const PAGE = "src/fetch_pomdp/adapters/web/page";

export default [
  { ignores: ["**/vendor/", ".venv*/", "build/", "**/*.d.ts"] },
  js.configs.recommended,
  {
    rules: {
      eqeqeq: "error",
      "no-var": "error",
      "prefer-const": "error",
      "object-shorthand": "error",
      "no-shadow": "error",
    },
  },
  { files: [`${PAGE}/*.js`, "tests/e2e/film/*.js"], languageOptions: { globals: globals.browser } },
  { files: [`${PAGE}/worklet.js`], languageOptions: { globals: globals.audioWorklet } },
  {
    files: [`${PAGE}/pose-worker.js`],
    languageOptions: { sourceType: "script", globals: { ...globals.worker, Pose: "readonly" } },
  },
  {
    files: ["eslint.config.js", "tests/adapters/web/page/*.js"],
    languageOptions: { globals: { ...globals.node, WebSocket: "readonly" } },
  },
];
