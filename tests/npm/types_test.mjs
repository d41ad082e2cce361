// The package's types, by each TypeScript that is there: without DOM, with it and with those of Node.js, by both ways to find modules.
import { readFileSync, symlinkSync, mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { check, end } from "../web/harness.mjs";
import { begin, command, project } from "./project.mjs";
import { package_folder, skip, versions_of } from "./tools.mjs";

const found = versions_of("typescript");
if (found.length === 0) skip("there is no TypeScript in HALFLIT_NPM_TOOLS");
await begin();

const kCommon = `import { HalflitError, MujocoRenderer, init, load, render, type Picture, type RenderOptions } from "halflit";
const options: RenderOptions = { width: 320, height: 240, view: "iso", samples: 8, shadows: "hard", ownLobes: false, light: ["a", "b"], cameraPosition: [1, 2, 3], ground: true, maxError: 0.5 };
const files = { "a.bin": new ArrayBuffer(3), "b.txt": "text", "c.png": null };
const picture: Picture = await render(new Uint8Array(1), { ...options, files: async (name: string) => new TextLike(name).bytes() });
class TextLike { constructor(readonly text: string) {} bytes(): ArrayBuffer { return new ArrayBuffer(this.text.length); } }
const pixels: Uint8ClampedArray = picture.pixels, file: Uint8Array = picture.png(), buffer: ArrayBuffer = new Uint8Array(file).buffer;
{
  using scene = await load("sphere:100", { files });
  const triangles: number = (await scene.info({ parts: true })).drawn.triangles_drawn, text: string = await scene.describe({ json: true });
  // @ts-expect-error: no such option
  await scene.render({ sampels: 3 });
  // @ts-expect-error: no such shadows
  await scene.render({ shadows: "purple" });
  await scene.render(null);
}
declare const mujoco: { MjvScene: object }, model: { vis: object; stat: object }, view: { ngeom: number; nlight: number; geoms: object; lights: object; camera: object; flags: object };
const renderer = await MujocoRenderer.create(mujoco, model, { look: "3.3.3" }), { depth, picture: colors } = renderer.render(view, { width: 84, height: 84, depth: true });
const nearest: number | undefined = depth[0], look: string = colors.report.look;
renderer.render(view).picture.png();
renderer.render(view, {}).picture.png();
const nothing: null = renderer.render(view, { rgb: false }).picture;
// @ts-expect-error: 1 or 4
renderer.render(view, { samples: 2 });
// @ts-expect-error: it may not be there
renderer.render(view).segmentation.length;
// @ts-expect-error: in the other order
await MujocoRenderer.create(model, mujoco);
// @ts-expect-error: the name of a file is not its bytes
await load("model.glb");
// @ts-expect-error: a picture has no such file
picture.encode("pfm");
if (new HalflitError("", 5).code === 5) await init({ simd: false, wasm: new Uint8Array(3) });
export { pixels, file, buffer, nearest, look, nothing };
`;
// A script of CommonJS.
const kScript = `import { render } from "halflit";
async function draw(): Promise<Uint8Array> { return (await render("demo", { width: 32, height: 32 })).png(); }
export = draw;
`;
const kOfDom = `import { init, render } from "halflit";
const picture = await render(await fetch("model.glb"), { files: (name) => fetch(name) });
await render(new Blob([picture.png()]));
const answer = new Response(picture.png()), image = new ImageData(picture.pixels, picture.width, picture.height);
await init({ wasm: new WebAssembly.Module(picture.png()), wasm128: fetch("halflit_wasm128.wasm") });
export { answer, image };
`;
const kOfNode = `import { readFile, writeFile } from "node:fs/promises";
import { init, render } from "halflit/core";
await init({ wasm: readFile("halflit.wasm"), wasm128: await readFile("halflit_wasm128.wasm") });
const picture = await render(await readFile("model.glb"), { files: (name) => readFile(name), env: await readFile("sky.hdr") });
await writeFile("model.png", picture.png());
const answer = new Response(picture.png());
export { answer };
`;
const of_node = package_folder("@types/node");
if (of_node) {
  mkdirSync(join(project, "node_modules/@types"), { recursive: true });
  symlinkSync(of_node, join(project, "node_modules/@types/node"));
  symlinkSync(join(of_node, "../../undici-types"), join(project, "node_modules/undici-types"));
} else console.log("skipped: the types of Node.js are not there");
writeFileSync(join(project, "common.ts"), kCommon);
writeFileSync(join(project, "script.cts"), kScript);
writeFileSync(join(project, "dom.ts"), kOfDom);
writeFileSync(join(project, "node.ts"), kOfNode);
// lib, types, sources
const kCases = [["ES2022 alone", ["es2022"], [], ["common.ts"]], ["the DOM", ["es2022", "dom"], [], ["common.ts", "dom.ts"]],
  ...(of_node ? [["Node.js", ["es2022"], ["node"], ["common.ts", "node.ts"]]] : [])];
for (const folder of found) {
  const { version } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
  for (const [what, lib, types, files] of kCases)
    for (const [module, moduleResolution] of [["node16", "node16"], ["nodenext", "nodenext"], ["esnext", "bundler"]]) {
      const compilerOptions = { noEmit: true, strict: true, exactOptionalPropertyTypes: true, target: "es2022", module, moduleResolution, lib, types };
      writeFileSync(join(project, "tsconfig.json"), JSON.stringify({ compilerOptions, files: module === "esnext" ? files : [...files, "script.cts"] }));
      const { status, stdout } = command([process.execPath, join(folder, "bin/tsc"), "--pretty", "false"]);
      const errors = stdout.split("\n").filter((line) => /error TS/.test(line) && !line.includes("node_modules/@types/"));  // theirs are not this package's
      check(`TypeScript ${version}, ${what}, ${moduleResolution}: the types are right`, errors.length === 0 && (status === 0 || stdout.includes("@types/")), errors.join("\n"));
    }
}
end();
