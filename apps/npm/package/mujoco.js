// Pictures of scenes of the simulator MuJoCo, whose own module (mujoco-js, @mujoco/mujoco) has the model and the scene.
import { HalflitError, Picture, allocated, call, copied, options_of, out_of_memory, running, usage, with_text } from "./engine.js";

const kArrays = { int32: Int32Array, int64: BigInt64Array, uint8: Uint8Array, float: Float32Array, double: Float64Array };
const kFlags = ["SHADOW", "WIREFRAME", "REFLECTION", "ADDITIVE", "SKYBOX", "FOG", "HAZE", "SEGMENT", "IDCOLOR", "CULL_FACE"];
const kTypes = ["SKIN", "FLEX", "LINEBOX", "TRIANGLE"];
const kStructs = { geom: "MjvGeom", light: "MjvLight", camera: "MjvGLCamera" };
// Arrays of a scene that the library reads whole, after those of geoms, lights, cameras, flags and the transformation.
const kSoft = { skinvert: "float", skinnormal: "float", flexfaceused: "int32", flexface: "float", flexnormal: "float" };
const kForgotten = typeof FinalizationRegistry === "undefined" ? null : new FinalizationRegistry(({ core, handle }) => {
  if (!core.ended) core._halflit_mujoco_close(handle);
});

const number_of = (constant) => Number(constant?.value ?? constant ?? -1);  // of an enum

// The members, numbers and arrays that the library reads.
function tables_of(core) {
  const tables = { geom: [], light: [], camera: [], number: [], count: [], array: [] };
  for (const line of core.UTF8ToString(core._halflit_mujoco_tables()).trim().split("\n")) {
    const [table, ...row] = line.split(" ");
    tables[table].push(row);
  }
  return tables;
}

// A member of a model; undefined where there is none, or where its binding has no type for it (@mujoco/mujoco: arrays of truth values).
function member_of(model, name) {
  try {
    return model[name] ?? undefined;
  } catch {
    return undefined;
  }
}

// Numbers as bytes of that kind.
function bytes_of(kind, values) {
  const Kind = kArrays[kind], array = values instanceof Kind ? values : Kind.from(values, kind === "int64" ? BigInt : Number);
  return new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
}

// Calls `use` with each of the first elements of an array, or of a vector of MuJoCo's module, whose elements are copies.
function each_of(vector, count, use) {
  const is_array = typeof vector.get !== "function", size = is_array ? vector.length : vector.size();
  if (size < count) throw usage(`scene: has ${size} geoms, lights or cameras, ${count} are expected`);
  for (let i = 0; i < count; ++i) {
    const one = is_array ? vector[i] : vector.get(i);
    use(one, i);
    if (!is_array) one.delete?.();
  }
  if (!is_array) vector.delete?.();
}

export class MujocoRenderer {
  #core; #handle; #structs = {}; #flags; #look; #samples;

  constructor(core, handle) {
    this.#core = core;
    this.#handle = handle;
    kForgotten?.register(this, { core, handle }, this);
  }

  // mujoco: MuJoCo's module, model: an MjModel.
  static async create(mujoco, model, given) {
    const { look = mujoco?.mj_versionString?.() } = options_of(given), core = await running();
    if (typeof look !== "string") throw usage("look: expected a release of MuJoCo, as \"3.3.3\"");
    if (!model?.vis || !mujoco?.MjvScene) throw usage("MujocoRenderer.create: expected the module of MuJoCo and an MjModel");
    const renderer = new MujocoRenderer(core, call(core, () => core._halflit_mujoco_open()));
    try {
      renderer.#read(mujoco, model, look);
    } catch (error) {
      renderer.free();
      throw error;
    }
    return renderer;
  }

  #read(mujoco, model, look) {
    const core = this.#core, tables = tables_of(core), places = [], sizes = [];
    for (const [table, name] of Object.entries(kStructs)) {
      const members = mujoco[name].prototype, found = [];
      let size = 0;
      for (const [short, kind, count] of tables[table]) {
        const member = [short === "scale" ? "size" : short, `frustum_${short}`].find((key) => key in members);
        places.push(member ? size : -1);
        if (member) found.push({ member, kind, place: size, count: Number(count) });
        if (member) size += 4 * Number(count);
      }
      sizes.push(size);
      this.#structs[table] = { found, size };
    }
    const types = kTypes.map((type) => number_of(mujoco.mjtGeom[`mjGEOM_${type}`]));
    this.#flags = kFlags.map((flag) => number_of(mujoco.mjtRndFlag[`mjRND_${flag}`]));
    this.#look = look;
    this.#samples = model.vis.quality.offsamples > 1 ? 4 : 1;

    // mjModel does not tell how many triangles its flexes show: an MjvScene has room for them.
    const scene = new mujoco.MjvScene(model, 1), facenum = Int32Array.from(scene.flexfacenum ?? []);
    scene.delete?.();
    const { map, quality, global, rgba } = model.vis, groups = [model.stat, map, quality, global ?? model.vis.global_];
    const numbers = tables.number.map(([name]) => Number(groups.find((group) => name in group)?.[name] ?? NaN));
    numbers.push(...tables.count.map(([name]) => Number(model[name] ?? 0)), Number(model.ntexdata), ...rgba.fog, ...rgba.haze);
    const role = number_of(mujoco.mjtTextureRole?.mjTEXROLE_RGB), held = [];
    const hold = (kind, values) => {
      const bytes = bytes_of(kind, values);
      held.push(call(core, () => allocated(core, bytes.length)));
      core.HEAPU8.set(bytes, held.at(-1));
      return held.at(-1);
    };
    try {
      const pointers = tables.array.map(([name, count, kind, each]) => {
        let values = name === "flex_facenum" ? facenum : member_of(model, name);
        const length = Number(model[count] ?? 0) * Number(each);
        if (name === "mat_texid" && values?.length > length) values = values.filter((_, i) => i % (values.length / length) === role);
        if (!(length > 0) || values === undefined) return 0;
        if (values.length < length) throw usage(`model: ${name} has ${values.length} numbers, ${length} are expected`);
        return hold(kind, values);
      });
      const at = [hold("int32", [...sizes, ...places, ...types]), hold("double", numbers), hold("int32", pointers)];
      this.#checked(call(core, () => with_text(core, look, (text) => core._halflit_mujoco_read(this.#handle, ...at, text))));
    } finally {
      if (!core.ended) held.forEach((place) => core._halflit_free(place));
    }
  }

  #checked(code) {
    if (code === 0) return;
    const core = this.#core, message = core.UTF8ToString(core._halflit_mujoco_text(this.#handle));
    if (message.includes("out of memory")) core.full = true;
    throw new HalflitError(message, code);
  }

  #put(which, bytes) {
    const core = this.#core, place = call(core, () => core._halflit_mujoco_array(this.#handle, which, bytes.length));
    if (!place && bytes.length > 0) throw out_of_memory(core);
    core.HEAPU8.set(bytes, place);
  }

  // Structs of a scene as the module has them.
  #packed(table, vector, count) {
    const { found, size } = this.#structs[table], bytes = new Uint8Array(count * size);
    const whole = new Int32Array(bytes.buffer), floats = new Float32Array(bytes.buffer);
    each_of(vector, count, (one, i) => {
      for (const { member, kind, place, count: width } of found) {
        const value = one[member], at = (i * size + place) / 4;
        if (width > 1) floats.set(value.length === width ? value : value.subarray(0, width), at);
        else if (kind === "float") floats[at] = value;
        else whole[at] = Number(value);
      }
    });
    return bytes;
  }

  render(scene, given) {
    const { width = 320, height = 240, samples = this.#samples, depth = false, segmentation = false } = options_of(given);
    if (this.#handle === 0) throw usage("the renderer was freed");
    for (const side of [width, height])
      if (!Number.isInteger(side) || side < 1) throw usage(`width and height: expected whole numbers above 0, found ${width} x ${height}`);
    if (!(scene?.ngeom >= 0 && scene.nlight >= 0)) throw usage("render: expected an MjvScene");
    const core = this.#core, { ngeom, nlight } = scene, flags = scene.flags;
    const counts = { geoms: [ngeom, "geom"], lights: [nlight, "light"], camera: [2, "camera"] };
    Object.entries(counts).forEach(([name, [count, table]], i) => this.#put(i, this.#packed(table, scene[name], count)));
    this.#put(3, Uint8Array.from(this.#flags, (place) => flags[place]));
    this.#put(4, bytes_of("float", [scene.enabletransform, ...scene.translate, ...scene.rotate, scene.scale]));
    Object.entries(kSoft).forEach(([name, kind], i) => this.#put(5 + i, bytes_of(kind, scene[name] ?? [])));
    return call(core, () => {
      this.#checked(core._halflit_mujoco_draw(this.#handle, ngeom, nlight, width, height, samples, depth ? 1 : 0, segmentation ? 1 : 0));
      const report = { pixel_hash: core.UTF8ToString(core._halflit_mujoco_text(this.#handle)), samples, look: this.#look };
      const plane = (place, count) => copied(core, place, 4 * count).buffer, area = width * height;
      return {
        picture: new Picture(core, width, height, core._halflit_mujoco_pixels(this.#handle), report),
        depth: depth ? new Float32Array(plane(core._halflit_mujoco_depth(this.#handle), area)) : null,
        segmentation: segmentation ? new Int32Array(plane(core._halflit_mujoco_segmentation(this.#handle), 2 * area)) : null,
      };
    });
  }

  free() {
    if (this.#handle === 0) return;
    kForgotten?.unregister(this);
    if (!this.#core.ended) this.#core._halflit_mujoco_close(this.#handle);
    this.#handle = 0;
  }

  [Symbol.dispose ?? Symbol.for("Symbol.dispose")]() {
    this.free();
  }
}
