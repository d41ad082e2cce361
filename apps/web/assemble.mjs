// Joins the page's sources, the two modules and the licences of what is in them into one file:
//   node assemble.mjs PAGE_FOLDER BIN_FOLDER OUTPUT [LIBRARIES_FOLDER]
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { gzipSync } from "node:zlib";
import { all_licences } from "./licences.mjs";

const [page, bin, output, libraries] = process.argv.slice(2);
const text = (file) => readFileSync(file, "utf8");
const glue = text(`${bin}/halflit_page.js`);
const licences = all_licences(libraries);
for (const inside of [glue, licences]) if (/<\/script|<!--/i.test(inside)) throw new Error("a part of the page would end its own element");

// The library's own tables, so that the page has no copy of them to keep.
const library = await createRequire(import.meta.url)(resolve(bin, "halflit_page.js"))({ wasmBinary: readFileSync(`${bin}/halflit_page.wasm`) });

const parts = {
  "library.json": () => library.UTF8ToString(library._halflit_tables()),
  "module.js": () => glue,
  "licences.txt": () => licences.trim(),
  "main.wasm": () => gzipSync(readFileSync(`${bin}/halflit_page.wasm`), { level: 9 }).toString("base64"),
  "kernels.wasm": () => gzipSync(readFileSync(`${bin}/halflit_wasm128.wasm`), { level: 9 }).toString("base64"),
};
const whole = text(`${page}/page.html`).replace(/@@([a-z_.]+)@@/g, (_, name) => (parts[name] ? parts[name]() : text(`${page}/${name}`).trim()));
writeFileSync(output, whole);
