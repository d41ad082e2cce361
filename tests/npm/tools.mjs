// Tools of other projects that the package is tested with. HALFLIT_NPM_TOOLS is a folder where npm has installed some of them, as by
//   npm install deno bun miniflare typescript ts52@npm:typescript@5.2 @types/node mujoco-js @mujoco/mujoco vite vite5@npm:vite@5 esbuild webpack webpack-cli
// Otherwise the folders of PATH are searched.
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { delimiter, join } from "node:path";

const kSkipped = 77;
const folder = process.env.HALFLIT_NPM_TOOLS, modules = folder && join(folder, "node_modules");

// A program's path, or null.
export function tool(name) {
  const places = [...(modules ? [join(modules, ".bin")] : []), ...process.env.PATH.split(delimiter)];
  return places.map((place) => join(place, name)).find((path) => existsSync(path)) ?? null;
}

// The folder of an installed package, or null.
export const package_folder = (name) => (modules && existsSync(join(modules, name)) ? join(modules, name) : null);

// Folders of a package, of each version that is installed under a name of its own.
export function versions_of(package_name) {
  if (!modules) return [];
  const is_it = (path) => existsSync(join(path, "package.json")) && JSON.parse(readFileSync(join(path, "package.json"), "utf8")).name === package_name;
  return readdirSync(modules).map((name) => join(modules, name)).filter(is_it);
}

// Ends a test in which nothing was checked.
export function skip(what) {
  console.log(`skipped: ${what}`);
  process.exit(kSkipped);
}
