// Shared by the tests of the npm package. They are called as node TEST.mjs PROGRAM WEB_BUILD SOURCE_FOLDER WORK_FOLDER.
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { source, work } from "../web/harness.mjs";

const build = resolve(process.argv[3]);
const libraries = join(source, "build/web-sources");
const kSkipped = 77;
export const project = join(work, "project"), installed = join(project, "node_modules/halflit");

// A command's {status, stdout, stderr} in the project.
export const command = (words, options = {}) => spawnSync(words[0], words.slice(1), { cwd: project, encoding: "utf8", maxBuffer: 1 << 28, ...options });

export function must(words, options) {
  const result = command(words, options);
  if (result.status !== 0) throw new Error(`${words.join(" ")}: ${result.stderr}${result.stdout}`);
  return result.stdout;
}

// Installs the package's tarball into an empty project. Returns the tarball's size and what the package exports.
export async function begin() {
  if (!existsSync(join(build, "bin/halflit_module.wasm"))) {
    console.log("skipped: the package was not built, as Emscripten or the sources of the libraries are not there");
    process.exit(kSkipped);
  }
  rmSync(work, { recursive: true, force: true });
  mkdirSync(project, { recursive: true });
  const tarball = must([join(source, "apps/npm/make_tarball.sh"), source, build, libraries, work]).trim();
  writeFileSync(join(project, "package.json"), JSON.stringify({ name: "empty", private: true, type: "module" }));
  must(["npm", "install", "--offline", "--no-audit", "--no-fund", tarball]);
  return { bytes: statSync(tarball).size, halflit: await import(pathToFileURL(join(installed, "node.js"))) };
}

