// Scenes and pictures, by the WebAssembly module. The files node.js, browser.js, workerd.js and edge.js say where its code is.
import halflit_module from "./module.js";
import { start_module } from "./kernels.js";
import { flags, pixelEpoch, version } from "./tables.js";

const kSimdProbe = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);
const kRounds = 16;  // of files that name other files
const kUsage = 2, kDamaged = 3, kFile = 4, kLimit = 5;  // exit codes of the program
export const kFormats = ["png", "jpg", "bmp", "tga"];  // of pictures that are written; "jpeg" is "jpg"
// "a, b or c". before, after: of each word.
export const any_of = (words, before = "", after = "") => {
  const each = words.map((word) => before + word + after);
  return `${each.slice(0, -1).join(", ")} or ${each[each.length - 1]}`;
};
const text_bytes = new TextEncoder();

export class HalflitError extends Error {
  // code: the exit code that the program has for the error.
  constructor(message, code) {
    super(message);
    this.name = "HalflitError";
    this.code = code;
  }
}

export const usage = (message) => new HalflitError(message, kUsage);
export const line_of = (error) => String(error?.message ?? error).split("\n")[0];
const read_as = (name) => `read it first, as by await readFile(${name}) of node:fs/promises, or await fetch(${name})`;

// null and undefined are no options.
export function options_of(given) {
  if (given === null || given === undefined) return {};
  if (Array.isArray(given) || typeof given !== "object")
    throw usage(`options: expected an object, found ${Array.isArray(given) ? "an array" : typeof given}`);
  return given;
}

// ---- the module ---------------------------------------------------------------------------------------------------------
let code_of_host = null;  // name => WebAssembly.Module, its bytes or a Response, or a promise of these
let started = null;       // promise of the module that new scenes use

export function set_code(load) {
  code_of_host = load;
}

async function compiled(name, code) {
  let given;
  try {
    given = await code;
  } catch (error) {
    throw error instanceof HalflitError ? error : new HalflitError(`${name}: ${line_of(error)}`, kFile);
  }
  if (given instanceof WebAssembly.Module) return given;
  if (given?.ok === false) throw new HalflitError(`${name}: ${given.url}: status ${given.status}`, kFile);
  try {
    return await WebAssembly.compile(typeof given?.arrayBuffer === "function" ? await given.arrayBuffer() : given);
  } catch (error) {
    if (error instanceof TypeError) throw usage(`${name}: expected its bytes, a Response or a WebAssembly.Module`);
    throw new HalflitError(`${name}: ${line_of(error)}`, error instanceof WebAssembly.CompileError ? kDamaged : kFile);
  }
}

const of_host = (name) => {
  if (!code_of_host) throw usage(`init: expected { wasm }, the code of ${name}: halflit/core has none of its own`);
  return (async () => code_of_host(name))();  // what it throws is told by the promise
};

async function start(options) {
  const { wasm, wasm128, simd } = options_of(options);
  const code = wasm ?? of_host("halflit.wasm"), has_simd = simd ?? WebAssembly.validate(kSimdProbe);
  const second = !has_simd ? null : wasm128 ?? (wasm ? null : of_host("halflit_wasm128.wasm"));
  const [module, of_kernels] = await Promise.all([compiled("halflit.wasm", code), second && compiled("halflit_wasm128.wasm", second)]);
  const core = await start_module(halflit_module, module, of_kernels).catch((error) => {
    throw new HalflitError(`halflit.wasm: cannot be started: ${line_of(error)}`, kDamaged);
  });
  core.ended = false;
  return core;
}

export function init(options) {
  if (options || !started) {
    const attempt = start(options);
    started = attempt;
    attempt.catch(() => { if (started === attempt) started = null; });
  }
  return started.then((core) => ({ version, pixelEpoch, isa: core.UTF8ToString(core._halflit_isa()) }));
}

export async function running() {
  if (!started) await init();
  const core = await started;
  if (!core.ended && !core.full) return core;
  started = null;
  return running();
}

// The page's worker, whose module has functions that the package has not, calls them by this and by Scene.drawn().
export async function with_module(work) {
  const core = await running();
  return call(core, () => work(core));
}

// True if the module that runs has ended, or has no memory for other scenes.
export async function has_ended() {
  const core = started && await started;
  return !core || core.ended || core.full;
}

// Calls the module. What it throws (a trap, or memory that cannot grow) ends it: its scenes are lost, and new ones get a new module.
export function call(core, work) {
  if (core.ended) throw new HalflitError("the module has ended, and its scenes with it", kLimit);
  try {
    return work(core);
  } catch (error) {
    if (error instanceof HalflitError) throw error;
    core.ended = true;
    const is_of_code = WebAssembly.Exception !== undefined && error instanceof WebAssembly.Exception;  // thrown where memory ends alone
    throw new HalflitError(is_of_code ? "out of memory" : `the module ended: ${line_of(error)}`, kLimit);
  }
}

export function out_of_memory(core) {
  core.full = true;
  return new HalflitError("out of memory", kLimit);
}

export function allocated(core, size) {
  const place = core._halflit_allocate(size || 1);
  if (!place) throw out_of_memory(core);
  return place;
}

export function with_text(core, text, use) {
  const size = core.lengthBytesUTF8(text) + 1, place = allocated(core, size);
  core.stringToUTF8(text, place, size);
  try {
    return use(place);
  } finally {
    core._halflit_free(place);
  }
}

export const copied = (core, place, size) => core.HEAPU8.slice(place, place + size);

// ---- options ------------------------------------------------------------------------------------------------------------
const camel = (name) => name.replace(/^-+/, "").replace(/-([a-z0-9])/g, (_, letter) => letter.toUpperCase());
const flag_of = new Map();
for (const flag of flags)
  for (const name of flag.names)
    if (name.startsWith("--")) for (const key of [camel(name), name, name.slice(2)]) flag_of.set(key, flag);

// Arguments of a call: flags without the hyphens at their begin.
function call_arguments(given) {
  const { width, height, ...others } = given, made = {};
  for (const [key, value] of Object.entries(others)) made[flag_of.get(key)?.names.at(-1).slice(2) ?? key] = value;
  return width === undefined ? made : { ...made, size: `${width}x${height}` };
}

const kOwn = new Set(["width", "height", "flags", "files", "name"]);
const is_bytes = (value) => value instanceof ArrayBuffer || ArrayBuffer.isView(value);

// Words of a command line: quotes hold blanks together.
function words_of(line) {
  if (Array.isArray(line)) return line.map(String);
  return (String(line).match(/(?:[^\s"']|"[^"]*"|'[^']*')+/g) ?? []).map((word) => word.replace(/"([^"]*)"|'([^']*)'/g, "$1$2"));
}

function value_text(flag, key, value) {
  if (typeof value === "boolean") {
    if (!/(^|\|)on(\||$)/.test(flag.form)) throw usage(`${key}: expected a value (${flag.form}), found ${value}`);
    return value ? "on" : "off";
  }
  if (Array.isArray(value)) return value.join(flag.form === "WxH" ? "x" : ",");
  if (typeof value === "string" || typeof value === "number") return String(value);
  throw usage(`${key}: expected a text or a number`);
}

const kNames = [...new Set([...flags.map((flag) => camel(flag.names.at(-1))), ...kOwn])].join("\n");
function did_you_mean(core, word) {
  const told = (at) => with_text(core, kNames, (names) => core.UTF8ToString(core._halflit_did_you_mean(at, names)));
  return call(core, () => with_text(core, word, told));
}

// A message of the module with the options' names as the caller wrote them. Flags stay where the caller wrote flags.
function in_callers_words(message, options) {
  const keys = Object.keys(options).filter((key) => options[key] !== undefined && options[key] !== null);
  const name_of = (word) => {
    const flag = flag_of.get(word);
    if (!flag) return word;
    const key = keys.find((name) => flag_of.get(name) === flag);
    if (key !== undefined) return key;
    if (flag.names.includes("--size") && keys.includes("width")) return "width and height";
    return keys.includes("flags") ? word : camel(flag.names.at(-1));
  };
  return message.replace(/(^|[^\w-])(--[a-z][a-z0-9-]*)/g, (_, before, word) => before + name_of(word));
}

// The words of the command line that means these options.
function flag_words(core, options) {
  const words = [];
  for (const [key, value] of Object.entries(options)) {
    if (kOwn.has(key) || value === undefined || value === null) continue;
    const flag = flag_of.get(key);
    if (!flag) throw usage(`unknown option ${key}${did_you_mean(core, key)}`);
    const name = flag.names.at(-1);
    if (flag.form === "") {
      if (typeof value !== "boolean") throw usage(`${key}: expected true or false`);
      if (value) words.push(name);
      continue;
    }
    const values = flag.repeated && Array.isArray(value) ? value : [value];
    for (const one of values) words.push(name, value_text(flag, key, one));
  }
  const { width, height } = options;
  if ((width === undefined) !== (height === undefined)) throw usage("width and height: expected both or none");
  if (width !== undefined) words.push("--size", `${width}x${height}`);
  if (options.flags !== undefined) words.push(...words_of(options.flags));
  for (const word of words) if (/[\n\0]/.test(word)) throw usage("options have no line breaks");
  return words;
}

// ---- files --------------------------------------------------------------------------------------------------------------
async function bytes_of(given) {
  let value = await given;
  if (value === undefined || value === null) return null;
  if (typeof value === "string") return text_bytes.encode(value);
  if (typeof value.arrayBuffer === "function") {
    if (value.ok === false) return null;  // a Response for a file that is not there
    value = await value.arrayBuffer();
  }
  if (value instanceof ArrayBuffer) return new Uint8Array(value);
  if (ArrayBuffer.isView(value)) return new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
  throw usage("expected bytes: an ArrayBuffer, a view of one, a text, a Blob or a Response");
}

function add_file(core, handle, name, bytes, of_scene) {
  const place = with_text(core, name, (text) => core._halflit_add_file(handle, text, bytes.length, of_scene ? 1 : 0));
  if (!place && bytes.length > 0) throw out_of_memory(core);
  core.HEAPU8.set(bytes, place);
}

// ---- pictures -----------------------------------------------------------------------------------------------------------
export class Picture {
  #core;
  constructor(core, width, height, place, report, hash = report.pixel_hash) {
    this.#core = core;
    this.width = width;
    this.height = height;
    this.pixels = new Uint8ClampedArray(copied(core, place, 4 * width * height).buffer);
    this.report = report;
    this.hash = hash;
  }
  encode(format) {
    if (![...kFormats, "jpeg"].includes(format))
      throw usage(`encode: expected ${any_of(kFormats, '"', '"')}, found ${JSON.stringify(format)}`);
    const { width, height, pixels } = this, expected = 4 * width * height;  // all may have been changed, or sent to another thread
    if (![width, height].every((side) => Number.isInteger(side) && side > 0))
      throw usage(`picture: expected a size, found ${width} x ${height}`);
    if (pixels?.length !== expected)
      throw usage(`pixels: expected ${expected} bytes for ${width} x ${height}, found ${pixels?.length ?? "none"}`);
    return call(this.#core, (core) => {
      const place = core._halflit_image(width, height);
      if (place) core.HEAPU8.set(pixels, place);
      const code = place ? with_text(core, `picture.${format}`, (name) => core._halflit_encode(name)) : kLimit;
      if (code === kLimit) core.full = true;
      if (code !== 0) throw new HalflitError(place ? core.UTF8ToString(core._halflit_module_text()) : "out of memory", code);
      const file = copied(core, core._halflit_encoded(), core._halflit_encoded_size());
      core._halflit_forget_encoded();
      return file;
    });
  }
  png() {
    return this.encode("png");
  }
}

// ---- scenes -------------------------------------------------------------------------------------------------------------
// Closes what nobody holds any more.
export const kForgotten = typeof FinalizationRegistry === "undefined" ? null : new FinalizationRegistry(({ core, close }) => {
  if (!core.ended) close();
});

export const is_built_in = (scene) => /^(demo$|sphere:|lights:)/.test(scene);

export class Scene {
  #core; #handle; #name; #defaults; #resolve = null; #asked = new Set(); #environment = null; #environments = 0;

  constructor(core, handle, name, defaults) {
    this.#core = core;
    this.#handle = handle;
    this.#name = name;
    this.#defaults = defaults;
    if (typeof defaults.files === "function") this.#resolve = defaults.files;
    kForgotten?.register(this, { core, close: () => core._halflit_close(handle) }, this);
  }

  static async open(source, options) {
    const built_in = typeof source === "string";
    if (built_in && !is_built_in(source)) {
      const name = JSON.stringify(source);
      throw usage(`${name}: expected the bytes of a model, or "demo", "sphere:N" or "lights:N"; ${read_as(name)}`);
    }
    const core = await running();
    const name = built_in ? source : options.name ?? "model";
    const bytes = built_in ? null : await bytes_of(source);
    if (!built_in && bytes === null) throw usage("expected a model's bytes, or the name of a built-in scene");
    const files = options.files && typeof options.files !== "function" ? options.files : {};
    const entries = [...(files instanceof Map ? files : Object.entries(files))];
    const listed = await Promise.all(entries.map(async ([at, file]) => [at, await bytes_of(file)]));
    const handle = call(core, () => with_text(core, name, (text) => core._halflit_open(text)));
    const scene = new Scene(core, handle, name, options);
    try {
      call(core, () => {
        if (bytes) add_file(core, handle, name, bytes, true);
        for (const [at, file] of listed) if (file) add_file(core, handle, at, file, true);
      });
      await scene.#do(options, (words) => core._halflit_prepare(handle, words));
      return scene;
    } catch (error) {
      scene.free();
      throw error;
    }
  }

  // Does it, and again with the files that it asked for, as far as the host has them.
  async #do(options, work) {
    for (let round = 0; ; ++round) {
      const core = this.#core, handle = this.#live();
      const flags = flag_words(core, this.#with_environment(options)).join("\n");  // each time: another picture may have replaced the environment
      const code = call(core, () => with_text(core, flags, work));
      const told = code === 0 ? "" : core.UTF8ToString(core._halflit_text(handle));  // before another picture of the scene
      const found = round < kRounds ? await this.#ask() : [];
      if (found.length > 0) {
        call(core, () => found.forEach(([name, bytes]) => add_file(core, this.#live(), name, bytes, true)));
        continue;
      }
      if (code === 0) return;
      const message = in_callers_words(told, options);
      // Memory never shrinks: new scenes get a new module, and this one goes with its last scene.
      if (code === kLimit && message.includes("out of memory")) core.full = true;
      throw new HalflitError(message, code);
    }
  }

  async #ask() {
    if (!this.#resolve) return [];
    const core = this.#core;
    const wanted = core.UTF8ToString(core._halflit_wanted(this.#handle)).split("\n").filter((name) => name && !this.#asked.has(name));
    wanted.forEach((name) => this.#asked.add(name));
    const answers = await Promise.all(wanted.map(async (name) => [name, await bytes_of(this.#resolve(name))]));
    return answers.filter(([, bytes]) => bytes !== null);
  }

  // Bytes of an environment become a file of the scene, which keeps the last one alone. Its name is new, as the module knows its light by it.
  #with_environment(options) {
    const { env } = options;
    if (!is_bytes(env)) return options;
    if (this.#environment?.env !== env) {
      const bytes = env instanceof ArrayBuffer ? new Uint8Array(env) : new Uint8Array(env.buffer, env.byteOffset, env.byteLength);
      const last = this.#environment, name = `environment ${++this.#environments}`;
      this.#environment = null;
      call(this.#core, (core) => {
        if (last) add_file(core, this.#live(), last.name, new Uint8Array(0), false);
        add_file(core, this.#live(), name, bytes, false);
      });
      this.#environment = { env, name };
    }
    return { ...options, env: this.#environment.name };
  }

  #live() {
    if (this.#handle === 0) throw usage("the scene was freed");
    return this.#handle;
  }

  render(options) {
    return this.drawn(options, (core, handle, words) => core._halflit_draw(handle, words));
  }

  // draw, report: functions of the module; their answers are exit codes.
  async drawn(options, draw, report = (core, handle) => core._halflit_report(handle)) {
    let picture = null;
    await this.#do({ ...this.#defaults, ...options_of(options) }, (words) => {
      const core = this.#core, handle = this.#live(), code = draw(core, handle, words) || report(core, handle);
      if (code !== 0) return code;
      const told = JSON.parse(core.UTF8ToString(core._halflit_text(handle)));
      picture = new Picture(core, core._halflit_width(handle), core._halflit_height(handle), core._halflit_pixels(handle), told);
      return code;
    });
    return picture;
  }

  // One of the engine's calls by its name, as "look"; arguments: the flags of the program's command, as options have them.
  async call(name, given) {
    let answer = null;
    const args = options_of(given);
    await this.#do(this.#defaults, () => {
      const core = this.#core, handle = this.#live();
      const text_of_arguments = JSON.stringify(call_arguments(args));
      const code = with_text(core, String(name), (of) => with_text(core, text_of_arguments, (text) => core._halflit_call(handle, of, text)));
      if (code !== 0) return code;
      const { hash, ...told } = JSON.parse(core.UTF8ToString(core._halflit_text(handle)));
      answer = told;
      const place = core._halflit_call_pixels();
      answer.picture = null;
      if (place) answer.picture = new Picture(core, core._halflit_call_width(), core._halflit_call_height(), place, answer.report, hash);
      return code;
    });
    return answer;
  }
  look(given) { return this.call("look", given); }
  section(section, given) { return this.call("section", { ...options_of(given), section }); }
  certify(given) { return this.call("certify", given); }
  measure(given) { return this.call("measure", given); }
  explain(pixel, given) { return this.call("explain", { ...options_of(given), pixel }); }
  // The scene's model with another file of the scene: files: {"new.stl": bytes}.
  compare(other, given) { return this.call("compare", { ...options_of(given), a: this.#name, b: other }); }

  async #described(options, json, parts) {
    let text = "";
    await this.#do({ ...this.#defaults, ...options }, (words) => {
      const code = this.#core._halflit_info(this.#live(), words, json ? 1 : 0, parts ? 1 : 0);
      text = this.#core.UTF8ToString(this.#core._halflit_text(this.#handle));
      return code;
    });
    return text;
  }
  async info(options) {
    const { parts = false, ...others } = options_of(options);
    return JSON.parse(await this.#described(others, true, parts));
  }
  async describe(options) {
    const { parts = false, json = false, ...others } = options_of(options);
    return this.#described(others, json, parts);
  }

  free() {
    if (this.#handle === 0) return;
    kForgotten?.unregister(this);
    if (!this.#core.ended) this.#core._halflit_close(this.#handle);
    this.#handle = 0;
  }

  [Symbol.dispose ?? Symbol.for("Symbol.dispose")]() {
    this.free();
  }
}

export const load = async (source, options) => Scene.open(source, options_of(options));

export async function render(source, options) {
  const scene = await load(source, options);
  try {
    return await scene.render();
  } finally {
    scene.free();
  }
}

// Bytes of memory that the module has taken from the system. It grows, and is given back when the module is.
export async function memory() {
  return (await running()).HEAPU8.length;
}
