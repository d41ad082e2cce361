#!/usr/bin/env node
// halflit MODEL [PICTURE] [FLAGS] and halflit info MODEL [FLAGS]: the program's `render` and `info`, by the module.
import { accessSync, closeSync, constants, existsSync, openSync, readFileSync, readSync, readdirSync, realpathSync, statSync, writeFileSync, writeSync } from "node:fs";
import { basename, dirname, isAbsolute, relative, resolve } from "node:path";
import { isatty } from "node:tty";
import { parse, table_of } from "./command_line.mjs";
import { any_of, is_built_in, kFormats } from "./engine.js";
import { HalflitError, init, load, pixelEpoch, version } from "./node.js";

const kUsage = 2, kFile = 4;  // exit codes
const kModels = /\.(glb|gltf|stl|ply|obj|off|3mf)$/i, kPictures = new RegExp(`\\.(${kFormats.join("|")}|jpeg)$`, "i");
const kNamedSkies = ["sky", "studio", "none"];
const usage = (message) => new HalflitError(message, kUsage);
const json_of = (report) => `${JSON.stringify(report, null, 2)}\n`;

function help(command) {
  const what =
    command === "info" ? "Describe a scene, and what drawing it requires" : "Draw a scene into a picture; without SCENE, the demo scene";
  const lines = [what, "", "Usage: halflit SCENE [PICTURE] [FLAGS]", "       halflit info SCENE [FLAGS]"];
  lines.push("", "SCENE: a .glb, .gltf, .stl, .ply, .obj, .off, .3mf, .splat, .spz or .sog file, demo, sphere:N or lights:N; - for standard input.");
  let group = "";
  for (const flag of table_of(command ?? "render")) {
    if (flag.group !== group) lines.push("", `${group = flag.group}:`);
    lines.push(`  ${[flag.names.join(","), flag.form].filter(Boolean).join(" ")}`, `      ${flag.help}`);
  }
  return `${lines.join("\n")}\n`;
}

// ---- files --------------------------------------------------------------------------------------------------------------
const is_folder = (path) => statSync(path, { throwIfNoEntry: false })?.isDirectory() ?? false;
const holds_model = (folder) => readdirSync(folder).some((name) => kModels.test(name));
const is_scene = (word) => word === "-" || is_built_in(word) || kModels.test(word) || existsSync(word);
const real = (path) => (existsSync(path) ? realpathSync(path) : resolve(path));
const same_file = (a, b) => a !== "-" && b !== "-" && real(a) === real(b);

// "No such file or directory", as the program says it.
function reason(error) {
  if (error.code === "EISDIR") return "Is a directory";
  const text = /^[A-Z0-9]+: (.+?)(, \w+( '.*')?)?$/.exec(error.message)?.[1] ?? error.message;
  return text[0].toUpperCase() + text.slice(1);
}

function on_file(what, work) {
  try {
    return work();
  } catch (error) {
    throw Object.assign(new HalflitError(`${what}: ${reason(error)}`, kFile), { reader_left: error.code === "EPIPE" });
  }
}

// A pipe may be full or empty for a while, where another process made it so that it does not wait.
function patiently(work) {
  for (;;)
    try {
      return work();
    } catch (error) {
      if (error.code === "EOF") return 0;
      if (error.code !== "EAGAIN") throw error;
      Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0, 2);
    }
}

function print(text) {
  const bytes = typeof text === "string" ? Buffer.from(text) : text;
  on_file("standard output", () => {
    for (let at = 0; at < bytes.length;) at += patiently(() => writeSync(1, bytes, at));
  });
}

function standard_input() {
  if (isatty(0)) throw usage("standard input: expected a model, found a terminal");
  const parts = [], part = Buffer.alloc(1 << 20);
  on_file("standard input", () => {
    for (let size; (size = patiently(() => readSync(0, part, 0, part.length, null))) > 0;) parts.push(Buffer.from(part.subarray(0, size)));
  });
  return Buffer.concat(parts);
}

function read(path) {
  if (is_folder(path)) throw new HalflitError(`${path}: is a directory, expected a file`, kFile);
  return on_file(`${path}: cannot be opened`, () => readFileSync(path));
}
const write = (path, file) => (path === "-" ? print(file) : on_file(path, () => writeFileSync(path, file)));

function check_writable(path) {
  if (path === "-") return;
  if (existsSync(path)) on_file(path, () => accessSync(path, constants.W_OK));
  const folder = path.includes("/") ? path.slice(0, path.lastIndexOf("/") + 1) : ".";
  on_file(`${path}: the folder ${folder}`, () => accessSync(folder, constants.W_OK | constants.X_OK));
}

// Files that a model names: below its folder or one of `also`, symbolic links too. The names begin where the model's begins, in the working
// folder or at the root.
function files_beside(model, also) {
  const folders = [dirname(model), ...also].map((folder) => real(folder)), from = isAbsolute(model) ? "/" : ".";
  return (name) => {
    try {
      const place = realpathSync(resolve(from, name)), outside = (path) => path.startsWith("..") || isAbsolute(path);
      return folders.every((folder) => outside(relative(folder, place))) ? null : readFileSync(place);
    } catch {
      return null;
    }
  };
}

// ---- commands -----------------------------------------------------------------------------------------------------------
// {output, report} of `render`. What it would overwrite and where it could not write is refused before anything is drawn.
function outputs_of(scene, words, own) {
  const places = [...words];
  let output = own.output;
  if (places.length > 1 && kPictures.test(places.at(-1))) {
    if (output) throw usage(`unexpected argument ${places.at(-1)}: the picture is named by -o ${output}`);
    output = places.pop();
  }
  if (places.length > 1)
    throw usage(`unexpected argument ${places[1]}: expected one scene and a ${any_of(kFormats, ".")} file; see halflit render --help`);
  const { format } = own, report = own.report;
  if (format && !kFormats.includes(format))
    throw usage(`--format: expected ${any_of(kFormats)}, found '${format}'; see halflit render --help`);
  const stem = basename(scene ?? "").replace(/\.[^.]*$/, "").split(":")[0];
  output ??= `${scene === "-" || !stem ? "halflit" : stem}.${format ?? "png"}`;
  if (output.endsWith("/") || output.includes("{"))
    throw usage(`-o ${output}: expected the name of one picture; the program alone draws many`);
  if (is_folder(output)) throw new HalflitError(`${output}: Is a directory`, kFile);
  if (!format && output !== "-" && !kPictures.test(output)) throw usage(`${output}: expected ${any_of(kFormats, ".")}`);
  if (report && (report === output || same_file(report, output)))
    throw usage(`--report: expected another file than the picture's, found '${report}'`);
  return { output, report, format: format ?? (output === "-" ? "png" : /\.([^.]+)$/.exec(output)[1].toLowerCase()) };
}

function first_byte(path) {
  const file = openSync(path), byte = Buffer.alloc(1);
  try {
    readSync(file, byte);
  } finally {
    closeSync(file);
  }
  return byte.toString("latin1");
}

function spare({ output, report }, inputs) {
  for (const path of [output, report])
    for (const [input, what] of inputs)
      if (path && input && same_file(path, input)) throw new HalflitError(`${path}: is ${what} itself and is not overwritten`, kFile);
  const earlier = report && report !== "-" ? statSync(report, { throwIfNoEntry: false }) : null;
  if (earlier?.isFile() && earlier.size > 0 && on_file(report, () => first_byte(report)) !== "{")
    throw usage(`--report: expected a new file or an earlier report, found '${report}', which is neither`);
}

// The scene of a command line, and the path of its environment.
async function loaded(model, environment, { own, passed }) {
  if (own.scalar) await init({ simd: false });
  const built_in = is_built_in(model), piped = model === "-", options = { name: piped ? "standard input" : model, flags: passed };
  if (!built_in && !piped) options.files = files_beside(model, own["allow-external"] ?? []);
  if (environment) {
    try {
      options.env = read(environment);
    } catch (error) {
      throw Object.assign(error, { message: `--env: ${error.message}; expected a picture of floats (.hdr, .exr, .pfm), sky or studio` });
    }
  }
  return load(built_in ? model : piped ? standard_input() : read(model), options);
}

function warn(own, lines) {
  if (!own.quiet) for (const line of lines) console.error(`halflit: ${line}`);
}

async function draw(line, model, environment) {
  const { own, words } = line, places = outputs_of(words[0], words, own), { output, report, format } = places;
  spare(places, [[words[0] && !is_built_in(model) ? model : null, "the scene"], [environment, "the environment"]]);
  line.report = report;
  for (const path of [output, report]) if (path) check_writable(path);
  const scene = await loaded(model, environment, line), picture = await scene.render();
  const lost = /^jpe?g$/.test(format) && picture.pixels.some((value, i) => i % 4 === 3 && value < 255);
  if (lost) warn(own, [`warning: ${output}: this format has no transparency; the picture is shown over black (.png .bmp .tga keep it)`]);
  warn(own, picture.report.warnings.map((warning) => `warning: ${warning}`));
  write(output, picture.encode(format));
  if (output !== "-") warn(own, [`wrote ${output}`]);
  if (report) write(report, json_of({ ...picture.report, output }));
}

async function describe({ own, words, ...line }, model, environment) {
  if (words.length === 0) throw usage("SCENE is required; see halflit info --help");
  if (words.length > 1) throw usage(`unexpected argument ${words[1]}; see halflit info --help`);
  const scene = await loaded(model, environment, { own, ...line }), info = await scene.info();
  warn(own, info.warnings.map((warning) => `warning: ${warning}`));
  print(await scene.describe({ parts: own.parts, json: own.json }));
}

async function main(words) {
  if (words.length === 0 && isatty(1)) return print(help(null));
  if (words.length === 0) throw usage("no scene and no command: expected halflit SCENE [PICTURE], or info; see halflit --help");
  const line = parse(words, is_scene);
  if (line.help) return print(help(line.command));
  if (line.version) return print(`halflit ${version} (pixel_epoch ${pixelEpoch}, WebAssembly)\n`);
  const model = line.words[0] ?? "demo";
  if (is_folder(model)) throw usage(`${model}: is a folder${holds_model(model) ? ", expected one model" : " without models; folders in it are not looked into"}`);
  const at = line.passed.lastIndexOf("--env");
  const environment = at >= 0 && !kNamedSkies.includes(line.passed[at + 1]) ? line.passed.splice(at, 2)[1] : null;
  try {
    await (line.command === "info" ? describe(line, model, environment) : draw(line, model, environment));
  } catch (error) {
    const code = Number.isInteger(error.code) ? error.code : kFile;
    const told = String(error.message).replace(/^(env: )?environment \d+/, (name) => (environment ? `--env: ${environment}` : name));
    const of_value = code === kUsage && line.passed.some((flag) => told.startsWith(`${flag}: expected`)) && !told.includes("; see halflit");
    const message = of_value ? `${told}; see halflit ${line.command} --help` : told;
    const head = { schema: "halflit.report/1", status: "error", halflit: version, pixel_epoch: pixelEpoch };
    if (line.report && !error.reader_left) write(line.report, json_of({ ...head, scene: model, error: { code, message } }));
    throw Object.assign(error, { message });
  }
}

// One line, and a number as the exit code: the code of a system's error is a word. Whoever has stopped reading is told nothing.
try {
  await main(process.argv.slice(2));
} catch (error) {
  if (!error.reader_left) console.error(`halflit: error: ${String(error.message).split("\n")[0]}`);
  process.exitCode = Number.isInteger(error.code) ? error.code : kFile;
}
