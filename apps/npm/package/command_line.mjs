// The words of a command line by the program's rules: command, scenes and pictures, flags with their values.
import { HalflitError, any_of, kFormats } from "./engine.js";
import { flags } from "./tables.js";

export const kProgramFlags = [
  ...[
    { names: ["-o", "--output"], form: "FILE", help: `A ${any_of(kFormats, ".")} file; - for standard output (default: SCENE's name.png)` },
    { names: ["--format"], form: kFormats.join("|"), help: "Format of the picture, whatever its name" },
    { names: ["--report"], form: "FILE.json|-", help: "Write size, hash, times and counts as JSON; on failure, the error" },
  ].map((flag) => ({ ...flag, group: "Output", only: "render" })),
  ...[
    { names: ["--json"], form: "", help: "Print one JSON object" },
    { names: ["--parts"], form: "", help: "Measure each part: size, area, volume" },
  ].map((flag) => ({ ...flag, group: "Output", only: "info" })),
  { names: ["--allow-external"], form: "DIR", help: "Also allow references to files in this folder", group: "Process", repeated: true },
  { names: ["--threads"], form: "N", help: "Taken, but one thread draws; the pixels are the same", group: "Process" },
  { names: ["--scalar"], form: "", help: "Take the module without SIMD", group: "Process" },
  { names: ["-q", "--quiet"], form: "", help: "Print errors alone", group: "Process" },
];
const kCommands = ["render", "info"];
const kYes = /^(true|on|yes|enable|t|y|\+|1)$/i, kNo = /^(false|off|no|disable|n|f|-|0)$/i;
const usage = (message) => new HalflitError(message, 2);

export const table_of = (command) => [...kProgramFlags.filter((flag) => (flag.only ?? command) === command), ...flags];

// An empty argument comes from a variable that is not set.
function refuse_empty(words) {
  let flag = "";  // the one before
  for (const word of words) {
    const assigns_nothing = word.startsWith("--") && word.endsWith("=");
    const of = assigns_nothing ? word.slice(0, -1) : flag;
    if (word === "" || assigns_nothing) throw usage(`${of || "an empty argument"}: expected a value, found nothing (an empty variable?)`);
    flag = word.startsWith("-") ? word : "";
  }
}

// Without a command, the first word or a flag of `render` says that it is meant. is_scene: word => whether a scene has that name.
function command_of(words, is_scene) {
  const [first] = words;
  if (kCommands.includes(first)) return { command: first, rest: words.slice(1) };
  if (first === "--" || first === "-" || is_scene(first)) return { command: "render", rest: words };
  const is_path = /[./]/.test(first);
  if (!first.startsWith("-")) throw usage(`${is_path ? `${first}: no such scene` : `unknown command ${first}`}; see halflit --help`);
  const name = first.startsWith("--") ? first.split("=")[0] : first.slice(0, 2);
  const known = table_of("render").some((flag) => flag.names.includes(name));
  if (!known || !words.slice(1).some(is_scene)) throw usage(`unknown flag ${first}; see halflit --help`);
  return { command: "render", rest: words };
}

// {command, help, words: without flags, own: values of kProgramFlags by their long names, passed: the picture's flags}
export function parse(line, is_scene) {
  refuse_empty(line);
  if (["-h", "--help", "--help-all", "help"].includes(line[0])) return { help: true, command: null };
  if (["-V", "--version"].includes(line[0])) return { version: true };
  const { command, rest } = command_of(line, is_scene), table = table_of(command);
  const fail = (message) => usage(`${message}; see halflit ${command} --help`);
  const parsed = { command, help: false, words: [], own: {}, passed: [] }, given = new Map();
  const take = (flag, value) => {
    given.set(flag, (given.get(flag) ?? 0) + 1);
    const name = flag.names.at(-1);
    if (!kProgramFlags.includes(flag)) parsed.passed.push(...(flag.form === "" ? [name] : [name, value]));
    else if (flag.repeated) (parsed.own[name.slice(2)] ??= []).push(value);
    else parsed.own[name.slice(2)] = flag.form === "" ? true : value;
  };
  for (let i = 0; i < rest.length; ++i) {
    const word = rest[i];
    if (word === "--") {
      parsed.words.push(...rest.slice(i + 1));
      break;
    }
    if (!word.startsWith("-") || word === "-") {
      // A "-" after --json says what --json does in any case.
      const is_of_json = word === "-" && rest[i - 1] === "--json" && command === "info" && parsed.words.length > 0;
      if (!is_of_json) parsed.words.push(word);
      continue;
    }
    if (["-h", "--help", "--help-all"].includes(word)) {
      parsed.help = true;
      continue;
    }
    const long = word.startsWith("--"), equals = long ? word.indexOf("=") : -1;
    const name = !long ? word.slice(0, 2) : equals < 0 ? word : word.slice(0, equals);
    const flag = table.find((one) => one.names.includes(name));
    if (!flag) {
      parsed.unknown ??= word;
      continue;
    }
    if (flag.form === "") {
      const value = equals < 0 ? "true" : word.slice(equals + 1);
      if (!kYes.test(value) && !kNo.test(value)) throw fail(`Could not convert: ${name} = ${value}`);
      if (kYes.test(value)) take(flag);
      if (!long && word.length > 2) rest.splice(i + 1, 0, `-${word.slice(2)}`);  // -qo FILE
      continue;
    }
    const attached = equals >= 0 ? word.slice(equals + 1) : !long ? word.slice(2) : "";
    if (attached === "" && i + 1 === rest.length) throw fail(`${flag.names.at(-1)}: expected ${flag.form} after it, found nothing`);
    take(flag, attached || rest[++i]);
  }
  if (parsed.help) return parsed;
  if (parsed.unknown) throw fail(`unknown flag ${parsed.unknown}`);
  for (const [flag, count] of given)
    if (count > 1 && flag.form !== "" && !flag.repeated) throw fail(`${flag.names.at(-1)}: expected once, found ${count} times`);
  const { threads } = parsed.own;
  if (threads !== undefined && !(/^\d+$/.test(threads) && threads <= 1024))
    throw fail(`--threads: expected a whole number from 0 to 1024, found '${threads}'`);
  return parsed;
}
