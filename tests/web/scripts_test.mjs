// The page's scripts in Node.js, without a browser and without the module: node scripts_test.mjs PAGE_FOLDER
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { createContext, runInContext } from "node:vm";
import { part_of_script } from "../../apps/web/module_code.mjs";

const folder = process.argv[2];
let failures = 0;

// holds: a function, so that an exception is a failure of this fact alone.
function check(fact, holds) {
  let found = "", ok = false;
  try {
    ok = holds() === true;
  } catch (error) {
    found = `: ${error.message}`;
  }
  if (!ok) ++failures;
  console.log(`${ok ? "ok" : "FAILED"}: ${fact}${found}`);
}

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const near = (a, b, most) => Math.abs(a - b) <= most;
const away = (view) => Math.hypot(...view.position.map((x, i) => x - view.target[i]));

// The lobes of the literature: their power is power + power_per_wrap * wrap.
const lobe = (name, takes_wrap, wrap, power, power_per_wrap, normalize) => ({ name, takes_wrap, wrap, power, power_per_wrap, normalize });
const kLibrary = {
  usual_wrap: 0.5,
  lobes: [lobe("lambert", false, 0, 1, 0, false), lobe("green", true, 0, 1, 0, false), lobe("half-lambert", false, 1, 1, 0, false),
    lobe("valve", false, 1, 2, 0, false), lobe("sloan", true, 0, 1, 1, false), lobe("mcauley", true, 0, 1, 1, true)],
  specular: ["none", "phong", "blinn", "ggx"], shadows: ["off", "hard", "soft-split"], tonemap: ["none", "reinhard", "aces", "neutral"],
};

// Returns the scripts' definitions, by name. A script's constants are not members of its global object.
function load(scripts, globals, names, before = "") {
  const context = createContext({ console, URLSearchParams, Blob, Uint8Array, setTimeout, ...globals });
  const text = scripts.map((name) => readFileSync(join(folder, name), "utf8")).join("\n");
  return runInContext(`${before}\n${text}\n;({ ${names.map((name) => `get ${name}() { return ${name}; }`).join(", ")} })`, context);
}

function test_links() {
  const page = load(["state.js", "orbit.js", "files.js"], { kLibrary },
    ["kDefaults", "state_of_link", "link_of", "flags_of", "command_of", "stem_of", "view_text", "view_of", "digits", "kUpright", "kBack"]);
  const of_link = page.state_of_link, plain = (text) => same(of_link(text), page.kDefaults);
  check("link: an empty one is the usual state", () => plain(""));
  const full = { ...page.kDefaults, scene: "a/b c.glb", size: "320x180", samples: 16, view: "1,2,3,0,0,0,35", time: 0.25, lobe: "sloan", wrap: 0.8, power: 2.5,
    normalize: true, specular: "ggx", specular_normalize: false, scene_lights: false, lights: "-40,40,1,#ffe8d0;120,20,0.5,#ffffff", shadows: "hard", sun_size: 2,
    sky_shadows: 64, env: "room.hdr", rotate: -30, show_env: true, sh_order: 3, exposure: -1.5, tonemap: "aces", budget: 0.5, ground: true };
  check("link: each value comes back", () => same(of_link(page.link_of(full)), full));
  for (const name of ["toString", "constructor", "__proto__", "hasOwnProperty", "no-such-lobe"])
    check(`link: the lobe ${name} is refused`, () => plain(`lobe=${name}`));
  for (const name of ["toString", "constructor", "__proto__", "no_such_key"]) check(`link: the key ${name} is left out`, () => plain(`${name}=5`));
  for (const text of ["specular=toString", "shadows=soft", "tonemap=--report", "env=--report", "size=--report", "size=1e3x1", "power=much", "exposure=much", "wrap=NaN", "samples=1e999"])
    check(`link: ${text} is refused`, () => plain(text));
  for (const color of ["%23fff:size=3", "%23fff", "red", "%23gggggg"]) check(`link: a light of the colour ${color} is refused`, () => plain(`lights=0,0,1,${color}`));
  for (const text of ["lights=0,0,1,%23ffffff%0A--samples%0A16", "scene=demo%0A--samples", "env=a%0Ab.hdr", "view=1,2,3,0,0,0,35%0D", "scene=a%00b", "size=640x360%0A"])
    check(`link: control characters are refused in ${text}`, () => plain(text));
  check("link: a scene with a number stays", () => of_link("scene=sphere:250000").scene === "sphere:250000");
  check("link: a size of one number stays", () => of_link("size=256").size === "256");
  check("link: numbers that the lists lack stay", () => of_link("sky_shadows=128").sky_shadows === 128);
  const words = (text) => [...page.command_of(of_link(text)).matchAll(/'[^']*'|\S+/g)].map(([word]) => word.replace(/^'|'$/g, ""));
  check("command: a scene that begins with - is a file", () => words("scene=--report=x").includes("./--report=x"));
  check("command: so is an environment, and the picture", () => same(words("scene=-a.glb&env=-b.hdr").filter((word) => word.startsWith("./")), ["./-a.glb", "./-b.hdr", "./-a.png"]));
  check("command: the picture is named after the scene", () => page.stem_of("lights:16") === "lights-16" && page.stem_of("a/it's.v2.glb") === "it's.v2" && page.stem_of("a\nb.glb") === "a\nb");
  check("command: quotes are kept from a shell", () => page.command_of(of_link("scene=it's.glb")).startsWith("halflit 'it'\\''s.glb' "));

  // A model far from the origin: coordinates as read from a file, at a distance of 1.
  const far = { position: [500003.2, 6000003.4, 0.25], target: [500003, 6000003, 1.125], fov: 35 };
  check("view: coordinates far from the origin keep a millionth of the distance", () => {
    const read = page.view_of({ view: page.view_text(far) });
    return [...read.position, ...read.target].every((x, i) => near(x, [...far.position, ...far.target][i], 1e-6 * away(far)));
  });
  check("view: so do those of a small scene", () => {
    const small = { position: [1.234567891e-7, 0, 2e-7], target: [0, 0, 0], fov: 35 };
    return page.view_of({ view: page.view_text(small) }).position.every((x, i) => near(x, small.position[i], 1e-6 * away(small)));
  });
  check("up: the turns to +y come back, and a light from above shines along the file's axis", () =>
    Object.entries({ x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], "-x": [-1, 0, 0], "-y": [0, -1, 0], "-z": [0, 0, -1] }).every(([up, axis]) =>
      same(page.kUpright[up](axis).map((x) => x + 0), [0, 1, 0]) && same(page.kBack[up](page.kUpright[up]([1, 2, 3])), [1, 2, 3]) &&
      page.flags_of({ ...page.kDefaults, up, lights: "0,90,1,#ffffff" }).some((flag) => flag.startsWith(`directional:dir=${axis.map((x) => -x + 0)}:`))));
  check("view: the command line has the same numbers", () => page.flags_of({ ...page.kDefaults, view: page.view_text(far) }).includes("500003.2,6000003.4,0.25"));
}

function test_orbit() {
  const { turned, nearer, moved } = load(["orbit.js"], {}, ["turned", "nearer", "moved"]);
  const start = { position: [3, 4, 12], target: [0, 0, 0], fov: 35 }, finite = (view) => [...view.position, ...view.target].every(Number.isFinite);
  check("orbit: a turn keeps the target and the distance", () => {
    const view = turned(start, 0.7, -0.3);
    return same(view.target, start.target) && near(away(view), 13, 1e-12);
  });
  check("orbit: a whole turn ends where it began", () => turned(turned(start, Math.PI, 0), Math.PI, 0).position.every((x, i) => near(x, start.position[i], 1e-12)));
  check("orbit: a turn stops short of the poles", () => near(turned(start, 0, 100).position[1], 13 * Math.sin((89 * Math.PI) / 180), 1e-12));
  check("orbit: a view from straight above can be turned", () => [1, 1e-7, 1e7, 0.1 + 0.2].every((x) => finite(turned({ ...start, position: [0, x, 0] }, 0.1, 0.1))));
  check("orbit: a view from its own target stays", () => same(turned({ ...start, position: [0, 0, 0] }, 1, 1).position, [0, 0, 0]) && finite(nearer({ ...start, position: [0, 0, 0] }, 2, 1)));
  check("orbit: a zoom is a factor of the distance", () => near(away(nearer(start, 1.25, 5)), 13 / 1.25, 1e-12));
  check("orbit: zooms stop at a thousandth and a thousand times of the radius", () => {
    let near_view = start, far_view = start;
    for (let i = 0; i < 500; ++i) [near_view, far_view] = [nearer(near_view, 1.2, 5), nearer(far_view, 1 / 1.2, 5)];
    return near(away(near_view), 0.005, 1e-9) && near(away(far_view), 5000, 1e-6) && finite(turned(near_view, 0.1, 0.1));
  });
  check("orbit: what is at the target follows the pointer", () => {
    const front = { position: [0, 0, 10], target: [0, 0, 0], fov: 90 };  // the picture is 20 high there
    const view = moved(front, 0.1, 0.2);
    return view.target.every((x, i) => near(x, [-2, 4, 0][i], 1e-12)) && near(away(view), 10, 1e-12);
  });
}

function test_controls() {
  const form = { elements: [] };
  const page = load(["state.js", "controls.js", "files.js"], { kLibrary, document: { getElementById: () => form } }, ["kDefaults", "state_of_control", "lobe_of"]);
  const slide = (state, name, value) => page.state_of_control(state, { name, value: String(value), type: "range" });
  const choose = (state, name, value) => page.state_of_control(state, { name, value, type: "select-one" });
  const sloan = choose(page.kDefaults, "lobe", "sloan");
  check("controls: the power follows the wrap in models where the wrap decides it", () => page.lobe_of(slide(sloan, "wrap", 0.8)).power === 1.8);
  const moved = slide(sloan, "power", 2.2);
  check("controls: a power that was moved stays when the wrap moves", () => page.lobe_of(slide(moved, "wrap", 0.8)).power === 2.2);
  check("controls: moved back, it follows again", () => page.lobe_of(slide(slide(moved, "power", 1.5), "wrap", 0.8)).power === 1.8);
  check("controls: another model has its own power", () => page.lobe_of(choose(moved, "lobe", "valve")).power === 2);
  check("controls: McAuley's lobe is normalised by its name", () => page.lobe_of(choose(page.kDefaults, "lobe", "mcauley")).normalize);
  check("controls: the exposure is brighter than what is chosen", () => slide(page.kDefaults, "exposure", 2).exposure === 2);
}

function test_files() {
  const { with_files, chosen_of } = load(["files.js"], {}, ["with_files", "chosen_of"]);
  const names = (list) => list.map(({ name, file }) => `${name} ${file}`);
  check("files: a file replaces one of the same name", () =>
    same(names(with_files([{ name: "a.glb", file: 1 }, { name: "b.hdr", file: 2 }], [{ name: "b.hdr", file: 3 }])), ["a.glb 1", "b.hdr 3"]));
  const chosen = chosen_of([{ name: "a\n--samples\n16.glb", file: 1 }]);
  check("files: names have no control characters", () => chosen.model === "a_--samples_16.glb" && chosen.files[0].name === chosen.model);
  const several = chosen_of(["x/part.stl", "sky.hdr", "MODEL.3MF"].map((name) => ({ name, file: 1 })));
  check("files: the model of the fewest folders is drawn", () => several.model === "MODEL.3MF" && several.sky === "sky.hdr");
}

function test_words() {
  const { counted } = load(["state.js", "files.js"], { kLibrary }, ["counted"]);
  check("words: one is singular, all others plural", () =>
    same([counted(0, "light"), counted(1, "light"), counted(2, "band"), counted("1", "code"), counted("0.5", "code"), counted(158006, "triangle")],
      ["0 lights", "1 light", "2 bands", "1 code", "0.5 codes", "158,006 triangles"]));
}

// The worker and the engine with a module of the test's own, whose memory has 64 bytes.
async function test_worker() {
  const memory = new Uint8Array(64), answers = [], opened = [], closed = [];
  let place = 8, code = 0;
  const core = {
    HEAPU8: memory, lengthBytesUTF8: () => 8, stringToUTF8: () => {}, UTF8ToString: (at) => ({ 1: "{}", 2: "a.glb: damaged", 3: "scalar" })[at] ?? "",
    _halflit_allocate: () => place, _halflit_free: () => {}, _halflit_isa: () => 3, _halflit_wanted: () => 0, _halflit_add_file: () => place,
    _halflit_open: () => opened.push(opened.length + 1), _halflit_close: (handle) => closed.push(handle), _halflit_prepare: () => code, _halflit_draw: () => code,
    _halflit_report: () => 0, _halflit_page_report: () => 0, _halflit_text: () => (code ? 2 : 1), _halflit_pixels: () => 0, _halflit_width: () => 1, _halflit_height: () => 1,
  };
  const of_module = ["kernels", "engine"].map((name) => part_of_script(readFileSync(join(folder, `../module/${name}.js`), "utf8"))).join("\n");
  const globals = { WebAssembly, TextEncoder, ArrayBuffer, halflit_module: async () => core, postMessage: (answer) => answers.push(answer), flags: [], version: "", pixelEpoch: 0, onmessage: null };
  const worker = load(["worker.js"], globals, ["onmessage", "queue"], of_module);
  const ask = async (task) => {
    worker.onmessage({ data: { ...task, id: answers.length } });
    await worker.queue;
    return answers.at(-1);
  };
  const draw = (scene, ...flags) => ask({ kind: "draw", scene, flags });
  const started = await ask({ kind: "start", wasm: new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]), simd: false });
  check("worker: it says which kernels draw", () => started.isa === "scalar");
  const drawn = await draw("demo", "--samples", "1");
  check("worker: it draws", () => drawn.width === 1 && drawn.pixels.byteLength === 4 && !drawn.error);
  await draw("demo", "--samples", "4");
  check("worker: a scene stays open between its pictures", () => opened.length === 1 && closed.length === 0);
  await draw("sphere:500");
  check("worker: another scene closes it", () => opened.length === 2 && same(closed, [1]));
  await ask({ kind: "files", files: [{ name: "a.glb", file: new Uint8Array([1, 2, 3]).buffer }] });
  check("worker: new files close the scene too", () => same(closed, [1, 2]));
  await draw("a.glb");
  check("worker: a dropped file is given to the module", () => same([...memory.subarray(8, 11)], [1, 2, 3]));
  const broken = await draw("demo", "--light", "x\n--samples\n16");
  check("worker: a word with a line break is refused, as flags are separated by line breaks", () => /line break/.test(broken.error) && !broken.ended);
  code = 3;
  const damaged = await draw("a.glb");
  check("worker: the module's error is told, and the worker goes on", () => /damaged/.test(damaged.error) && !damaged.ended);
  code = 0;
  const of_code = new WebAssembly.Exception(new WebAssembly.Tag({ parameters: ["i32"] }), [5246800]);  // as C++ throws
  core._halflit_draw = () => { throw of_code; };
  const thrown = await draw("demo");
  check("worker: an exception of the module says that memory ended", () => thrown.error === "out of memory" && thrown.ended);
  // The page ends this worker now. Here it starts anew.
  await ask({ kind: "start", wasm: new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]), simd: false });
  place = 0;
  memory.fill(7);
  await ask({ kind: "files", files: [{ name: "a.glb", file: new Uint8Array([1, 2, 3]).buffer }] });
  const full = await draw("a.glb");
  check("worker: without memory nothing is written", () => memory.every((byte) => byte === 7));
  check("worker: without memory it ends and says so", () => full.error === "out of memory" && full.ended);
}

async function test_engine() {
  const workers = [];
  class Worker {
    constructor() {
      workers.push(this);
      this.sent = [];
    }
    postMessage(task) { this.sent.push(task); }
    terminate() { this.terminated = true; }
    answer(task, answer) { this.onmessage({ data: { ...answer, id: task.id } }); }
  }
  const text = { textContent: "" }, globals = (Stream) => ({
    Worker, document: { getElementById: () => text }, URL: { createObjectURL: () => "", revokeObjectURL: () => {} }, atob: () => "", DecompressionStream: Stream,
    Response: class { async arrayBuffer() { return new ArrayBuffer(0); } },
    Blob: class { stream() { return { pipeThrough() {} }; } },
  });
  const later = () => new Promise((resolve) => setTimeout(resolve, 5));
  const within = (promise) => Promise.race([promise, new Promise((resolve) => setTimeout(resolve, 200, { late: true }))]);
  const { Engine } = load(["engine.js"], globals(class {}), ["Engine"]);

  const engine = new Engine("simd"), files = engine.ask("files", {}), draw = engine.ask("draw", {});
  await later();
  const worker = workers[0];
  check("engine: tasks wait until the module has started", () => same(worker.sent.map((task) => task.kind), ["start"]));
  worker.answer(worker.sent[0], {});
  await later();
  check("engine: they are sent in their order", () => same(worker.sent.map((task) => task.kind), ["start", "files", "draw"]));
  worker.answer(worker.sent[1], {});
  worker.answer(worker.sent[2], { error: "out of memory", ended: true });
  const drawn = await within(draw);
  check("engine: a task has its answer", () => same(drawn, { error: "out of memory", ended: true }));
  check("engine: a worker that ended is terminated, which frees its memory", () => worker.terminated === true);
  const after = await within(engine.ask("draw", {}));
  check("engine: a task after the end is answered", () => after.late === undefined && (after.stopped || after.error !== undefined));

  const stopped = new Engine("simd");
  await later();
  const one = stopped.ask("draw", {});
  stopped.stop();
  const answers = [await within(one), await within(stopped.ask("draw", {}))];
  check("engine: tasks before and after a stop are answered", () => answers.every((answer) => answer.stopped === true));

  const old = load(["engine.js"], globals(class { constructor() { throw new Error("no such class"); } }), ["Engine"]);
  const failed = await within(new old.Engine("simd").ask("draw", {}));
  check("engine: a browser that cannot unpack the module gives an error", () => /no such class/.test(failed.error));
}

for (const test of [test_links, test_orbit, test_controls, test_files, test_words, test_worker, test_engine])
  await Promise.resolve().then(test).catch((error) => check(`${test.name} runs: ${error.message}`, () => false));
console.log(failures === 0 ? "all as expected" : `${failures} failed`);
process.exit(failures === 0 ? 0 : 1);
