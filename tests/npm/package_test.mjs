// The calls, types, command line and example of the npm package.
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { check, end, native_hash, program, run, source, work, write_textured_model } from "../web/harness.mjs";
import { begin, command, installed, must, project } from "./project.mjs";

const kMostBytes = 1.5e6;
const { bytes, halflit } = await begin();
const { HalflitError, init, load, memory, render } = halflit;
check("the tarball has at most 1.5 MB", bytes <= kMostBytes, bytes);
const licences = readdirSync(join(installed, "licences")).map((name) => name.replace(".txt", ""));
for (const name of ["draco", "expat", "libdeflate", "libjpeg-turbo", "libwebp", "meshoptimizer", "fmt", "xsimd", "expected", "stb", "nlohmann-json", "emscripten"])
  check(`it has the licence of ${name}`, licences.includes(name));
const terms = (name) => readFileSync(join(installed, "licences", `${name}.txt`), "utf8");
for (const [name, words] of [["draco", "Apache License"], ["draco", "END OF TERMS AND CONDITIONS"], ["libjpeg-turbo", "copyright (C) 1991-2020, Thomas G. Lane"],
  ["libwebp", "Additional IP Rights Grant"], ["expected", "Creative Commons Legal Code"], ["emscripten", "END OF TERMS AND CONDITIONS"]])
  check(`its licence of ${name} has "${words}"`, terms(name).includes(words));
check("its README names the Independent JPEG Group", readFileSync(join(installed, "README.md"), "utf8").includes("based in part on the work of the Independent JPEG Group."));
copyFileSync(join(source, "apps/examples/knot.glb"), join(work, "knot.glb"));
write_textured_model();
const knot = readFileSync(join(work, "knot.glb")), textured = readFileSync(join(work, "textured.gltf"));
const refused = (work) => work.then(() => ({ message: "nothing was refused" }), (error) => error);

// ---- options, pictures, scenes ------------------------------------------------------------------------------------------
const flags = ["--view", "iso", "--samples", "8", "--light", "directional:dir=-1,-2,-1", "--light", "point:pos=2,2,2", "--own-lobes", "off"];
const by_flags = await render(knot, { flags: `--size 160x120 ${flags.join(" ")}` });
const by_names = await render(knot, { width: 160, height: 120, view: "iso", samples: 8, light: [flags[5], flags[7]], ownLobes: false });
check("options by name are the flags", by_flags.hash === by_names.hash && by_flags.hash === native_hash([join(work, "knot.glb"), "--size", "160x120", ...flags]));
check("a picture has its size", by_names.width === 160 && by_names.height === 120 && by_names.pixels.length === 4 * 160 * 120 && by_names.pixels instanceof Uint8ClampedArray);
check("its report has the memory", by_names.report.peak_memory_bytes >= 1 << 24 && by_names.report.peak_memory_bytes === (await memory()), by_names.report.peak_memory_bytes);
for (const format of ["png", "bmp", "tga"]) {
  writeFileSync(join(work, `of_package.${format}`), by_names.encode(format));
  run(["knot.glb", "--size", "160x120", ...flags, "-o", `of_program.${format}`, "--quiet"]);
  check(`its .${format} is the program's`, command([program, "diff", join(work, `of_program.${format}`), join(work, `of_package.${format}`)]).status === 0);
}
const altered = await render("demo", { size: "32x32" });
for (const [what, pixels] of [["too few", altered.pixels.slice(4)], ["too many", new Uint8ClampedArray(4 * 33 * 32)], ["no", undefined]]) {
  altered.pixels = pixels;
  const error = await refused((async () => altered.png())());
  check(`a picture with ${what} pixels is not encoded`, error instanceof HalflitError && error.code === 2 && /pixels: expected 4096 bytes/.test(error.message), error.message);
}
const sent = await render("demo", { size: "32x32" });
structuredClone(sent.pixels, { transfer: [sent.pixels.buffer] });
check("nor one whose pixels were sent to another thread", /found 0/.test((await refused((async () => sent.png())())).message));
check("its .jpg is a JPEG", Buffer.from(by_names.encode("jpg")).subarray(0, 3).toString("hex") === "ffd8ff");

const scenes = await Promise.all(Array.from({ length: 20 }, (_, i) => load(i % 2 ? knot : "demo", { size: "64x48" })));
const hashes = await Promise.all(scenes.map((scene) => scene.render({ azimuth: 30 })));
check("twenty scenes at once do not mix", new Set(hashes.map((picture) => picture.hash)).size === 2 && hashes[0].hash === hashes[18].hash && hashes[1].hash === hashes[19].hash);
const info = await scenes[1].info({ parts: true }), native_info = JSON.parse(run(["info", "knot.glb", "--json", "--parts", "--size", "64x48"]));
check("info() is that of the program", JSON.stringify({ ...info, scene: "" }) === JSON.stringify({ ...native_info, scene: "" }));
scenes.forEach((scene) => scene.free());
check("a freed scene says so", /freed/.test((await refused(scenes[0].render())).message));
const before = await memory();
for (let i = 0; i < 300; ++i) await render(i % 3 ? knot : "demo", { size: "48x32" });
check("three hundred scenes leave no memory behind", (await memory()) <= 1.25 * before, `${before} bytes before, ${await memory()} after`);

// ---- environments -------------------------------------------------------------------------------------------------------
// A .pfm file of one colour.
function sky(red) {
  const header = Buffer.from("PF\n512 256\n-1.0\n"), floats = new Float32Array(3 * 512 * 256).map((_, i) => (i % 3 ? 0.25 : red));
  return Buffer.concat([header, Buffer.from(floats.buffer)]);
}
await init({ simd: true });  // a module whose memory has no room from before
const lit = await load(knot, { size: "32x24" }), skies = Array.from({ length: 16 }, (_, i) => sky(i / 8));
const of_skies = [];
let after_four = 0;
for (const [i, env] of skies.entries()) {
  of_skies.push((await lit.render({ env })).hash);
  if (i === 3) after_four = await memory();
}
check("twelve skies more take less memory than eight of them have", (await memory()) - after_four < 8 * skies[0].length, `${after_four} bytes, then ${await memory()}`);
check("sixteen skies give as many pictures", new Set(of_skies).size === 16);
check("a sky of before is that of before", (await lit.render({ env: skies[2] })).hash === of_skies[2] && (await lit.render({ env: skies[2] })).hash === of_skies[2]);
lit.free();
const too_large = await render(knot, { size: "32x24", maxGeometryBytes: 10 }).catch((error) => error);
check("a limit on the memory of vertices is kept", too_large.code === 5, `${too_large.code} ${too_large.message}`);

// ---- files beside a model -----------------------------------------------------------------------------------------------
const size = { width: 120, height: 90 }, names = ["textured.bin", "photo.jpg", "ball.png"];
const native = native_hash([join(work, "textured.gltf"), "--size", "120x90"]);
const files = Object.fromEntries(names.map((name) => [name, readFileSync(join(work, name))]));
check("files by a map", (await render(textured, { ...size, files })).hash === native);
check("files by a Map, in folders", (await render(textured, { ...size, name: "a/b.gltf", files: new Map(Object.entries(files).map(([name, file]) => [`a/${name}`, file])) })).hash === native);
const asked = [];
const late = await render(textured, { ...size, files: async (name) => { asked.push(name); await new Promise((done) => setTimeout(done, 5)); return files[name]; } });
check("files by a function", late.hash === native && JSON.stringify(asked.sort()) === JSON.stringify([...names].sort()), asked);
const without = await render(textured, { ...size, files: (name) => (name === "photo.jpg" ? null : files[name]) });
check("a texture that is not there is warned of", without.hash !== native && without.report.warnings.some((line) => line.includes("photo.jpg")), without.report.warnings);
const slowly = await load(textured, { ...size, files: (name) => (name === "photo.jpg" ? null : files[name]) });
const together = await Promise.all([0, 1, 0].map((i) => slowly.render({ env: skies[i], edges: i ? "feature" : "none" })));
const apart = await Promise.all([0, 1].map((i) => render(textured, { ...size, files: (name) => (name === "photo.jpg" ? null : files[name]), env: skies[i], edges: i ? "feature" : "none" })));
check("pictures of a scene at once have their own skies", together.every((picture, i) => picture.hash === apart[i % 2].hash));
slowly.free();
const failing = await refused(render(textured, { ...size, files: () => { throw new Error("no disk"); } }));
check("an error of that function is passed on", failing.message === "no disk");

// ---- errors -------------------------------------------------------------------------------------------------------------
for (const [what, attempt, code, words] of [
  ["an unknown option", render("demo", { sampels: 4 }), 2, /unknown option sampels/],
  ["an unknown flag", render("demo", { flags: "--sampels 4" }), 2, /did you mean --samples/],
  ["a value out of range", render("demo", { samples: 3 }), 2, /--samples/],
  ["half a size", render("demo", { width: 3 }), 2, /width and height/],
  ["a switch with a value", render("demo", { ground: "yes" }), 2, /ground/],
  ["an unknown scene", render("teapot"), 4, /teapot/],
  ["bytes that are no model", render(new Uint8Array(99)), 3, /./],
  ["a cut-off model", render(knot.subarray(0, 200)), 3, /./],
  ["several views", render("demo", { view: "front,top" }), 2, /--view/],
  ["a picture that is too large", render("demo", { size: "20000x20000" }), 5, /./],
]) {
  const error = await refused(attempt);
  check(`${what} is refused`, error instanceof HalflitError && error.code === code && words.test(error.message), `${error.code}: ${error.message}`);
}
check("and the next picture is drawn", (await render(knot, { width: 160, height: 120, flags })).hash === by_flags.hash);
const slow = await refused(render("demo", { size: "1500x1500", samples: 16, skyShadows: 64, timeout: 0.05 }));
check("a timeout ends a picture", slow.code === 5 && /time/.test(slow.message), slow.message);
const full = await refused(render("sphere:40000000", { size: "64x64" }));
check("the end of memory is an error", full.code === 5 && full.message.includes("out of memory"), full.message);
check("and the next scene has a new module", (await render(knot, { width: 160, height: 120, flags })).hash === by_flags.hash && (await memory()) < 1 << 28, await memory());

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

copyFileSync(join(installed, "examples/worker.js"), join(project, "worker.js"));
writeFileSync(join(project, "served.js"), `import worker from "./worker.js"; import { readFileSync } from "node:fs"; import { memory } from "halflit";
const ask = (body, query = "") => worker.fetch(new Request("https://thumbnails.test/" + query, { method: "POST", body }));
const knot = readFileSync(${JSON.stringify(join(work, "knot.glb"))}), start = performance.now();
const first = await ask(knot, "?width=200&height=150&view=iso"), png = new Uint8Array(await first.arrayBuffer()), cold_ms = performance.now() - start;
const again = performance.now();
await ask(knot, "?width=200&height=150&view=iso");
const warm_ms = performance.now() - again, statuses = [(await ask("no model")).status, (await ask(knot, "?view=sideways")).status, (await worker.fetch(new Request("https://thumbnails.test/"))).status];
let read = 0;
const endless = new ReadableStream({ pull(stream) { read += 1 << 20; stream.enqueue(new Uint8Array(1 << 20)); if (read >= 80 << 20) stream.close(); } });
const large = (await worker.fetch(new Request("https://thumbnails.test/", { method: "POST", body: endless, duplex: "half" }))).status;
const announced = new Request("https://thumbnails.test/", { method: "POST", body: knot, headers: { "content-length": String(33 << 20) } });
const limits = { large, read, announced: (await worker.fetch(announced)).status, untouched: !announced.bodyUsed };
console.log(JSON.stringify({ status: first.status, type: first.headers.get("content-type"), tag: first.headers.get("etag"), png: [...png.slice(1, 4)], statuses, limits, cold_ms, warm_ms, memory_bytes: await memory() }));\n`);
const served = told(["node", "--conditions=workerd", "--import", "./wasm.mjs", "served.js"]);
const thumbnail = native_hash([join(work, "knot.glb"), "--size", "200x150", "--view", "iso", "--samples", "4"]);
check("the example worker draws", served.status === 200 && served.type === "image/png" && served.tag === `"${thumbnail}"` && String(served.png) === "80,78,71", JSON.stringify(served));
check("the example worker refuses", String(served.statuses) === "400,400,405", served.statuses);
check("it reads no more of a body than its limit", served.limits.large === 413 && served.limits.read <= 36 << 20, JSON.stringify(served.limits));
check("and nothing of one that says it is larger", served.limits.announced === 413 && served.limits.untouched, JSON.stringify(served.limits));
check("the example worker takes at most 64 MB", served.memory_bytes <= 64 << 20, served.memory_bytes);

// ---- the command line ---------------------------------------------------------------------------------------------------
const cli = (...words) => command(["npx", "--no-install", "halflit", ...words], { cwd: project });
mkdirSync(join(project, "models"));
for (const name of ["textured.gltf", ...names]) copyFileSync(join(work, name), join(project, "models", name));
const drawn = cli("models/textured.gltf", "out.png", "--size", "120x90", "--view=iso", "--report", "report.json");
check("npx halflit draws", drawn.status === 0 && existsSync(join(project, "out.png")), drawn.stderr);
const report = JSON.parse(readFileSync(join(project, "report.json"), "utf8"));
check("its picture is the program's", report.pixel_hash === native_hash([join(work, "textured.gltf"), "--size", "120x90", "--view", "iso"]));
writeFileSync(join(project, "secret.jpg"), files["photo.jpg"]);
writeFileSync(join(project, "models/thief.gltf"), textured.toString().replace("photo.jpg", "../secret.jpg"));
check("a model reads nothing outside of its folder", /secret\.jpg/.test(cli("models/thief.gltf", "-o", "thief.png", "--size", "32x32").stderr));
for (const [words, code] of [[["none.glb"], 4], [["no/folder/none.glb", "x.png"], 4], [["demo", "no/folder/x.png", "--size", "16x16"], 4], [["demo", "models", "--size", "16x16"], 2],
  [["demo", "x.png", "--size", "16x16", "--report", "no/folder/x.json"], 4], [["demo", "x.png", "--env", "no/sky.hdr"], 4], [["demo", "x.png", "--sampels", "3"], 2], [["demo", "x.gif"], 2], [["models/photo.jpg", "x.png"], 3], [["a", "b", "c"], 2]]) {
  const { status, stderr } = cli(...words);
  check(`halflit ${words.join(" ")} ends with ${code} and one line`, status === code && /^halflit: error: [^\n]+\n$/.test(stderr), `${status}: ${stderr.trim()}`);
}
check("--help lists the flags", /--max-error CODES/.test(cli("--help").stdout));

// ---- types --------------------------------------------------------------------------------------------------------------
writeFileSync(join(project, "typed.ts"), `import { HalflitError, init, load, render, type Picture, type RenderOptions } from "halflit";
const options: RenderOptions = { width: 320, height: 240, view: "iso", samples: 8, shadows: "hard", ownLobes: false, light: ["a", "b"], cameraPosition: [1, 2, 3], ground: true, maxError: 0.5 };
const picture: Picture = await render(new Uint8Array(1), { ...options, files: async (name) => (await fetch(name)).arrayBuffer() });
const pixels: Uint8ClampedArray = picture.pixels, file: Uint8Array = picture.png();
const scene = await load("sphere:100", { files: { "a.bin": new ArrayBuffer(3) } });
const triangles: number = (await scene.info({ parts: true })).drawn.triangles_drawn;
// @ts-expect-error: no such option
await scene.render({ sampels: 3 });
// @ts-expect-error: no such shadows
await scene.render({ shadows: "purple" });
scene.free();
if (new HalflitError("").code === 5) await init({ simd: false });
console.log(pixels, file, triangles);\n`);
const typescript = command(["npm", "install", "--no-save", "--no-audit", "--no-fund", "--fetch-timeout=30000", "typescript@5"]);
if (typescript.status !== 0) console.log("skipped: there is no TypeScript to check the types with");
else {
  const types = command(["npx", "--no-install", "tsc", "--noEmit", "--strict", "--target", "es2022", "--module", "nodenext", "--lib", "es2022,dom", "typed.ts"]);
  check("the types are right", types.status === 0, types.stdout);
}
console.log(`tarball ${bytes} bytes, start ${in_node.start_ms.toFixed(0)} ms, first picture ${in_node.first_ms.toFixed(0)} ms; worker: first answer ` +
  `${served.cold_ms.toFixed(0)} ms, next ${served.warm_ms.toFixed(0)} ms, ${served.memory_bytes >> 20} MiB`);
end();
