// Makes the folder of the npm package: node pack.mjs SOURCE_FOLDER BIN_FOLDER LIBRARIES_FOLDER OUTPUT_FOLDER
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { licences } from "../web/licences.mjs";
import { module_code } from "../web/module_code.mjs";

const [source, bin, libraries, output] = process.argv.slice(2);
const text = (...parts) => readFileSync(join(...parts), "utf8");
rmSync(output, { recursive: true, force: true });
mkdirSync(join(output, "licences"), { recursive: true });
for (const folder of ["apps/npm/package", "apps/web/module"]) cpSync(join(source, folder), output, { recursive: true });
for (const name of ["README.md"]) cpSync(join(source, "apps/npm", name), join(output, name));
cpSync(join(source, "LICENSE"), join(output, "LICENSE"));

// ---- the modules' own code, as an ES module -----------------------------------------------------------------------------
const glue = text(bin, "halflit_module.js");
writeFileSync(join(output, "module.js"), `// Emscripten's code around halflit.wasm.
const halflit_module = ${module_code(glue)};
export default halflit_module;
`);
cpSync(join(bin, "halflit_module.wasm"), join(output, "halflit.wasm"));
cpSync(join(bin, "halflit_wasm128.wasm"), join(output, "halflit_wasm128.wasm"));

// ---- the flags, from the module's own table -----------------------------------------------------------------------------
const { default: halflit_module } = await import(pathToFileURL(join(output, "module.js")));
const core = await halflit_module({ wasmBinary: readFileSync(join(output, "halflit.wasm")) });
const table = JSON.parse(core.UTF8ToString(core._halflit_flags()));
writeFileSync(join(output, "tables.js"), `// Made by pack.mjs, from the module's own tables.
export const version = ${JSON.stringify(table.version)}, pixelEpoch = ${table.pixel_epoch};
export const flags = ${JSON.stringify(table.flags).replaceAll('},{"names"', '},\n  {"names"')};
`);

const camel = (name) => name.replace(/^-+/, "").replace(/-([a-z0-9])/g, (_, letter) => letter.toUpperCase());
function type_of({ form, number, repeated }) {
  if (form === "") return "boolean";
  const words = form.split("|"), named = words.every((word) => /^[a-z0-9-]+$/.test(word));
  let type = named ? words.map((word) => JSON.stringify(word)).join(" | ") : "string";
  if (named && words.includes("off") && words.includes("on")) type += " | boolean";
  if (named) {
    const numbers = words.filter((word) => /^\d+$/.test(word));
    if (numbers.length > 0) type += ` | ${numbers.join(" | ")}`;
  } else if (number) type += " | number";
  if (/^(WxH|[A-Z](,[A-Z])+)$/.test(form)) type += " | readonly number[]";
  if (form.startsWith("FILE|")) type += " | ArrayBuffer | ArrayBufferView";
  return repeated ? `${type} | ReadonlyArray<${type}>` : type;
}
// Where an option means something else than the flag.
const kHelp = { "--timeout": "Stop loading after so many seconds, and each drawing after as many of its own, with code 5" };
const help_of = (flag) => (kHelp[flag.names.at(-1)] ?? flag.help).replaceAll("*/", "* /");
const options = table.flags.map((flag) => `  /** ${help_of(flag)} */\n  ${camel(flag.names.at(-1))}?: ${type_of(flag)};`);
const types = text(output, "index.d.ts");
// Scripts of CommonJS have the types under a name of theirs: TypeScript refuses those of an ES module (TS1479).
for (const name of ["index.d.ts", "index.d.cts"]) writeFileSync(join(output, name), `${types}
/** The program's flags, by their names in camelCase; values as on the command line. */
export interface FlagOptions {
${options.join("\n")}
}
`);

// ---- package.json, and the licences of what is compiled in ---------------------------------------------------------------
const description = JSON.parse(text(output, "package.json"));
description.version = table.version;
writeFileSync(join(output, "package.json"), `${JSON.stringify(description, null, 2)}\n`);
for (const [name, terms] of Object.entries(licences(libraries))) writeFileSync(join(output, "licences", `${name}.txt`), terms);
