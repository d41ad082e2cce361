// Pictures of MuJoCo's scenes: those of Python, byte for byte, of a scene that tests/python/mujoco_scenes.py tells; and of the simulator's own
// packages, where they are there.
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { check, end, source } from "../web/harness.mjs";
import { begin } from "./project.mjs";
import { package_folder } from "./tools.mjs";

const { halflit } = await begin();
const { MujocoRenderer, HalflitError } = halflit;
const refused = async (work) => { try { await work(); } catch (error) { return error; } return {}; };
const told = spawnSync(process.env.HALFLIT_PYTHON, [join(source, "tests/python/mujoco_scenes.py")], { encoding: "utf8", maxBuffer: 1 << 28,
  env: { ...process.env, PYTHONPATH: [join(source, "apps/python"), join(source, "tests/python")].join(":") } });
if (told.status !== 0) throw new Error(told.stderr);

// ---- a module of MuJoCo with one scene, whose members are those of mujoco-js -------------------------------------------------
const { model, size, pictures } = JSON.parse(told.stdout), { scene } = pictures[0], { flexfacenum } = scene;
const numbered = (prefix, names) => Object.fromEntries(names.map((name, i) => [prefix + name, { value: i }]));
const mujoco = {
  mj_versionString: () => "3.3.8",
  mjtGeom: { mjGEOM_LINEBOX: { value: 104 }, mjGEOM_FLEX: { value: 105 }, mjGEOM_SKIN: { value: 106 }, mjGEOM_TRIANGLE: { value: 108 } },
  mjtRndFlag: numbered("mjRND_", ["SHADOW", "WIREFRAME", "REFLECTION", "ADDITIVE", "SKYBOX", "FOG", "HAZE", "SEGMENT", "IDCOLOR", "CULL_FACE"]),
  mjtTextureRole: numbered("mjTEXROLE_", ["USER", "RGB"]),
  MjvGeom: { prototype: scene.geoms[0] }, MjvLight: { prototype: scene.lights[0] }, MjvGLCamera: { prototype: scene.camera[0] },
  MjvScene: class { flexfacenum = Int32Array.from(flexfacenum); },
};
// Its vectors give copies, which are freed.
let copies = 0;
function counted(things) {
  ++copies;
  const copy = (one) => (++copies, { ...one, delete: () => --copies });
  return { size: () => things.length, get: (i) => copy(things[i]), delete: () => --copies };
}
function vectors_of(of) {
  const made = { ...of };
  for (const name of ["geoms", "lights", "camera"]) Object.defineProperty(made, name, { get: () => counted(of[name]) });
  return made;
}

const hash = (plane) => createHash("sha256").update(new Uint8Array(plane.buffer, plane.byteOffset, plane.byteLength)).digest("hex");
const rgb = (pixels) => pixels.filter((_, i) => i % 4 !== 3);
const asked = { width: size, height: size, depth: true, segmentation: true };
for (const simd of [true, false]) {
  const { isa } = await halflit.init({ simd });
  const renderer = await MujocoRenderer.create(mujoco, model);
  for (const { scene: told, sha256 } of pictures)
    for (const [what, of] of [["arrays", told], ["vectors", vectors_of(told)]]) {
      const { picture, depth, segmentation } = renderer.render(of, asked);
      check(`colours of ${what} are those of Python (${isa})`, hash(rgb(picture.pixels)) === sha256.rgb);
      check(`so are distances (${isa})`, hash(depth) === sha256.depth);
      check(`and objects (${isa})`, hash(segmentation) === sha256.segmentation && new Set(segmentation).size > 5);
    }
  check("copies are freed", copies === 0, copies);
  renderer.free();
}
const renderer = await MujocoRenderer.create(mujoco, model, { look: "2.2.2" }), plain = renderer.render(scene, { samples: 1 });
check("colours alone, of the usual size", plain.picture.width === 320 && plain.picture.height === 240 && plain.depth === null && plain.segmentation === null);
check("they are a picture with a hash and a file", /^[0-9a-f]{16}$/.test(plain.picture.hash) && plain.picture.report.look === "2.2.2" && plain.picture.png().length > 1000);
const before = await halflit.memory();
for (let i = 0; i < 50; ++i) (await MujocoRenderer.create(mujoco, model)).free();
check("fifty renderers leave no memory behind", (await halflit.memory()) <= 1.25 * before, `${before}, ${await halflit.memory()}`);

// ---- errors -------------------------------------------------------------------------------------------------------------
const made = (changed, options) => () => MujocoRenderer.create(mujoco, { ...model, ...changed }, options);
const drawn = (changed, options) => () => renderer.render({ ...scene, ...changed }, options);
for (const [what, work, code, words] of [
  ["another release", made({}, { look: "4.0" }), 2, /^look: '4\.0', expected a release/],
  ["a look that is no text", made({}, { look: 3 }), 2, /^look: /],
  ["no model", () => MujocoRenderer.create(mujoco), 2, /MjModel/],
  ["no module", () => MujocoRenderer.create(), 2, /^MujocoRenderer.create: expected the module/],
  ["a constructor's call", () => new MujocoRenderer(mujoco, model), 2, /await MujocoRenderer.create/],
  ["an unknown option", drawn({}, { camera: "side" }), 2, /^unknown option camera: expected width, height/],
  ["half a size", drawn({}, { width: 84 }), 2, /^width and height: expected both/],
  ["a size as text", drawn({}, { width: "84", height: 84 }), 2, /found "84"$/],
  ["too few flags", drawn({ flags: [1] }), 2, /^scene: flags has 1/],
  ["a short member", drawn({ geoms: [{ ...scene.geoms[0], pos: [1, 2] }], ngeom: 1 }), 2, /^scene: geom 0: pos has 2 numbers, 3 are expected/],
  ["a member that is not there", drawn({ lights: [{ ...scene.lights[0], cutoff: undefined }] }), 2, /^scene: light 0: cutoff has no numbers/],
  ["no cameras", drawn({ camera: undefined }), 2, /^scene: /],
  ["half a geom", drawn({ ngeom: 1.5 }), 2, /^scene: ngeom: expected a count, found 1.5/],
  ["a getter that throws", () => renderer.render(Object.defineProperty({ ...scene }, "translate", { get() { throw new Error("gone\nfor good"); } })), 2, /^scene: gone$/],
  ["a scene that frees the renderer", async () => { const own = await MujocoRenderer.create(mujoco, model);
    own.render(Object.defineProperty({ ...scene }, "geoms", { get() { own.free(); return scene.geoms; } })); }, 2, /freed/],
  ["a width of 2^32", drawn({}, { width: 2 ** 32 + 64, height: 64 }), 2, /^width and height/],
  ["samples of another type", drawn({}, { samples: 4n }), 2, /^samples: expected 1 or 4/],
  ["an array that is shorter than it says", made({ mesh_vert: Object.defineProperty(new Float32Array(3), "length", { value: 12 }) }), 2, /mesh_vert/],
  ["a text as an array", made({ mesh_vert: "0".repeat(12) }), 2, /mesh_vert: expected an array/],
  ["a look of two lines", made({}, { look: "3\n3" }), 2, /^look: [^\n]*$/],
  ["a short array", made({ mesh_vert: [1, 2] }), 2, /^model: mesh_vert has 2 numbers, 12 are expected$/],
  ["no array", made({ mesh_face: undefined }), 3, /mesh_face is null/],
  ["indices out of range", made({ mesh_vertnum: [400] }), 3, /mesh 0/],
  ["a negative count", made({ nmesh: -1 }), 3, /nmesh is -1/],
  ["no scene", () => renderer.render(null), 2, /MjvScene/],
  ["half a pixel", drawn({}, { width: 1.5, height: 2 }), 2, /^width and height/],
  ["a picture that is too large", drawn({}, { width: 1 << 15, height: 1 << 15 }), 2, /picture: 32768 x 32768/],
  ["two samples", drawn({}, { samples: 2 }), 2, /^samples: expected 1 or 4, found 2$/],
  ["fewer geoms than it says", drawn({ ngeom: 99 }), 2, /^scene: geoms has 8, 99 are expected$/],
  ["no lights where some are counted", drawn({ lights: [] }), 2, /^scene: lights has 0, 1 are expected$/],
  ["a mesh that the model has not", drawn({ geoms: [{ ...scene.geoms[3], dataid: 50 }], ngeom: 1 }), 3, /geom 0/],
  ["a skin of another model", drawn({ skinvert: [1, 2, 3] }), 2, /skins or flexes/],
  ["a camera that sees nothing", drawn({ camera: scene.camera.map((one) => ({ ...one, frustum_near: 0 })) }), 2, /^camera/],
]) {
  const error = await refused(work);
  check(`${what} is refused`, error instanceof HalflitError && error.code === code && words.test(error.message), `${error.code}: ${error.message}`);
}
const before_errors = copies;
for (const changed of [{ ngeom: 99 }, { lights: [{ ...scene.lights[0], pos: null }] }]) await refused(() => renderer.render(vectors_of({ ...scene, ...changed })));
check("copies are freed after an error too", copies === before_errors, copies);
const alone = renderer.render(scene, { ...asked, rgb: false });
check("planes without colours are those with them", alone.picture === null && hash(alone.depth) === pictures[0].sha256.depth && hash(alone.segmentation) === pictures[0].sha256.segmentation);
// Memory that grows ends views of it: here, those that were given out before.
const given_out = [];
const grows = { ...scene };
Object.defineProperty(grows, "flags", { get: () => (given_out.push(Uint8Array.from(scene.flags)), given_out.at(-1)) });
Object.defineProperty(grows, "geoms", { get: () => (given_out.forEach((view) => structuredClone(null, { transfer: [view.buffer] })), scene.geoms) });
check("a view of flags that ends while geoms are read does not matter", renderer.render(grows, { samples: 1 }).picture.hash === plain.picture.hash);
check("and the next picture is drawn", renderer.render(scene, { samples: 1 }).picture.hash === plain.picture.hash);
renderer.free();
check("a freed renderer says so", /freed/.test((await refused(() => renderer.render(scene))).message));

// ---- the simulator's own packages -----------------------------------------------------------------------------------------
const kModel = `<mujoco><asset><texture name="t" type="2d" builtin="checker" width="64" height="64" rgb1=".1 .2 .3" rgb2=".4 .5 .6"/>
  <material name="m" texture="t" texrepeat="3 3" texuniform="true" reflectance=".2"/><mesh name="t" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset><worldbody>
  <light pos="0 0 3" dir="0 0 -1"/><geom type="plane" size="3 3 .1" material="m"/><geom type="box" size=".2 .3 .2" pos="-.8 .2 1"/>
  <geom type="sphere" size=".3" pos="0 0 1"/><geom type="mesh" mesh="t" pos=".8 .2 .5"/></worldbody></mujoco>`;
const hashes = [];
for (const name of ["mujoco-js", "@mujoco/mujoco"]) {
  const folder = package_folder(name);
  if (!folder) console.log(`skipped: ${name} is not in HALFLIT_NPM_TOOLS`);
  if (!folder) continue;
  const { main, exports } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
  const simulator = await (await import(pathToFileURL(join(folder, main ?? exports["."].import ?? exports["."].default)))).default();
  simulator.FS?.writeFile("/model.xml", kModel);
  const real = simulator.MjModel.loadFromXML ? simulator.MjModel.loadFromXML("/model.xml") : simulator.MjModel.from_xml_string(kModel);
  const data = new simulator.MjData(real), view = new simulator.MjvScene(real, 100), camera = new simulator.MjvCamera();
  Object.assign(camera, { distance: 4, elevation: -25, azimuth: 110 });
  simulator.mj_forward(real, data);
  simulator.mjv_updateScene(real, data, new simulator.MjvOption(), new simulator.MjvPerturb(), camera, simulator.mjtCatBit.mjCAT_ALL.value, view);
  const { picture, segmentation } = (await MujocoRenderer.create(simulator, real, { look: "3.3.3" })).render(view, asked);
  check(`${name} ${simulator.mj_versionString()}: all geoms are in the picture`, new Set(segmentation.filter((_, i) => i % 2 === 0)).size === 5);
  hashes.push(picture.hash);
}
if (hashes.length > 1) check("one look has one picture of both releases", new Set(hashes).size === 1, hashes);
end();
