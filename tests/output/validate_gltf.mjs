// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: node validate_gltf.mjs FILE...
// Puts each glTF file before the Khronos validator and prints what it finds. The status is 1 on
// any error or warning, 2 if the validator is missing (./dev setup installs it).
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";

// The package is looked for under build/npm, then along NODE_PATH.
const require = createRequire(new URL("../../build/npm/", import.meta.url));
const severities = ["error", "warning", "info", "hint"];

async function validate(validator, path) {
  const bytes = new Uint8Array(await readFile(path));
  const { issues } = await validator.validateBytes(bytes, {
    uri: path,
    maxIssues: 100,
    externalResourceFunction: async (uri) =>
      new Uint8Array(await readFile(join(dirname(path), decodeURIComponent(uri)))),
  });
  for (const { severity, code, message, pointer } of issues.messages) {
    console.log(`${path}: ${severities[severity]} ${code} at ${pointer ?? "/"}: ${message}`);
  }
  console.log(`${path}: ${issues.numErrors} errors, ${issues.numWarnings} warnings`);
  return issues.numErrors + issues.numWarnings === 0;
}

const paths = process.argv.slice(2);
if (paths.length === 0) {
  console.error("usage: node validate_gltf.mjs FILE...");
  process.exit(2);
}
let validator;
try {
  validator = require("gltf-validator");
} catch {
  console.error("gltf-validator is not installed; ./dev setup does it");
  process.exit(2);
}
let sound = true;
for (const path of paths) {
  try {
    sound = (await validate(validator, path)) && sound;
  } catch (error) {
    console.log(`${path}: ${error.message ?? error}`);
    sound = false;
  }
}
process.exit(sound ? 0 : 1);
