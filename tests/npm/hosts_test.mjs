// The npm package under each host that is there: Node.js with the files for each kind of host, Deno, Bun, and workerd with the example worker.
import { copyFileSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { check, end, native_hash, source, work } from "../web/harness.mjs";
import { begin, command, installed, must, project } from "./project.mjs";
import { package_folder, tool } from "./tools.mjs";

const { bytes } = await begin();
copyFileSync(join(source, "apps/examples/knot.glb"), join(work, "knot.glb"));
// ---- hosts --------------------------------------------------------------------------------------------------------------
writeFileSync(join(project, "by_name.js"), `import { render, init } from "halflit";
const start = performance.now(), { isa } = await init(), started = performance.now();
const { hash } = await render("demo", { width: 160, height: 120 });
console.log(JSON.stringify({ isa, hash, start_ms: started - start, first_ms: performance.now() - started }));\n`);
const demo = native_hash(["demo", "--size", "160x120"]);
const told = (words) => JSON.parse(must(words));
const in_node = told(["node", "by_name.js"]);
check("Node.js finds the package by its name", in_node.hash === demo && in_node.isa === "wasm128", JSON.stringify(in_node));
// A browser's fetch, and a worker's import of compiled code.
writeFileSync(join(project, "fetch.mjs"), `import { readFile } from "node:fs/promises";
globalThis.fetch = async (url) => new Response(await readFile(url), { headers: { "content-type": "application/wasm" } });\n`);
check("its files for browsers draw", told(["node", "--conditions=browser", "--import", "./fetch.mjs", "by_name.js"]).hash === demo);
writeFileSync(join(project, "hooks.mjs"), `import { readFileSync } from "node:fs";
export async function load(url, context, next) {
  if (!/\\.wasm(\\?module)?$/.test(url)) return next(url, context);
  const path = JSON.stringify(new URL(url).pathname);
  return { format: "module", shortCircuit: true, source: \`import { readFileSync } from "node:fs"; export default new WebAssembly.Module(readFileSync(\${path}));\` };
}\n`);
writeFileSync(join(project, "wasm.mjs"), `import { register } from "node:module";\nregister("./hooks.mjs", import.meta.url);\n`);
for (const condition of ["workerd", "edge-light"])
  check(`its files for ${condition} draw`, told(["node", `--conditions=${condition}`, "--import", "./wasm.mjs", "by_name.js"]).hash === demo);
writeFileSync(join(project, "core.js"), `import { readFile } from "node:fs/promises"; import { init, render } from "halflit/core";
await init({ wasm: await readFile(new URL(import.meta.resolve("halflit/halflit.wasm"))) });
console.log(JSON.stringify(await render("demo", { width: 160, height: 120 }).then(({ hash, report }) => ({ hash, isa: report.isa }))));\n`);
const by_core = told(["node", "core.js"]);
check("code that the host gives is taken", by_core.hash === demo && by_core.isa === "scalar");
writeFileSync(join(project, "no_core.js"), `import { HalflitError, init, load, memory, render } from "halflit/core"; import { readFile } from "node:fs/promises";
const kernels = await readFile(new URL(import.meta.resolve("halflit/halflit_wasm128.wasm")));
const attempts = [() => render("demo"), () => load("demo"), () => memory(), () => init(), () => init({ wasm: new Uint8Array(99) }), () => init({ wasm: "halflit.wasm" }), () => init({ wasm: 3 }),
  () => init({ wasm: kernels }), () => init({ wasm: new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]) }), () => init({ wasm: new Response("", { status: 404 }) }),
  () => init({ wasm: Promise.reject(new Error("no net")) }), () => init("fast")];
console.log(JSON.stringify(await Promise.all(attempts.map((attempt) => attempt().then(() => "taken", (error) => (error instanceof HalflitError && !error.message.includes("\\n") ? error.code : String(error)))))));\n`);
const refused = told(["node", "no_core.js"]);
check("without code, or with wrong code, each call is refused by one line", String(refused) === "2,2,2,2,3,2,2,3,3,4,4,2", refused);

copyFileSync(join(installed, "examples/worker.js"), join(project, "worker.js"));
writeFileSync(join(project, "served.js"), `import worker from "./worker.js"; import { readFileSync } from "node:fs"; import { memory } from "halflit";
const ask = (body, query = "") => worker.fetch(new Request("https://thumbnails.test/" + query, { method: "POST", body }));
const knot = readFileSync(${JSON.stringify(join(work, "knot.glb"))}), start = performance.now();
const first = await ask(knot, "?width=200&height=150&view=iso"), png = new Uint8Array(await first.arrayBuffer()), cold_ms = performance.now() - start;
const again = performance.now();
await ask(knot, "?width=200&height=150&view=iso");
const warm_ms = performance.now() - again, memory_bytes = await memory(), statuses = [(await ask("no model")).status, (await ask(knot, "?view=sideways")).status, (await worker.fetch(new Request("https://thumbnails.test/"))).status];
let read = 0;
const endless = new ReadableStream({ pull(stream) { read += 1 << 20; stream.enqueue(new Uint8Array(1 << 20)); if (read >= 80 << 20) stream.close(); } });
const large = (await worker.fetch(new Request("https://thumbnails.test/", { method: "POST", body: endless, duplex: "half" }))).status;
const announced = new Request("https://thumbnails.test/", { method: "POST", body: knot, headers: { "content-length": String(33 << 20) } });
const triangles = 600000, bytes = new Uint8Array(84 + 50 * triangles);  // of an STL file
const view = new DataView(bytes.buffer);
view.setUint32(80, triangles, true);
for (let at = 84; at < bytes.length; at += 50) [12, 28, 44].forEach((corner) => view.setFloat32(at + corner, at, true));
const heavy_status = (await ask(bytes)).status, heavy_memory = await memory();
await ask(knot);
const limits = { heavy: heavy_status, heavy_memory, later_memory: await memory(), large, read, announced: (await worker.fetch(announced)).status, untouched: !announced.bodyUsed };
console.log(JSON.stringify({ status: first.status, type: first.headers.get("content-type"), tag: first.headers.get("etag"), png: [...png.slice(1, 4)], statuses, limits, cold_ms, warm_ms, memory_bytes }));\n`);
const served = told(["node", "--conditions=workerd", "--import", "./wasm.mjs", "served.js"]);
const thumbnail = native_hash([join(work, "knot.glb"), "--size", "200x150", "--view", "iso", "--samples", "4"]);
check("the example worker draws", served.status === 200 && served.type === "image/png" && served.tag === `"${thumbnail}"` && String(served.png) === "80,78,71", JSON.stringify(served));
check("the example worker refuses", String(served.statuses) === "400,400,405", served.statuses);
check("it reads no more of a body than its limit", served.limits.large === 413 && served.limits.read <= 36 << 20, JSON.stringify(served.limits));
check("and nothing of one that says it is larger", served.limits.announced === 413 && served.limits.untouched, JSON.stringify(served.limits));
check("a model of 600,000 triangles is too large for it", served.limits.heavy === 413 && served.limits.heavy_memory < 128 << 20 && served.limits.later_memory <= 80 << 20, JSON.stringify(served.limits));
check("the example worker takes at most 64 MB for a small model", served.memory_bytes <= 64 << 20, served.memory_bytes);

// ---- other runtimes -----------------------------------------------------------------------------------------------------
// All calls of calls_test.mjs, and the command line.
for (const [name, words] of [["deno", ["run", "-A"]], ["bun", []]]) {
  const program_of_host = tool(name);
  if (!program_of_host) {
    console.log(`skipped: there is no ${name}`);
    continue;
  }
  const version = `${name} ${/\d+\.\d+\.\d+/.exec(command([program_of_host, "--version"]).stdout)}`;
  const called = command([program_of_host, ...words, join(source, "tests/npm/calls_test.mjs"), ...process.argv.slice(2, 5), join(work, name)], { cwd: source });
  check(`${version}: the calls do what they do under Node.js`, called.status === 0, called.status === 0 ? "" : called.stdout.split("\n").filter((line) => !line.startsWith("ok")).join("\n") + called.stderr);
  const drawn = told([program_of_host, ...words, "by_name.js"]);
  check(`${version} finds the package by its name`, drawn.hash === demo && drawn.isa === "wasm128", JSON.stringify(drawn));
  const line = command([program_of_host, ...words, join(installed, "cli.mjs"), "demo", "-o", "-", "--size", "160x120"]);
  check(`${version}: the command line draws`, line.status === 0 && line.stdout.length > 1000, line.stderr);
}

// The example worker, bundled as wrangler does, in workerd.
const miniflare = package_folder("miniflare"), esbuild = package_folder("esbuild");
if (!miniflare || !esbuild) console.log("skipped: there are no miniflare and esbuild in HALFLIT_NPM_TOOLS");
else {
  const { Miniflare } = createRequire(join(miniflare, "package.json"))(miniflare), { build } = createRequire(join(esbuild, "package.json"))(esbuild);
  const outdir = join(project, "deployed"), served = join(outdir, "worker.js");
  await build({ entryPoints: [join(project, "worker.js")], bundle: true, format: "esm", conditions: ["workerd", "worker", "browser"], loader: { ".wasm": "copy" }, outdir, logLevel: "error" });
  const modules = [{ type: "ESModule", path: served }, ...readdirSync(outdir).filter((name) => name.endsWith(".wasm")).map((name) => ({ type: "CompiledWasm", path: join(outdir, name) }))];
  const host = new Miniflare({ modules, modulesRoot: outdir, compatibilityDate: "2025-01-01" });
  const ask = (body, query) => host.dispatchFetch(`https://thumbnails.test/${query}`, { method: "POST", body });
  const answer = await ask(readFileSync(join(work, "knot.glb")), "?width=200&height=150&view=iso"), file = new Uint8Array(await answer.arrayBuffer());
  check("workerd: the example worker draws", answer.status === 200 && answer.headers.get("etag") === `"${thumbnail}"` && String(file.slice(1, 4)) === "80,78,71", `${answer.status} ${answer.headers.get("etag")}`);
  const wrong = await ask("no model", "");
  check("workerd: the example worker refuses", wrong.status === 400 && (await wrong.text()).split("\n").length === 2, wrong.status);
  await host.dispose();
}
console.log(`tarball ${bytes} bytes, start ${in_node.start_ms.toFixed(0)} ms, first picture ${in_node.first_ms.toFixed(0)} ms; worker: first answer ` +
  `${served.cold_ms.toFixed(0)} ms, next ${served.warm_ms.toFixed(0)} ms, ${served.memory_bytes >> 20} MiB`);

end();
