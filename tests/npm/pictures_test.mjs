// Pictures of the npm package against the program's, by hash: scenes of tests/web, formats and decoders, and the models of HALFLIT_ASSETS.
import { spawnSync } from "node:child_process";
import { copyFileSync, existsSync, readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { check, end, native_hash, program, source, work, write_3mf, write_points, write_textured_model, write_webp_model } from "../web/harness.mjs";
import { begin } from "./project.mjs";

const { halflit } = await begin();
const beside = (folder) => (name) => {
  const place = join(folder, name);
  return existsSync(place) ? readFileSync(place) : null;
};
const is_built_in = (name) => /^(demo|sphere:|lights:)/.test(name);

// Hash, or the exit code where it is refused.
function native(scene, flags, folder) {
  const place = is_built_in(scene) ? scene : join(folder, scene);
  const result = spawnSync(program, [place, ...flags, "-o", "native.png", "--report", "-", "--quiet"], { cwd: work, encoding: "utf8" });
  return result.status === 0 ? JSON.parse(result.stdout).pixel_hash : `refused by ${result.status}`;
}
async function drawn(scene, flags, folder) {
  try {
    const source = is_built_in(scene) ? scene : readFileSync(join(folder, scene));
    return (await halflit.render(source, { flags, files: beside(dirname(join(folder, scene))) })).hash;
  } catch (error) {
    return error instanceof halflit.HalflitError ? `refused by ${error.code}` : String(error);
  }
}
async function same(scene, flags, folder = work) {
  const expected = native(scene, flags, folder), found = await drawn(scene, flags, folder);
  check([scene, ...flags].join(" "), found === expected, `${found}, native ${expected}`);
  return found === expected;
}

copyFileSync(join(source, "apps/examples/knot.glb"), join(work, "knot.glb"));
write_textured_model();
write_points();
write_3mf();
write_webp_model();
const scenes = readFileSync(join(source, "tests/web/scenes.txt"), "utf8").split("\n").filter((line) => line && !line.startsWith("#"));
for (const isa of ["wasm128", "scalar"]) {
  const started = await halflit.init({ simd: isa === "wasm128" });
  check(`the module is of ${isa}`, started.isa === isa, started.isa);
  for (const line of isa === "scalar" ? scenes.slice(0, 12) : scenes) {
    const [scene, ...flags] = line.split(" ");
    await same(scene, flags);
  }
  let salts = 0;
  crypto.getRandomValues = (bytes) => (++salts, Crypto.prototype.getRandomValues.call(crypto, bytes));
  await same("part.3mf", ["--size", "200x160"]);
  check("the hash tables of a 3MF file's names are salted by the host's random numbers", salts > 0, salts);
  delete crypto.getRandomValues;
  await same("card.gltf", ["--size", "200x160"]);
  await same("knot.glb", ["--size", "200x160", "--view", "iso", "--section", "x=50%", "--edges", "feature"]);
  await same("textured.gltf", ["--size", "160x120", "--highlight", "1", "--background", "transparent"]);
}

// Pictures of one scene, in an order with each kind of change, are those of scenes of their own.
await halflit.init({ simd: true });
const scene = await halflit.load(readFileSync(join(work, "knot.glb")));
const kChanges = [{ view: "iso" }, { view: "top", fit: 10 }, { view: "front", ortho: true }, { azimuth: 40 }, { view: "iso", edges: "feature" },
  { view: "iso" }, { light: "directional:dir=-1,-2,-1", noSceneLights: true }, { cameraOrbit: "30deg 60deg auto" }, { lineWidth: 3, lobe: "valve" }, { highlight: "1" }, {}];
for (const change of kChanges) {
  const options = { width: 160, height: 120, ...change };
  const [kept, alone] = [await scene.render(options).catch((error) => error), await halflit.render(readFileSync(join(work, "knot.glb")), options).catch((error) => error)];
  check(`one scene, ${JSON.stringify(change)}`, kept.hash === alone.hash && kept.message === alone.message, `${kept.hash ?? kept.message}, alone ${alone.hash ?? alone.message}`);
}
scene.free();

const assets = process.env.HALFLIT_ASSETS;
if (assets) {
  let equal = 0, count = 0;
  for (const name of readdirSync(join(assets, "models"))) {
    const folder = join(assets, "models", name);
    for (const file of readdirSync(folder, { recursive: true }).filter((path) => /\.(glb|gltf|stl|ply|obj|3mf)$/i.test(path))) {
      ++count;
      equal += (await same(file, ["--size", "160x120"], folder)) ? 1 : 0;
    }
  }
  for (const sky of readdirSync(join(assets, "environments")).filter((file) => file.endsWith(".hdr")).slice(0, 2)) {
    const place = join(assets, "environments", sky), expected = native_hash(["demo", "--size", "160x120", "--env", place]);
    const found = (await halflit.render("demo", { size: "160x120", env: readFileSync(place) })).hash;
    check(`the environment ${sky}`, found === expected, `${found}, native ${expected}`);
  }
  console.log(`${equal} of ${count} models are equal; the module has ${(await halflit.memory()) >> 20} MiB`);
} else console.log("HALFLIT_ASSETS is not set: no shared models");
end();
