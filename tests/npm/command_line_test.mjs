// The package's command line beside the program's: exit codes, standard output, files and, where they are one text, messages.
import { spawnSync } from "node:child_process";
import { copyFileSync, cpSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { check, end, program, source, work, write_textured_model } from "../web/harness.mjs";
import { begin, installed } from "./project.mjs";

await begin();
write_textured_model();
const template = join(work, "template");
mkdirSync(join(template, "models"), { recursive: true });
mkdirSync(join(template, "folder.glb"));
copyFileSync(join(source, "apps/examples/knot.glb"), join(template, "knot.glb"));
for (const name of ["textured.gltf", "textured.bin", "photo.jpg", "ball.png"]) copyFileSync(join(work, name), join(template, "models", name));
writeFileSync(join(template, "models/thief.gltf"), readFileSync(join(work, "textured.gltf"), "utf8").replace("photo.jpg", "../secret.jpg"));
copyFileSync(join(work, "photo.jpg"), join(template, "secret.jpg"));
writeFileSync(join(template, "models/poor.gltf"), readFileSync(join(work, "textured.gltf"), "utf8").replace("textured.bin", "none.bin"));
writeFileSync(join(template, "sky.pfm"), Buffer.concat([Buffer.from("PF\n8 4\n-1.0\n"), Buffer.from(new Float32Array(96).fill(0.5).buffer)]));
writeFileSync(join(template, "broken.glb"), readFileSync(join(template, "knot.glb")).subarray(0, 200));
writeFileSync(join(template, "notes.txt"), "notes");
const knot = readFileSync(join(template, "knot.glb")), kSmall = ["--size", "24x16"];

// Runs a command line in a folder of its own: {status, stdout, stderr, files: bytes by name}.
function result_of(words, line, input, name) {
  const folder = join(work, name);
  rmSync(folder, { recursive: true, force: true });
  cpSync(template, folder, { recursive: true });
  const { status, stdout, stderr } = spawnSync(words[0], [...words.slice(1), ...line], { cwd: folder, input, maxBuffer: 1 << 26 });
  const made = readdirSync(folder, { recursive: true, withFileTypes: true }).filter((one) => one.isFile())
    .map((one) => join(one.parentPath ?? one.path, one.name).slice(folder.length + 1));
  return { status, stdout, stderr: String(stderr), files: Object.fromEntries(made.sort().map((file) => [file, readFileSync(join(folder, file))])) };
}
const is_picture = (bytes) => bytes.subarray(0, 4).toString("hex") === "89504e47" || bytes.subarray(0, 2).toString("hex") === "ffd8";

// Pixels of a .png decide, as its bytes depend on the version of libdeflate. Of a report, what a machine or a clock does not change.
function same_bytes(a, b) {
  if (a.equals(b)) return true;
  if (is_picture(a) && is_picture(b)) {
    writeFileSync(join(work, "a.png"), a);
    writeFileSync(join(work, "b.png"), b);
    return spawnSync(program, ["diff", join(work, "a.png"), join(work, "b.png")]).status === 0;
  }
  try {
    const [x, y] = [a, b].map((bytes) => JSON.parse(bytes)), pick = ({ schema, status, halflit, pixel_epoch, scene, output, size, pixel_hash, samples, warnings, error }) =>
      JSON.stringify({ schema, status, halflit, pixel_epoch, scene, output, size, pixel_hash, samples, warnings, code: error?.code });
    return /^halflit\.report/.test(x.schema) && pick(x) === pick(y);
  } catch {
    return false;
  }
}

// [command line, what standard input has]. "=": the messages are the same too.
const kLines = [
  ["= demo", kSmall], ["= demo x.png", kSmall], ["= demo -o x.png", kSmall], ["= render demo x.png", kSmall], ["= demo -ox.png", kSmall], ["= -o x.png demo", kSmall],
  ["= render", kSmall], ["= knot.glb", kSmall], ["= sphere:500", kSmall], ["= knot.glb k.bmp", kSmall], ["= knot.glb k.TGA", kSmall], ["knot.glb k.jpg", kSmall],
  ["= demo a.png -o b.png", kSmall], ["demo -", kSmall], ["knot.glb - --report -", kSmall], ["= demo -o -", kSmall], ["= - x.png", kSmall, knot], ["= -", kSmall, knot],
  ["= render - -o -", kSmall, knot], ["- x.png", kSmall, ""], ["= demo -o - --report -", kSmall], ["= demo -o - --format bmp", kSmall], ["demo x.dat --format tga -o y.dat", kSmall],
  ["= demo -o y.dat --format tga", kSmall], ["demo --format gif", kSmall],
  ["= demo --quiet", kSmall], ["= demo --quiet=false", kSmall], ["= demo --quiet=true", kSmall], ["= demo --quiet=maybe", kSmall], ["= demo --quiet=", kSmall], ["= demo -q -q", kSmall],
  ["= demo -qo x.png", kSmall], ["= demo --ground=false", kSmall], ["= demo --ground", kSmall], ["= demo --report --quiet", kSmall], ["= demo --report r.json", kSmall],
  ["= demo --report -", kSmall], ["demo --report", kSmall], ["= demo --report demo.png", kSmall], ["= demo --report notes.txt", kSmall], ["none.glb --report r.json", kSmall],
  ["= knot.glb --report knot.glb", kSmall], ["= demo --env sky.pfm", kSmall], ["= demo --env none.hdr", kSmall], ["= demo --env notes.txt", kSmall], ["= demo --env folder.glb", kSmall],
  ["= demo --threads 1", kSmall], ["= demo --threads 0", kSmall], ["= demo --threads x", kSmall], ["= demo --threads 2000", kSmall],
  ["demo -- x.png", ["--size", "9x9"]], ["= -- demo x.png", []], ["= demo", [...kSmall, ""]], ["= demo", ["--size", "9x9", "--size", "8x8"]], ["= demo --samples", []],
  ["= demo --samples 3", kSmall], ["demo --sampels 4", []], ["= demo --no-such=3", []], ["demo -x", []], ["= demo -V", []],
  ["= demo --azimuth -30", kSmall], ["= demo --light point:pos=2,2,2 --light directional:dir=-1,-2,-1", kSmall],
  ["none.glb", kSmall], ["nothing", []], ["render nothing", []], ["no/folder/none.glb x.png", []], ["demo no/folder/x.png", kSmall], ["demo -o no/folder/x.png", kSmall], ["= folder.glb", kSmall],
  ["demo -o models", kSmall], ["demo x.gif", kSmall], ["demo -o x.glb", kSmall], ["a b c", []], ["demo b c", []], ["= notes.txt", kSmall], ["= broken.glb", kSmall], ["= models/photo.jpg", kSmall],
  ["demo -o notes.txt", kSmall], ["demo --timeout 0", kSmall], ["demo --max-geometry-bytes 10", kSmall], ["= knot.glb --max-geometry-bytes 10", kSmall], ["= demo --size 0x4", []], ["sphere:10", kSmall],
  ["= models/textured.gltf", kSmall], ["= ./models/../models/textured.gltf t.png", kSmall], ["models/thief.gltf", kSmall], ["= models/thief.gltf --allow-external .", kSmall],
  ["models/poor.gltf", kSmall], ["models/poor.gltf --strict", kSmall], ["models/thief.gltf --strict", kSmall],
  ["", []], ["info", []], ["= info demo", kSmall], ["= info knot.glb", kSmall], ["= info knot.glb --json", kSmall], ["= info knot.glb --json -", kSmall], ["= info --parts models/textured.gltf", []],
  ["= info --json --parts demo", []], ["= info - --json", [], knot], ["= info x y", []], ["info none.glb", []], ["= info demo -o x.png", []], ["= info demo --size 0x0", []], ["info nothing", []],
  ["--quiet", []], ["--sizes 3 demo", []], ["= demo --samples=", kSmall],
];
// Most of a small picture's time is the compiler's.
const npm_words = [process.execPath, "--liftoff-only", "--wasm-lazy-compilation", join(installed, "cli.mjs")];
for (const [text, more, input = ""] of kLines) {
  const all_same = text.startsWith("= "), line = [...text.replace(/^= /, "").split(" ").filter(Boolean), ...more];
  const ours = result_of(npm_words, line, input, "ours"), theirs = result_of([program], line, input, "theirs"), found = [];
  if (ours.status !== theirs.status) found.push(`exit code ${ours.status}, the program's ${theirs.status}`);
  if (!same_bytes(ours.stdout, theirs.stdout)) found.push(`standard output "${ours.stdout.subarray(0, 200)}", the program's "${theirs.stdout.subarray(0, 200)}"`);
  const names = [Object.keys(ours.files), Object.keys(theirs.files)].map(String);
  if (names[0] !== names[1]) found.push(`files ${names[0]}, the program's ${names[1]}`);
  for (const [name, bytes] of Object.entries(ours.files))
    if (theirs.files[name] && !same_bytes(bytes, theirs.files[name])) found.push(`${name} is another file`);
  const lines = (message) => message.split("\n").length;
  if (all_same ? ours.stderr !== theirs.stderr : lines(ours.stderr) !== lines(theirs.stderr)) found.push(`"${ours.stderr.trim()}", the program's "${theirs.stderr.trim()}"`);
  check(`halflit ${line.join(" ")}: as the program`, found.length === 0, found.join("; "));
}

// Whoever reads the standard output leaves.
for (const line of ["demo -o -", "demo --report -", "demo -o - --format bmp", "info demo --json --parts"]) {
  const { status, stderr } = spawnSync("bash", ["-c", `set -o pipefail; "$@" ${line} --size 800x600 -q | true`, "_", ...npm_words], { cwd: work, encoding: "utf8" });
  check(`halflit ${line} says nothing when its reader leaves`, [0, 4].includes(status) && stderr === "", `${status}: ${stderr}`);
}
const full = spawnSync("bash", ["-c", `"$@" demo -o - --size 16x16 >/dev/full`, "_", ...npm_words], { encoding: "utf8" });
check("a full disk is an error of the standard output", full.status === 4 && full.stderr === "halflit: error: standard output: No space left on device\n", full.stderr);
for (const line of [["--help"], ["info", "--help"], ["demo", "-h", "--sampels"]]) {
  const { status, stdout } = spawnSync(npm_words[0], [...npm_words.slice(1), ...line], { encoding: "utf8" });
  check(`halflit ${line.join(" ")} prints help`, status === 0 && /Usage: halflit/.test(stdout) && /--max-error CODES/.test(stdout));
}
check("--version tells the module", /^halflit \S+ \(pixel_epoch \d+, WebAssembly\)\n$/.test(spawnSync(npm_words[0], [...npm_words.slice(1), "--version"], { encoding: "utf8" }).stdout));
end();
