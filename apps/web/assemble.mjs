// Joins the page's sources, the two modules and their JavaScript and the licences of what is in them into one file:
//   node assemble.mjs PAGE_FOLDER BIN_FOLDER OUTPUT LIBRARIES_FOLDER
import { readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { all_licences } from "./licences.mjs";
import { module_code, part_of_script } from "./module_code.mjs";

const [page, bin, output, libraries] = process.argv.slice(2);
const text = (file) => readFileSync(file, "utf8");
const kOfModule = ["kernels", "engine"].map((name) => `${page}/../module/${name}.js`);
const packed = (bytes) => gzipSync(bytes, { level: 9 }).toString("base64"), code_of = (name) => packed(readFileSync(`${bin}/${name}.wasm`));
const code = module_code(text(`${bin}/halflit_module.js`));

// The library's own tables, so that the page has no copy of them to keep.
const core = await new Function(`return ${code}`)()({ wasmBinary: readFileSync(`${bin}/halflit_module.wasm`) });
const library = core.UTF8ToString(core._halflit_tables());
const { version, pixel_epoch } = JSON.parse(library);

// The page writes flags as words, so the engine's table of options is empty.
const tables = `const version = ${JSON.stringify(version)}, pixelEpoch = ${pixel_epoch}, flags = [];`;
const parts = {
  "library.json": library,
  "worker.js": packed([`"use strict";`, `const halflit_module = ${code};`, tables, ...kOfModule.map((file) => part_of_script(text(file))), text(`${page}/worker.js`)].join("\n")),
  "licences.txt": all_licences(libraries).trim(),
  "main.wasm": code_of("halflit_module"),
  "kernels.wasm": code_of("halflit_wasm128"),
};
for (const part of Object.values(parts)) if (/<\/script|<!--/i.test(part)) throw new Error("a part of the page would end its own element");
writeFileSync(output, text(`${page}/page.html`).replace(/@@([a-z_.]+)@@/g, (_, name) => parts[name] ?? text(`${page}/${name}`).trim()));
