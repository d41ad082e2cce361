// Shared by the tests of the page: the program to compare with, models, and the page's state. They are called as
//   node TEST.mjs PROGRAM PAGE SOURCE_FOLDER WORK_FOLDER
import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { zip_of } from "../npm/zip.mjs";
import { Page, close_browser, find_chromium } from "./chromium.mjs";

const [program, page_file, source, work] = process.argv.slice(2).map((path) => resolve(path));
const kSkipped = 77;
const failures = [];
export { program, source, work };
export const address = pathToFileURL(page_file).href;

export function check(fact, holds, found = "") {
  const line = `${holds ? "ok" : "FAILED"}: ${fact}${found === "" ? "" : `: ${found}`}`;
  if (!holds) failures.push(line);
  console.log(line);
}

function skip_without(what, there) {
  if (there) return;
  console.log(`skipped: ${what}`);
  process.exit(kSkipped);
}

export function run(words) {
  const result = spawnSync(program, words, { cwd: work, encoding: "utf8", maxBuffer: 1 << 26 });
  if (result.status !== 0) throw new Error(`halflit ${words.join(" ")}: ${result.stderr}`);
  return result.stdout;
}

// Ends the test as skipped, or empties its folder. Returns the page's size.
export function begin() {
  skip_without("there is no Chromium", find_chromium());
  const size = statSync(page_file, { throwIfNoEntry: false })?.size;
  skip_without("the page was not built, as there is no Emscripten", size);
  rmSync(work, { recursive: true, force: true });
  mkdirSync(work, { recursive: true });
  return size;
}

// Failures again, as a log that is cut short has its end.
export async function end() {
  await close_browser();
  console.log(failures.length === 0 ? "all as expected" : `${failures.length} failed\n${failures.join("\n")}`);
  process.exit(failures.length === 0 ? 0 : 1);
}

// The hash of the picture that the program draws by a command line without output.
export const native_hash = (words) => JSON.parse(run([...words, "-o", "native.png", "--report", "-", "--quiet"])).pixel_hash;

// A .gltf with its .bin: a square of two sides, 2 high, once for each material. `more` is added to the file.
export function write_squares(name, { nodes, materials, ...more }) {
  const floats = [], indices = [0, 1, 2, 0, 2, 3], positions = [[-1, 0, 0], [1, 0, 0], [1, 2, 0], [-1, 2, 0]], uvs = [[0, 1], [1, 1], [1, 0], [0, 0]];
  positions.forEach((p) => floats.push(...p));
  positions.forEach(() => floats.push(0, 0, 1));
  uvs.forEach((uv) => floats.push(...uv));
  const data = Buffer.concat([Buffer.from(new Float32Array(floats).buffer), Buffer.from(new Uint16Array(indices).buffer)]);
  writeFileSync(join(work, `${name}.bin`), data);
  const view = (byteOffset, byteLength) => ({ buffer: 0, byteOffset, byteLength });
  const primitive = (material) => ({ attributes: { POSITION: 0, NORMAL: 1, TEXCOORD_0: 2 }, indices: 3, material });
  writeFileSync(join(work, `${name}.gltf`), JSON.stringify({
    asset: { version: "2.0" }, scene: 0, scenes: [{ nodes: nodes.map((_, i) => i) }], nodes,
    meshes: materials.map((_, i) => ({ primitives: [primitive(i)] })), materials,
    buffers: [{ uri: `${name}.bin`, byteLength: data.length }],
    bufferViews: [view(0, 48), view(48, 48), view(96, 32), view(128, 12)],
    accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: "VEC3", min: [-1, 0, 0], max: [1, 2, 0] },
      { bufferView: 1, componentType: 5126, count: 4, type: "VEC3" }, { bufferView: 2, componentType: 5126, count: 4, type: "VEC2" },
      { bufferView: 3, componentType: 5123, count: 6, type: "SCALAR" }],
    ...more,
  }));
}

// A pedestal with pictures of all kinds: a JPEG, a PNG of 8 bits with alpha, in files of their own.
export function write_textured_model() {
  run(["demo", "--size", "96x80", "-o", "photo.jpg", "--quiet"]);
  run(["sphere:500", "--size", "64x64", "--background", "transparent", "-o", "ball.png", "--quiet"]);
  const material = (index, alphaMode) => ({ doubleSided: true, alphaMode, pbrMetallicRoughness: { baseColorTexture: { index }, metallicFactor: 0.2, roughnessFactor: 0.5 } });
  write_squares("textured", {
    nodes: [{ mesh: 0 }, { mesh: 1, translation: [0.4, 0, 0.7], rotation: [0, 0.2588, 0, 0.9659] }], materials: [material(0, "OPAQUE"), material(1, "BLEND")],
    textures: [{ source: 0 }, { source: 1 }], images: [{ uri: "photo.jpg" }, { uri: "ball.png" }],
  });
}

// Points in a spiral.
export function write_points() {
  const count = 60, header = `ply\nformat ascii 1.0\nelement vertex ${count}\nproperty float x\nproperty float y\nproperty float z\nend_header\n`;
  const point = (i) => [Math.cos(i / 5), i / 20, Math.sin(i / 5)].map((x) => x.toFixed(4)).join(" ");
  writeFileSync(join(work, "dots.ply"), header + Array.from({ length: count }, (_, i) => `${point(i)}\n`).join(""));
}

// A tetrahedron with a colour for each corner of a face.
export function write_3mf() {
  const model = `<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
    <basematerials id="1"><base name="a" displaycolor="#E04020"/><base name="b" displaycolor="#2060E0"/></basematerials>
    <object id="2" type="model" pid="1" pindex="0"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="10" y="0" z="0"/><vertex x="0" y="10" z="0"/>
    <vertex x="0" y="0" z="10"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3" p1="1"/>
    <triangle v1="1" v2="2" v3="3"/><triangle v1="2" v2="0" v3="3" p1="1"/></triangles></mesh></object></resources><build><item objectid="2"/></build></model>`;
  const relations = `<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r"
    Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>`;
  writeFileSync(join(work, "part.3mf"), zip_of({ "_rels/.rels": relations, "3D/3dmodel.model": model }));
}

// A WebP picture on a card.
export function write_webp_model() {
  run(["demo", "--size", "96x80", "-o", "photo.webp", "--quiet"]);
  write_squares("card", {
    nodes: [{ mesh: 0 }], materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 0 } }],
    extensionsUsed: ["EXT_texture_webp"], textures: [{ extensions: { EXT_texture_webp: { source: 0 } } }], images: [{ uri: "photo.webp", mimeType: "image/webp" }],
  });
}

export const idle = "window.halflit && halflit.current().shown && halflit.current().idle";
export const shown_hash = (page) => page.value("halflit.current().shown.report.pixel_hash");
export const text_of = (page, id) => page.value(`document.getElementById("${id}").hidden ? "" : document.getElementById("${id}").textContent`);
export const command_of = (page) => page.value("document.getElementById('command').value");
export const words_of = (command) => command.replace(/ -o .*/, "").match(/'[^']*'|\S+/g).slice(1).map((word) => word.replace(/^'|'$/g, ""));

// Opens files of the test's folder; the first one is the model.
export async function open_model(page, files) {
  await page.choose_files("#files", files.map((file) => join(work, file)));
  await page.until(`halflit.current().state.scene === '${files[0]}' && halflit.current().idle`);
}

// A page of its own for tests that follow each other.
export async function with_page(options, hash, ...tests) {
  const page = await Page.open(address + hash, options);
  for (const test of tests) await test(page).catch((error) => check(`${test.name} runs: ${error.message}`, false));
  await page.close();
}

// Answers of an engine of its own, made in the page, for one task after the other: [kind, task].
export async function answers_of(page, module, names, tasks) {
  const files = names.map((name) => ({ name, base64: readFileSync(join(work, name)).toString("base64") }));
  return page.value(`(async () => {
    const engine = new halflit.Engine(${JSON.stringify(module)});
    const files = ${JSON.stringify(files)}.map(({ name, base64 }) => ({ name, file: Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)).buffer }));
    await engine.started;
    await engine.ask("files", { files });
    const found = [];
    for (const [kind, task] of ${JSON.stringify(tasks)}) {
      const { pixels, ...answer } = await engine.ask(kind, task);
      found.push(answer);
    }
    engine.stop();
    return found;
  })()`);
}
