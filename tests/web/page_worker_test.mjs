// The page's worker with the page's own modules, under Node.js, against the program: node page_worker_test.mjs PROGRAM PAGE SOURCE WORK
import { existsSync, mkdirSync, readFileSync, rmSync } from "node:fs";
import { createContext, runInContext } from "node:vm";
import { gunzipSync } from "node:zlib";
import { check, end, native_hash, source, work } from "./harness.mjs";

const page = process.argv[3];
if (!existsSync(page)) {
  console.log("skipped: the page was not built, as there is no Emscripten");
  process.exit(77);
}
rmSync(work, { recursive: true, force: true });
mkdirSync(work, { recursive: true });
const html = readFileSync(page, "utf8"), element = (id) => new RegExp(`id="${id}">([\\s\\S]*?)</script>`).exec(html)[1];
check("the page has at most 3 MB", html.length <= 3e6, html.length);
for (const words of ["based in part on the work of the Independent JPEG Group", "Copyright (c) 2026 the halflit authors", "======== emscripten ="])
  check(`the page has the notice "${words}"`, html.includes(words));

function unpacked(id) {
  const bytes = gunzipSync(Buffer.from(element(id).trim(), "base64"));
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
}

const lines = readFileSync(`${source}/tests/web/scenes.txt`, "utf8").split("\n").filter((line) => /^(demo|sphere:|lights:)/.test(line));
const expected = new Map(lines.map((line) => [line, native_hash(line.split(" "))]));
for (const isa of ["wasm128", "scalar"]) {
  let answered = null;
  const context = createContext({ console, WebAssembly, performance, TextDecoder, TextEncoder, URL, Uint8Array, Blob, setTimeout, importScripts() {},
    self: { location: { href: "" } }, location: { href: "" }, postMessage: (answer) => answered(answer) });
  runInContext(Buffer.from(unpacked("worker_code")).toString(), context);
  const ask = (task) => new Promise((resolve) => { answered = resolve; context.onmessage({ data: { ...task, id: 1 } }); });
  await ask({ kind: "start", wasm: unpacked("main_wasm"), wasm128: unpacked("kernels_wasm"), simd: isa === "wasm128" });
  for (const line of lines) {
    const [scene, ...flags] = line.split(" "), answer = await ask({ kind: "draw", scene, flags });
    const found = answer.error ?? `${answer.report.pixel_hash},${answer.report.isa}`;
    check(line, found === `${expected.get(line)},${isa}`, `${found}, native ${expected.get(line)}`);
  }
  const compared = await ask({ kind: "compare", scene: "demo", flags: ["--size", "64x48"] });
  check(`${isa}: the error against the reference is small`, compared.report?.max > 0 && compared.report.max < 0.01, compared.error ?? compared.report.max);
}
end();
