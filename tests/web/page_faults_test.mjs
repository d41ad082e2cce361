// The page where a browser refuses, a link is hostile, files come at a bad time, or a model is odd.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { deflateRawSync } from "node:zlib";
import { answers_of, begin, check, command_of, end, idle, native_hash, open_model, shown_hash, text_of, with_page, words_of, work, write_squares } from "./harness.mjs";

const view_of = async (page) => JSON.parse(await page.value("JSON.stringify(view_of(halflit.current().state))"));
const report_of = async (page) => JSON.parse(await page.value("JSON.stringify(halflit.current().shown.report)"));
const away = (view) => Math.hypot(...view.position.map((x, i) => x - view.target[i]));

// The library is unpacked when the test calls go().
const kHeld = `{
  const unpack = Response.prototype.arrayBuffer, gate = new Promise((resolve) => (window.go = resolve));
  Response.prototype.arrayBuffer = async function () { await gate; return unpack.call(this); };
}`;

async function loading(page) {
  await page.until("window.halflit && window.go");
  const box = async () => JSON.parse(await page.value("JSON.stringify(document.getElementById('frame').getBoundingClientRect())"));
  const before = await box();
  check("loading: a line says so", /loading/i.test(await text_of(page, "loading")));
  check("loading: the frame has the picture's shape", Math.abs(before.width / before.height - 16 / 9) < 0.01, `${before.width} x ${before.height}`);
  await page.screenshot(join(work, `loading-${before.width}.png`));
  await page.value("document.getElementById('download').click()");
  await page.value("window.go()");
  await page.until(idle);
  const after = await box();
  check("loading: the picture comes into the same frame", after.height === before.height && (await text_of(page, "loading")) === "", `${after.width} x ${after.height}`);
  check("loading: a click on Download before the first picture does nothing", page.faults.length === 0, page.faults.join(", "));
}

async function loading_of_a_link(page) {
  await page.until("window.halflit && window.go");
  const shape = await page.value("(() => { const box = document.getElementById('frame').getBoundingClientRect(); return box.width / box.height; })()");
  check("loading: the frame has the shape of the link's size", Math.abs(shape - 1) < 0.01, shape);
}

// Everything that a visitor can do before the library has started.
async function haste(page) {
  await page.until("window.halflit && window.go");
  await page.value("(() => { const code = document.getElementById('module'); code.value = 'scalar'; code.dispatchEvent(new Event('change')); dispatchEvent(new Event('resize')); })()");
  await page.choose_files("#files", ["square.gltf", "square.bin"].map((name) => join(work, name)));
  await page.until("halflit.current().state.scene === 'square.gltf'");
  await page.value("window.go()");
  await page.until(idle);
  check("haste: files that were opened before the library had started are drawn", (await text_of(page, "error")) === "", await text_of(page, "error"));
  check("haste: so is the choice of the code", (await report_of(page)).isa === "scalar");
  check("haste: the page has no error", page.faults.length === 0, page.faults.join(", "));
}

// Firefox and Safari throw when history is written too often.
const kNoHistory = "History.prototype.replaceState = () => { throw new DOMException('too many calls', 'SecurityError'); };";
async function no_history(page) {
  await page.until(idle);
  const before = await shown_hash(page);
  await page.drag({ x: 400, y: 300 }, { x: 470, y: 280 });
  await page.until(idle);
  check("no history: a drag turns the view", (await shown_hash(page)) !== before);
  check("no history: the page has no error", page.faults.length === 0, page.faults.join(", "));
}

const kCountedHistory = "{ const write = History.prototype.replaceState; window.writes = 0; History.prototype.replaceState = function (...all) { ++window.writes; write.apply(this, all); }; }";
async function counted_history(page) {
  await page.until(idle);
  const before = await page.value("window.writes");
  await page.drag({ x: 400, y: 300 }, { x: 500, y: 280 }, { steps: 40 });
  await page.value("(() => { const input = document.querySelector('[name=\"rotate\"]'); for (let i = 0; i < 40; ++i) { input.value = 5 * (i % 9); input.dispatchEvent(new Event('input', { bubbles: true })); } })()");
  await page.until(idle);
  const writes = (await page.value("window.writes")) - before;
  check("history: 80 motions write the link a few times at most", writes >= 1 && writes <= 8, writes);
  check("history: the link has the last state", (await page.value("location.hash")).includes("rotate=15"), await page.value("location.hash"));
}

async function no_unpacking(page) {
  await page.until("window.halflit && !document.getElementById('error').hidden");
  check("no unpacking: the page says why it draws nothing", /DecompressionStream/.test(await text_of(page, "error")), await text_of(page, "error"));
  check("no unpacking: it does not seem to load", (await text_of(page, "loading")) === "" && (await page.value("halflit.current().idle || halflit.current().shown === null")));
}

async function failing_frame(page) {
  await page.until(idle);
  const set_samples = (count) => page.value(`(() => { const input = document.querySelector('[name="samples"]'); input.value = "${count}"; input.dispatchEvent(new Event("input", { bubbles: true })); })()`);
  await page.value("(() => { const put = CanvasRenderingContext2D.prototype.putImageData; CanvasRenderingContext2D.prototype.putImageData = function () { CanvasRenderingContext2D.prototype.putImageData = put; throw new Error('no canvas'); }; })()");
  await set_samples(1);
  await page.until("!document.getElementById('error').hidden");
  check("failing frame: the page says so", /no canvas/.test(await text_of(page, "error")), await text_of(page, "error"));
  await set_samples(8);
  await page.until("document.getElementById('error').hidden && halflit.current().idle");
  check("failing frame: the next one is drawn", (await shown_hash(page)) === native_hash(["demo", "--size", "640x360", "--samples", "8"]));

  await page.value("(() => { window.Made = window.Worker; window.Worker = class { constructor() { throw new Error('no worker'); } }; })()");
  await page.value("document.getElementById('toggle_heat').click()");
  await page.until("!document.getElementById('error').hidden");
  check("failing comparison: the page says so, and is ready", /no worker/.test(await text_of(page, "error")) && (await page.value(idle)), await text_of(page, "error"));
  await page.value("window.Worker = window.Made");
}

// An engine that ends, as at the limit of its memory.
const kEnding = `{
  window.terminated = 0;
  const { terminate, postMessage } = Worker.prototype;
  Worker.prototype.terminate = function () { ++window.terminated; terminate.call(this); };
  Worker.prototype.postMessage = function (task, ...more) {
    if (!window.end_next || task.kind !== "draw") return postMessage.call(this, task, ...more);
    window.end_next = false;
    this.onmessage({ data: { id: task.id, error: "out of memory", ended: true } });
  };
}`;
async function ending_engine(page) {
  await page.until(idle);
  await page.value("window.end_next = true");
  await page.value("document.getElementById('reset').click()");
  await page.until("!document.getElementById('error').hidden");
  check("ending engine: the page says so", (await text_of(page, "error")) === "out of memory");
  check("ending engine: its worker is terminated", (await page.value("window.terminated")) === 1);
  await page.value("document.getElementById('reset').click()");
  await page.until("document.getElementById('error').hidden && halflit.current().idle");
  check("ending engine: another one draws the next picture", (await shown_hash(page)) === native_hash(["demo", "--size", "640x360"]));
}

async function hostile_link(page) {
  await page.until(idle);
  check("hostile link: it is the usual picture", (await shown_hash(page)) === native_hash(["demo", "--size", "640x360"]), await command_of(page));
  check("hostile link: no error", page.faults.length === 0 && (await text_of(page, "error")) === "", page.faults.join(", "));
}

async function line_break_in_link(page) {
  await page.until(idle);
  const command = await command_of(page);
  check("a link with a line break: the command line gives the picture", native_hash(words_of(command)) === (await shown_hash(page)), command);
}

async function option_as_scene(page) {
  await page.until("window.halflit && !document.getElementById('error').hidden");
  const command = await command_of(page);
  check("a link with an option as its scene: the command line has it as a file", command.startsWith("halflit ./--report=x --size") && command.endsWith(" -o ./--report=x.png"), command);
}

async function far_model(page) {
  await page.until(idle);
  await open_model(page, ["far.gltf", "far.bin"]);
  const before = (await report_of(page)).view;
  await page.drag({ x: 400, y: 300 }, { x: 440, y: 290 });
  await page.until(idle);
  const turned = await view_of(page), command = await command_of(page);
  check("far model: a turn keeps the distance", Math.abs(away(turned) / away(before) - 1) < 1e-3, `${away(before)}, then ${away(turned)}`);
  check("far model: a turn keeps the target", Math.hypot(...turned.target.map((x, i) => x - before.target[i])) < 1e-3 * away(before), turned.target);
  check("far model: the command line gives the picture", native_hash(words_of(command)) === (await shown_hash(page)), command);
  await page.wheel({ x: 400, y: 300 }, -200, 60);
  await page.until(idle);
  const close = await view_of(page);
  check("far model: zooming in ends before the target", away(close) > 5e-4 * before.radius, away(close));
  await page.drag({ x: 400, y: 300 }, { x: 440, y: 290 });
  await page.until(idle);
  check("far model: and the view can be turned there", away(await view_of(page)) > 5e-4 * before.radius, away(await view_of(page)));
}

async function early_drag(page) {
  await page.until(idle);
  await page.value("(() => { const scene = document.querySelector('[name=\"scene\"]'); scene.value = 'lights:16'; scene.dispatchEvent(new Event('input', { bubbles: true })); document.getElementById('picture').dispatchEvent(new WheelEvent('wheel', { deltaY: 100 })); })()");
  await page.until(idle);
  const command = await command_of(page);
  check("early drag: a scene that is not drawn yet does not get the last one's view", !command.includes("--camera-position"), command);
}

// The mean difference in codes that a motion makes which is too small to see.
async function jump(page) {
  await page.value("window.last = new Uint8Array(halflit.current().shown.pixels); document.getElementById('picture').dispatchEvent(new WheelEvent('wheel', { deltaY: 1e-4 }))");
  await page.until(idle);
  return page.value("(() => { const now = new Uint8Array(halflit.current().shown.pixels); return now.reduce((sum, x, i) => sum + Math.abs(x - window.last[i]), 0) / now.length; })()");
}

async function first_motion(page) {
  await page.until(idle);
  const files = (name) => [`${name}.gltf`, `${name}.bin`], size = "document.querySelector('[name=\"size\"]')";
  for (const [shape, name] of [["640x360", ""], ["360x640", ""], ["640x360", "flat"], ["360x640", "flat"], ["640x360", "wide"], ["640x360", "far"]]) {
    if (name) await open_model(page, files(name));
    await page.value("document.getElementById('reset_view').click()");
    await page.value(`${size}.value = "${shape}"; ${size}.dispatchEvent(new Event("input", { bubbles: true }))`);
    await page.until(idle);
    const codes = await jump(page);
    check(`first motion: the view of ${name || "the demo"} at ${shape} does not jump`, (await view_of(page)) !== null && codes < 0.1, codes);
  }
}

// A chunk ahead of the header, as Apple's tools write it. Its data and checksum stand where a header has the size. stb_image checks none.
function write_odd_png() {
  const chunk = (name, data, sum = 0) => {
    const out = Buffer.alloc(12 + data.length);
    out.writeUInt32BE(data.length, 0);
    out.write(name, 4, "latin1");
    data.copy(out, 8);
    out.writeUInt32BE(sum, 8 + data.length);
    return out;
  };
  const number = (x) => Buffer.from([x >>> 24, (x >> 16) & 255, (x >> 8) & 255, x & 255]);
  const header = Buffer.concat([number(1), number(1), Buffer.from([8, 6, 0, 0, 0])]);
  writeFileSync(join(work, "odd.png"), Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk("CgBI", number(1024), 1024), chunk("IHDR", header),
    chunk("IDAT", deflateRawSync(Buffer.from([0, 255, 0, 0, 255]))), chunk("IEND", Buffer.alloc(0))]));
}

async function engines(page) {
  await page.until(idle);
  const draw = (scene, ...flags) => ["draw", { scene, flags }];
  const [odd] = await answers_of(page, "simd", ["odd.gltf", "odd.bin", "odd.png"], [draw("odd.gltf", "--size", "64x64", "--strict")]);
  check("a PNG that does not begin with its header is refused by --strict", /PNG/.test(odd.error || ""), odd.error || "drawn");

  const sphere = (...flags) => draw("sphere:4000", "--samples", "1", ...flags);
  const drawn = await answers_of(page, "simd", [], [sphere("--size", "64x64"), sphere("--size", "80x60"),
    sphere("--size", "80x60", "--shadow-size", "256"), sphere("--size", "80x60", "--up", "z"), sphere("--size", "64x64", "--up", "z")]);
  const loads = drawn.map((answer) => answer.report.loads);
  check("another size of picture or shadow map does not load the scene anew, and another axis does", String(loads) === "1,1,1,2,2", loads);
}

async function controls(page) {
  await page.until(idle);
  const set = (name, value) => page.value(`(() => { const input = document.querySelector('[name="${name}"]'); input.${typeof value === "boolean" ? "checked" : "value"} = ${JSON.stringify(value)}; input.dispatchEvent(new Event("input", { bubbles: true })); })()`);
  const exposure = async () => [await page.value("form.exposure.value"), await page.value("form.exposure.parentElement.querySelector('output').textContent")];
  const first = await shown_hash(page);
  check("exposure: the slider stands at what is chosen", String(await exposure()) === "0,auto", await exposure());
  await set("exposure", "2");
  await page.until(idle);
  check("exposure: a moved slider counts", (await command_of(page)).includes("--exposure auto+2 ") && String(await exposure()) === "2,auto+2" && (await shown_hash(page)) !== first);
  await page.value("document.getElementById('reset').click()");
  await page.until(idle);
  check("exposure: Reset all takes the slider back", String(await exposure()) === "0,auto" && (await shown_hash(page)) === first, await exposure());

  for (const { name } of JSON.parse(await page.value("JSON.stringify(kLibrary.lobes)"))) {
    await set("lobe", name);
    await page.until(idle);
    const drawn = await shown_hash(page), command = words_of(await command_of(page)), lobe = JSON.parse(await page.value("JSON.stringify(lobe_of(halflit.current().state))"));
    const given = ["demo", "--size", "640x360", "--wrap", String(lobe.wrap), "--power", String(lobe.power), ...(lobe.normalize ? ["--normalize"] : []), "--own-lobes", "off"];
    check(`lobe ${name}: the sliders' numbers give the picture of the name`, native_hash(command) === drawn && native_hash(given) === drawn, given.join(" "));
    const shown = [await page.value("form.normalize.checked"), await page.value("form.normalize.disabled")];
    check(`lobe ${name}: the norm is shown as the name has it`, shown[0] === (name === "mcauley") && shown[1] === (name === "mcauley"), shown);
  }
}

begin();
const matt = [{ doubleSided: true, pbrMetallicRoughness: { baseColorFactor: [0.7, 0.5, 0.3, 1], metallicFactor: 0 } }];
write_squares("square", { nodes: [{ mesh: 0 }], materials: matt });
write_squares("far", { nodes: [{ mesh: 0, translation: [500003, 6000003, 0] }], materials: matt });
write_squares("flat", { nodes: [{ mesh: 0 }, { camera: 0, translation: [0, 1, 7] }], materials: matt,
  cameras: [{ type: "orthographic", orthographic: { xmag: 2, ymag: 1.5, znear: 0.1, zfar: 20 } }] });
write_squares("wide", { nodes: [{ mesh: 0 }, { camera: 0, translation: [0, 1, 3] }], materials: matt,
  cameras: [{ type: "perspective", perspective: { aspectRatio: 3, yfov: 0.8, znear: 0.1, zfar: 20 } }] });
write_squares("odd", { nodes: [{ mesh: 0 }], materials: [{ ...matt[0], pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }], textures: [{ source: 0 }], images: [{ uri: "odd.png" }] });
write_odd_png();
await with_page({ prelude: kHeld }, "", loading);
await with_page({ prelude: kHeld, width: 390, height: 844, phone: true }, "", loading);
await with_page({ prelude: kHeld }, "#size=480x480", loading_of_a_link);
await with_page({ prelude: kHeld }, "", haste);
await with_page({ prelude: kNoHistory }, "", no_history);
await with_page({ prelude: kCountedHistory }, "", counted_history);
await with_page({ prelude: "delete window.DecompressionStream;" }, "", no_unpacking);
await with_page({}, "", failing_frame);
await with_page({ prelude: kEnding }, "", ending_engine);
await with_page({}, "#lobe=toString&constructor=1&lights=0,0,1,red&size=--report&env=--report", hostile_link);
await with_page({}, "#lights=0,0,1,%23ffffff%0A--samples%0A16", line_break_in_link);
await with_page({}, "#scene=--report=x", option_as_scene);
await with_page({}, "", engines, controls, first_motion, far_model, early_drag);
end();
