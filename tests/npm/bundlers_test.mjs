// Bundlers find the package's code: Vite's build and server, webpack, esbuild. Each one's page draws in headless Chromium, where there is one.
import { createServer } from "node:http";
import { existsSync, mkdirSync, readFileSync, readdirSync, symlinkSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { check, end, native_hash } from "../web/harness.mjs";
import { Page, find_chromium } from "../web/chromium.mjs";
import { begin, project } from "./project.mjs";
import { package_folder, skip, versions_of } from "./tools.mjs";

const kTypes = { html: "text/html", js: "text/javascript", mjs: "text/javascript", wasm: "application/wasm" };
const found = Object.fromEntries(["webpack", "esbuild"].map((name) => [name, package_folder(name)]));
if (!Object.values(found).some(Boolean) && versions_of("vite").length === 0) skip("there is no bundler in HALFLIT_NPM_TOOLS");
if (!find_chromium()) skip("there is no Chromium");
await begin();
const expected = native_hash(["demo", "--size", "64x48"]);
const kDraw = `const { hash, report } = await render("demo", { width: 64, height: 48 }); window.drawn = hash + " " + report.isa;`;
const kPage = (script) => `<!doctype html><title>halflit</title><link rel="icon" href="data:,"><script type="module" src="${script}"></script>`;

// An application in a folder of its own beside the installed package.
function application(name, script, sources = "") {
  const folder = join(project, name);
  mkdirSync(join(folder, "dist"), { recursive: true });
  writeFileSync(join(folder, "package.json"), JSON.stringify({ name, private: true, type: "module", dependencies: { halflit: "*" } }));
  writeFileSync(join(folder, "main.js"), sources || `import { render } from "halflit";\n${kDraw}\n`);
  writeFileSync(join(folder, "index.html"), kPage(script));
  symlinkSync(join(project, "node_modules"), join(folder, "node_modules"));
  return folder;
}

// Returns what a page says that it has drawn, or what went wrong.
async function drawn_at(address) {
  const page = await Page.open(address);
  try {
    for (let i = 0; i < 400; ++i) {
      const drawn = await page.value("window.drawn ?? null");
      if (drawn) return drawn;
      if (page.faults.length > 0) return String(page.faults);
      await new Promise((done) => setTimeout(done, 50));
    }
    return "nothing was drawn";
  } finally {
    await page.close();
  }
}

async function drawn_from(folder) {
  const server = createServer((request, response) => {
    const path = join(folder, new URL(request.url, "http://localhost").pathname.replace(/\/$/, "/index.html"));
    if (!existsSync(path)) return response.writeHead(404).end();
    response.writeHead(200, { "content-type": kTypes[path.split(".").at(-1)] ?? "text/plain" }).end(readFileSync(path));
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  try {
    return await drawn_at(`http://127.0.0.1:${server.address().port}/`);
  } finally {
    server.close();
    server.closeAllConnections();
  }
}
const check_drawn = (what, drawn) => check(what, drawn === `${expected} wasm128`, drawn);
const of_tool = (folder) => createRequire(join(folder, "package.json"));
const module_of = (folder) => import(of_tool(folder).resolve(folder));

// Vite before version 8 moves packages to another folder for its server, unless they are excluded.
for (const folder of versions_of("vite")) {
  const { build, createServer: serve, version } = await import(join(folder, "dist/node/index.js")), moves = parseInt(version, 10) < 8;
  const root = application(`vite_${version}`, "/main.js"), quiet = { root, configFile: false, logLevel: "error" };
  await build({ ...quiet, build: { target: "es2022" } });
  check_drawn(`Vite ${version}: its build draws`, await drawn_from(join(root, "dist")));
  for (const exclude of moves ? [["halflit"]] : [[], ["halflit"]]) {
    const server = await serve({ ...quiet, cacheDir: join(root, `cache${exclude}`), server: { port: 0, host: "127.0.0.1", fs: { strict: false } }, optimizeDeps: { exclude } });
    await server.listen();
    check_drawn(`Vite ${version}: its server draws${exclude.length > 0 ? " with optimizeDeps.exclude" : ""}`, await drawn_at(server.resolvedUrls.local[0]));
    await server.close();
  }
}

if (found.webpack) {
  const webpack = of_tool(found.webpack)(found.webpack), root = application("webpack", "/main.js");
  const failed = await new Promise((done) => webpack({ mode: "production", target: "web", context: root, entry: "./main.js", experiments: { topLevelAwait: true },
    output: { path: join(root, "dist"), filename: "main.js", publicPath: "auto", module: false }, performance: false },
  (error, stats) => done(error ? String(error) : stats.hasErrors() ? stats.toString("errors-only") : "")));
  writeFileSync(join(root, "dist/index.html"), kPage("/main.js"));
  check_drawn(`webpack ${webpack.version}: its build draws`, failed || await drawn_from(join(root, "dist")));
} else console.log("skipped: there is no webpack");

if (found.esbuild) {
  const esbuild = await module_of(found.esbuild), { build, version } = esbuild.default ?? esbuild;
  const by_core = `import { init, render } from "halflit/core"; import wasm from "halflit/halflit.wasm"; import wasm128 from "halflit/halflit_wasm128.wasm";\n`;
  for (const [loader, code] of [["file", "await init({ wasm: fetch(wasm), wasm128: fetch(wasm128) });"], ["binary", "await init({ wasm, wasm128 });"]]) {
    const root = application(`esbuild_${loader}`, "/main.js", `${by_core}${code}\n${kDraw}\n`);
    await build({ entryPoints: [join(root, "main.js")], bundle: true, format: "esm", loader: { ".wasm": loader }, outdir: join(root, "dist"), publicPath: "/", logLevel: "error" });
    writeFileSync(join(root, "dist/index.html"), kPage("/main.js"));
    check_drawn(`esbuild ${version}: its bundle with the loader "${loader}" draws`, await drawn_from(join(root, "dist")));
  }
  const root = application("esbuild_beside", "/main.js");
  await build({ entryPoints: [join(root, "main.js")], bundle: true, format: "esm", outdir: join(root, "dist"), logLevel: "error" });
  for (const name of ["halflit.wasm", "halflit_wasm128.wasm"]) writeFileSync(join(root, "dist", name), readFileSync(join(project, "node_modules/halflit", name)));
  writeFileSync(join(root, "dist/index.html"), kPage("/main.js"));
  check_drawn(`esbuild ${version}: its bundle draws with the .wasm files copied beside it`, await drawn_from(join(root, "dist")));
} else console.log("skipped: there is no esbuild");
end();
