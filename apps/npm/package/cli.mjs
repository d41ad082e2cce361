#!/usr/bin/env node
// halflit MODEL [PICTURE] [FLAGS]: the program's `render`, by the module.
import { readFileSync, realpathSync, writeFileSync } from "node:fs";
import { basename, dirname, isAbsolute, relative, resolve } from "node:path";
import { flags } from "./tables.js";
import { HalflitError, init, load, version, pixelEpoch } from "./node.js";

const kOwn = [
  { names: ["-o", "--output"], form: "FILE", help: "The picture: .png, .jpg, .bmp or .tga (default: the model's name with .png)" },
  { names: ["--report"], form: "FILE", help: "Write the report, JSON of times, counts, hash and warnings; - for standard output" },
  { names: ["-q", "--quiet"], form: "", help: "Print errors alone" },
  { names: ["--scalar"], form: "", help: "Take the module without SIMD" },
  { names: ["-h", "--help"], form: "", help: "Print this" },
  { names: ["-V", "--version"], form: "", help: "Print the version" },
];
const kFile = 4;  // exit code of a file that cannot be read or written
const kBuiltIn = /^(demo|sphere:\d+|lights:\d+)$/, kNamedSkies = ["sky", "studio", "none"];
const usage = (message) => new HalflitError(`${message}; see halflit --help`, 2);

function help() {
  const lines = ["usage: halflit MODEL [PICTURE] [FLAGS]", "Draws a model (.glb .gltf .stl .ply .obj .off .3mf), or demo, sphere:N, lights:N."];
  let group = "";
  for (const flag of [...kOwn.map((flag) => ({ group: "Program", ...flag })), ...flags]) {
    if (flag.group !== group) lines.push("", `${group = flag.group}:`);
    lines.push(`  ${[flag.names.join(","), flag.form].filter(Boolean).join(" ")}`, `      ${flag.help}`);
  }
  return lines.join("\n");
}

// {words: without flags, own: this file's flags by their long names, passed: the picture's flags}
function parsed(line) {
  const words = [], own = {}, passed = [];
  for (let i = 0; i < line.length; ++i) {
    const word = line[i];
    if (word === "--") {
      words.push(...line.slice(i + 1));
      break;
    }
    if (!word.startsWith("-") || word === "-") {
      words.push(word);
      continue;
    }
    const equals = word.startsWith("--") ? word.indexOf("=") : -1, name = equals < 0 ? word : word.slice(0, equals);
    const flag = [...kOwn, ...flags].find((one) => one.names.includes(name));
    const takes_value = !flag || flag.form !== "";  // the module tells what an unknown flag may mean
    if (takes_value && equals < 0 && flag && i + 1 === line.length) throw usage(`${name}: expected a value`);
    const value = equals >= 0 ? word.slice(equals + 1) : takes_value && flag ? line[++i] : "";
    if (kOwn.includes(flag)) own[flag.names.at(-1).slice(2)] = value || true;
    else passed.push(...(flag && takes_value ? [name, value] : [word]));
  }
  if (words[0] === "render") words.shift();
  return { words, own, passed };
}

// What the system refuses is an error of the file.
function on_file(path, work) {
  try {
    return work();
  } catch (error) {
    throw new HalflitError(`${path}: ${error.message}`, kFile);
  }
}
const read = (path) => on_file(path, () => readFileSync(path === "-" ? 0 : path));
function write(path, file) {
  if (path === "-") process.stdout.write(file);
  else on_file(path, () => writeFileSync(path, file));
}

// Files that a model names: below its folder alone, symbolic links too.
function files_beside(model) {
  const folder = on_file(model, () => realpathSync(dirname(resolve(model))));
  return (name) => {
    try {
      const place = realpathSync(resolve(folder, name)), inside = relative(folder, place);
      return inside.startsWith("..") || isAbsolute(inside) ? null : readFileSync(place);
    } catch {
      return null;
    }
  };
}

async function main(line) {
  const { words, own, passed } = parsed(line);
  if (own.help || line.length === 0) return console.log(help());
  if (own.version) return console.log(`halflit ${version} (pixel_epoch ${pixelEpoch}, WebAssembly)`);
  const [model, positional, ...rest] = words;
  if (model === undefined || rest.length > 0) throw usage(model === undefined ? "no model" : `unexpected argument ${rest[0]}`);
  const built_in = kBuiltIn.test(model);
  const output = own.output ?? positional ?? `${built_in ? "halflit" : basename(model).replace(/\.[^.]*$/, "")}.png`;
  if (own.scalar) await init({ simd: false });
  const name = built_in || model === "-" ? "model" : basename(model), environment = passed.lastIndexOf("--env");
  const options = { name: kBuiltIn.test(name) ? "model" : name, flags: passed, files: built_in || model === "-" ? {} : files_beside(model) };
  if (environment >= 0 && !kNamedSkies.includes(passed[environment + 1])) {
    options.env = read(passed[environment + 1]);
    passed.splice(environment, 2);
  }
  const scene = await load(built_in ? model : read(model), options);
  const picture = await scene.render();
  if (!own.quiet) for (const warning of picture.report.warnings) console.error(`halflit: warning: ${warning}`);
  const ending = /\.([^./]+)$/.exec(output)?.[1] ?? "";
  write(output, picture.encode(output === "-" ? "png" : ending));
  if (own.report) write(own.report, `${JSON.stringify({ ...picture.report, scene: model, output }, null, 2)}\n`);
  if (!own.quiet && output !== "-") console.error(`halflit: wrote ${output}`);
}

// One line, and a number as the exit code: the code of a system's error is a word.
function tell(error) {
  console.error(`halflit: error: ${String(error.message).split("\n")[0]}`);
  process.exitCode = Number.isInteger(error.code) ? error.code : kFile;
}

process.stdout.on("error", tell);  // whoever reads it has gone
try {
  await main(process.argv.slice(2));
} catch (error) {
  tell(error);
}
