// Joins the page's sources and the two modules into one file: node assemble.mjs PAGE_FOLDER BIN_FOLDER OUTPUT
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { gzipSync } from "node:zlib";

const [page, bin, output] = process.argv.slice(2);
const text = (file) => readFileSync(file, "utf8");
const glue = text(`${bin}/halflit_simd.js`).replaceAll("halflit_simd.wasm", "module.wasm");
if (glue !== text(`${bin}/halflit_scalar.js`).replaceAll("halflit_scalar.wasm", "module.wasm"))
  throw new Error("the modules need different code around them");
if (/<\/script/i.test(glue)) throw new Error("the modules' code would end its own element");

// The library's own tables, so that the page has no copy of them to keep.
const library = await createRequire(import.meta.url)(resolve(bin, "halflit_scalar.js"))({ wasmBinary: readFileSync(`${bin}/halflit_scalar.wasm`) });

const parts = {
  "library.json": () => library.UTF8ToString(library._halflit_tables()),
  "module.js": () => glue,
  "halflit_simd.wasm": () => gzipSync(readFileSync(`${bin}/halflit_simd.wasm`), { level: 9 }).toString("base64"),
  "halflit_scalar.wasm": () => gzipSync(readFileSync(`${bin}/halflit_scalar.wasm`), { level: 9 }).toString("base64"),
};
const whole = text(`${page}/page.html`).replace(/@@([a-z_.]+)@@/g, (_, name) => (parts[name] ? parts[name]() : text(`${page}/${name}`).trim()));
writeFileSync(output, whole);
