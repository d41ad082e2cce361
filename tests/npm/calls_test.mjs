// The calls of the npm package: options, pictures, scenes, environments, files and errors. Under Node.js, and by hosts_test.mjs under others.
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { check, end, native_hash, program, run, source, work, write_textured_model } from "../web/harness.mjs";
import { begin, command } from "./project.mjs";

const { halflit } = await begin();
const { HalflitError, init, load, memory, render } = halflit;
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
const altered_again = await render("demo", { size: "32x32" });
check("nor one whose pixels were sent to another thread", /found 0/.test((await refused((async () => sent.png())())).message));
check("its .jpg is a JPEG", Buffer.from(by_names.encode("jpg")).subarray(0, 3).toString("hex") === "ffd8ff");

const scenes = await Promise.all(Array.from({ length: 20 }, (_, i) => load(i % 2 ? knot : "demo", { size: "64x48" })));
const hashes = await Promise.all(scenes.map((scene) => scene.render({ azimuth: 30 })));
check("twenty scenes at once do not mix", new Set(hashes.map((picture) => picture.hash)).size === 2 && hashes[0].hash === hashes[18].hash && hashes[1].hash === hashes[19].hash);
const info = await scenes[1].info({ parts: true }), native_info = JSON.parse(run(["info", "knot.glb", "--json", "--parts", "--size", "64x48"]));
check("info() is that of the program", JSON.stringify({ ...info, scene: "" }) === JSON.stringify({ ...native_info, scene: "" }));
const texts = [["--parts"], ["--json"]].map((flags) => run(["info", "knot.glb", "--size", "64x48", ...flags]));
check("describe() is what info prints", (await scenes[1].describe({ parts: true })).replace("scene: model", "scene: knot.glb") === texts[0] && JSON.parse(await scenes[1].describe({ json: true })).measures.volume === JSON.parse(texts[1]).measures.volume);
scenes[1][Symbol.dispose ?? Symbol.for("Symbol.dispose")]();
check("a scene is freed at the end of its block", /freed/.test((await refused(scenes[1].render())).message));
scenes.forEach((scene) => scene.free());
check("a freed scene says so", /freed/.test((await refused(scenes[0].render())).message));
const before = await memory();
for (let i = 0; i < 100; ++i) await render(i % 3 ? knot : "demo", { size: "48x32" });
check("a hundred scenes leave no memory behind", (await memory()) <= 1.25 * before, `${before} bytes before, ${await memory()} after`);

// ---- the engine's calls -------------------------------------------------------------------------------------------------
// A report without what differs between two runs.
const without_times = (value) => Array.isArray(value) ? value.map(without_times) : value === null || typeof value !== "object" ? value :
  Object.fromEntries(Object.entries(value).filter(([key]) => !key.endsWith("ms") && key !== "peak_memory_bytes").map(([key, one]) => [key, without_times(one)]));
const same_report = (what, answer, ...words) => {
  const [ours, theirs] = [answer.report, JSON.parse(command([program, ...words], { cwd: work }).stdout)].map(without_times);
  const differing = Object.keys(theirs).filter((key) => JSON.stringify(ours[key]) !== JSON.stringify(theirs[key]));
  check(what, differing.length === 0, differing.map((key) => `${key}: ${JSON.stringify(ours[key])}, the program's ${JSON.stringify(theirs[key])}`).join("; "));
};
const facet = "solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet endsolid a";
writeFileSync(join(work, "facet.stl"), facet);
const model = await load(knot, { name: "knot.glb", files: { "facet.stl": facet } });
const looked = await model.look({ size: "96x64", view: ["front", "iso"] });
same_report("look() is that of the program", looked, "look", "knot.glb", "--size", "96x64", "--view", "front,iso", "--json", "-");
check("its sheet is a picture", looked.good && looked.notes.length > 0 && looked.picture.width > 96 && /^[0-9a-f]{16}$/.test(looked.picture.hash) && looked.picture.png().length > 100);
same_report("section() too", await model.section("x=50%", { size: "96x64" }), "look", "knot.glb", "--section", "x=50%", "--size", "96x64", "--json", "-");
same_report("certify() too", await model.certify({ size: "96x64" }), "look", "knot.glb", "--certify", "1", "--size", "96x64", "--json", "-");
same_report("explain() too", await model.explain([48, 32], { size: "96x64" }), "explain", "knot.glb", "--pixel", "48,32", "--size", "96x64", "--json");
same_report("compare() too", await model.compare("facet.stl", { size: "96x64" }), "compare", "knot.glb", "facet.stl", "--size", "96x64", "--json", "-");
const measured = await model.measure(), native_measures = JSON.parse(run(["info", "knot.glb", "--json"])).measures;
check("measure() has the program's measures", JSON.stringify(measured.report.measures) === JSON.stringify(native_measures));
for (const [what, work, words] of [["a misspelled argument", model.look({ veiw: "front" }), /unknown argument 'veiw'.*did you mean view/], ["an unknown call", model.call("lok"), /look/],
  ["a value", model.look({ size: "big" }), /size: expected/]]) {
  const error = await refused(work);
  check(`${what} is refused`, error.code === 2 && words.test(error.message), error.message);
}
model.free();

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

writeFileSync(join(work, "poor.gltf"), textured.toString().replace("textured.bin", "none.bin"));
const missing = command([program, join(work, "poor.gltf"), "-o", join(work, "poor.png")]);

// ---- errors -------------------------------------------------------------------------------------------------------------
for (const [what, attempt, code, words] of [
  ["an unknown option", render("demo", { sampels: 4 }), 2, /^unknown option sampels \(did you mean samples\?\)$/],
  ["an unknown option of a scene", load("demo").then((scene) => scene.render({ maxErorr: 1 })), 2, /did you mean maxError/],
  ["options that are no object", render("demo", "view=iso"), 2, /^options: expected an object/],
  ["an unknown flag", render("demo", { flags: "--sampels 4" }), 2, /did you mean --samples/],
  ["a value out of range", render("demo", { samples: 3 }), 2, /^samples: expected/],
  ["a value out of range by its flag's name", render("demo", { "--samples": 3 }), 2, /^--samples: expected/],
  ["a value out of range in flags", render("demo", { flags: "--samples 3" }), 2, /^--samples: expected/],
  ["a camera that is no point", render("demo", { cameraPosition: "here" }), 2, /^cameraPosition: expected/],
  ["a size of nothing", render("demo", { width: 0, height: 3 }), 2, /^width and height: expected/],
  ["half a size", render("demo", { width: 3 }), 2, /width and height/],
  ["a switch with a value", render("demo", { ground: "yes" }), 2, /ground/],
  ["an unknown scene", render("teapot"), 2, /^"teapot": expected the bytes of a model/],
  ["a model's path", load("models/duck.glb"), 2, /await readFile\("models\/duck.glb"\)/],
  ["a model without its buffer", render(textured, { files: { "photo.jpg": files["photo.jpg"] } }), missing.status, /textured\.bin.*no such file was given/],
  ["an environment that is not there", render("demo", { env: "none.hdr" }), 4, /none\.hdr/],
  ["bytes that are no model", render(new Uint8Array(99)), 3, /./],
  ["a cut-off model", render(knot.subarray(0, 200)), 3, /./],
  ["several views", render("demo", { view: "front,top" }), 2, /^view: /],
  ["a picture that is too large", render("demo", { size: "20000x20000" }), 5, /./],
]) {
  const error = await refused(attempt);
  check(`${what} is refused`, error instanceof HalflitError && error.code === code && words.test(error.message), `${error.code}: ${error.message}`);
}
for (const format of ["pfm", "hdr", "webp", "gif", "", undefined]) {
  const error = await refused((async () => altered_again.encode(format))());
  check(`encode(${JSON.stringify(format)}) says what it takes`, error instanceof HalflitError && error.code === 2 && /^encode: expected "png", "jpg", "bmp" or "tga", found/.test(error.message), error.message);
}
check("null is no options", (await render("demo", null)).width === 1280 && (await load("demo", null).then((scene) => scene.info(null))).drawn !== undefined);
check("and the next picture is drawn", (await render(knot, { width: 160, height: 120, flags })).hash === by_flags.hash);
const slow = await refused(render("demo", { size: "1500x1500", samples: 16, skyShadows: 64, timeout: 0.05 }));
check("a timeout ends a picture", slow.code === 5 && /time/.test(slow.message) && !/--timeout/.test(slow.message), slow.message);
const wide = Object.assign(await render("demo", { size: "32x32" }), { width: 12000, height: 12000, pixels: new Uint8ClampedArray(4 * 12000 * 12000) });
const file_of_wide = wide.png();  // 576 MB of pixels, of the module's 2 GB
check("a picture of 144 million pixels is encoded", file_of_wide.length > 1e5 && Buffer.from(file_of_wide).readUInt32BE(16) === 12000, file_of_wide.length);
Object.assign(wide, { width: 16400, height: 16400, pixels: new Uint8ClampedArray(4 * 16400 * 16400) });
const too_wide = await refused((async () => wide.png())());
check("one that does not fit is refused by its memory", too_wide instanceof HalflitError && too_wide.code === 5, too_wide.message);
const huge = await load("sphere:2000000", { size: "64x64" });
await huge.render();
const after_huge = await memory();
huge.free();
const kept = await memory();
await init({});
const anew = await memory();
check("init({}) gives the memory of a large model back", after_huge > 1 << 27 && kept === after_huge && anew <= 1 << 25, `${after_huge}, ${kept}, ${anew}`);
const full = await refused(render("sphere:60000000", { size: "64x64" }));
check("the end of memory is an error", full.code === 5 && full.message.includes("out of memory"), full.message);
check("and the next scene has a new module", (await render(knot, { width: 160, height: 120, flags })).hash === by_flags.hash && (await memory()) < 1 << 28, await memory());

end();
