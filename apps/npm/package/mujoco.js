// Pictures of scenes of the simulator MuJoCo, whose own module (mujoco-js, @mujoco/mujoco) has the model and the scene.
import { HalflitError, Picture, allocated, any_of, call, copied, kForgotten, line_of, options_of, out_of_memory, running, usage, with_text } from "./engine.js";

const kArrays = { int32: Int32Array, int64: BigInt64Array, uint8: Uint8Array, float: Float32Array, double: Float64Array };
const kStructs = { geom: "MjvGeom", light: "MjvLight", camera: "MjvGLCamera" };

const value_of_enum = (constant) => Number(constant?.value ?? constant ?? -1);

// The tables of what the library reads: [["pos", "float", "3"], ..] of "geom" and so on.
function tables_of(core) {
  const tables = {};
  for (const line of core.UTF8ToString(core._halflit_mujoco_tables()).trim().split("\n")) {
    const [table, ...row] = line.split(" ");
    (tables[table] ??= []).push(row);
  }
  return tables;
}

// Reads what is MuJoCo's or the caller's. What that throws is an error of the caller.
function read(what, work) {
  try {
    return work();
  } catch (error) {
    throw error instanceof HalflitError ? error : usage(`${what}: ${line_of(error)}`);
  }
}

// A value in a message, in one line.
const shown = (value) => typeof value === "string" ? JSON.stringify(value.slice(0, 40)) : value === null ? "null"
  : typeof value === "object" || typeof value === "function" ? `one of type ${typeof value}` : String(value);

function count_of(what, value) {
  if (!Number.isInteger(value) || value > 0x7fffffff) throw usage(`${what}: expected a count, found ${shown(value)}`);
  return value;
}

// A copy of numbers as bytes of that kind. An object's word about its length does not count, but what was copied.
function bytes_of(name, kind, values, count) {
  if (typeof values !== "object") throw usage(`${name}: expected an array of numbers`);
  const Kind = kArrays[kind], array = kind === "int64" ? Kind.from(values, BigInt) : new Kind(values);
  if (count !== undefined && !(array.length >= count)) throw usage(`${name} has ${array.length} numbers, ${count} are expected`);
  return new Uint8Array(array.buffer, 0, count === undefined ? array.byteLength : count * Kind.BYTES_PER_ELEMENT);
}

// Calls `use` with each of the first elements of an array, or of a vector of MuJoCo's module, which gives copies.
function each_of(name, vector, count, use) {
  const is_array = typeof vector.get !== "function", free = (one) => { if (!is_array) one?.delete?.(); };
  try {
    const size = is_array ? vector.length : vector.size();
    if (!(size >= count)) throw usage(`scene: ${name} has ${size}, ${count} are expected`);
    for (let i = 0; i < count; ++i) {
      const one = is_array ? vector[i] : vector.get(i);
      try {
        use(one, i);
      } finally {
        free(one);
      }
    }
  } finally {
    free(vector);
  }
}

const kOwnOptions = ["width", "height", "samples", "rgb", "depth", "segmentation"];
const kMade = Symbol("made by create()");

export class MujocoRenderer {
  #core; #handle; #tables; #structs = {}; #flags; #look; #samples;

  constructor(made, core, handle) {
    if (made !== kMade) throw usage("MujocoRenderer: expected await MujocoRenderer.create(mujoco, model)");
    this.#core = core;
    this.#handle = handle;
    this.#tables = tables_of(core);
    kForgotten?.register(this, { core, close: () => core._halflit_mujoco_close(handle) }, this);
  }

  // mujoco: MuJoCo's module, model: an MjModel.
  static async create(mujoco, model, given) {
    const look = read("MujocoRenderer.create", () => {
      if (!mujoco?.MjvScene || !model?.vis) throw usage("MujocoRenderer.create: expected the module of MuJoCo and an MjModel");
      return options_of(given).look ?? mujoco.mj_versionString?.();
    });
    if (typeof look !== "string" || !/^[\d.]{1,12}$/.test(look)) throw usage(`look: expected a release of MuJoCo, such as "3.3.3", found ${shown(look)}`);
    const core = await running(), renderer = new MujocoRenderer(kMade, core, call(core, () => core._halflit_mujoco_open()));
    try {
      read("model", () => renderer.#read(mujoco, model, look));
    } catch (error) {
      renderer.free();
      throw error;
    }
    return renderer;
  }

  #read(mujoco, model, look) {
    const core = this.#core, tables = this.#tables, places = [], sizes = [];
    for (const [table, name] of Object.entries(kStructs)) {
      const members = mujoco[name].prototype, found = [];
      let size = 0;
      for (const [short, kind, count] of tables[table]) {
        const member = [short === "scale" ? "size" : short, `frustum_${short}`].find((key) => key in members);
        places.push(member ? size : -1);
        if (!member) continue;
        found.push({ member, kind, place: size, count: Number(count) });
        size += 4 * Number(count);
      }
      sizes.push(size);
      this.#structs[table] = { found, size };
    }
    const types = tables.type.map(([name]) => value_of_enum(mujoco.mjtGeom[`mjGEOM_${name}`]));
    this.#flags = tables.flag.map(([name]) => value_of_enum(mujoco.mjtRndFlag[`mjRND_${name}`]));
    this.#look = look;
    this.#samples = model.vis.quality.offsamples > 1 ? 4 : 1;

    // mjModel does not tell how many triangles its flexes show: an MjvScene has room for them.
    const scene = new mujoco.MjvScene(model, 1);
    let facenum;
    try {
      facenum = Int32Array.from(scene.flexfacenum ?? []);
    } finally {
      scene.delete?.();
    }
    const { map, quality, global, rgba } = model.vis, groups = [model.stat, map, quality, global ?? model.vis.global_];
    const numbers = tables.number.map(([name]) => Number(groups.find((group) => name in group)?.[name] ?? NaN));
    const counts = Object.fromEntries(tables.count.map(([name]) => [name, count_of(name, Number(model[name] ?? 0))]));
    counts.ntexdata = count_of("ntexdata", Number(model.ntexdata ?? 0));
    const colors = [rgba.fog, rgba.haze].map((color) => [0, 1, 2, 3].map((k) => Number(color[k])));
    numbers.push(...Object.values(counts), ...colors.flat());
    // The geoms of @mujoco/mujoco say it themselves; its binding cannot read the array.
    const unread = "texuniform" in mujoco.MjvGeom.prototype ? "mat_texuniform" : "";
    const role = value_of_enum(mujoco.mjtTextureRole?.mjTEXROLE_RGB), held = [];
    const hold = (name, kind, values, count) => {
      const bytes = bytes_of(`model: ${name}`, kind, values, count);
      held.push(call(core, () => allocated(core, bytes.length)));
      core.HEAPU8.set(bytes, held.at(-1));
      return held.at(-1);
    };
    try {
      const pointers = tables.array.map(([name, count, kind, each]) => {
        const length = counts[count] * Number(each);
        let values = length <= 0 || name === unread ? null : name === "flex_facenum" ? facenum : model[name] ?? null;
        if (values === null) return 0;
        if (name === "mat_texid" && values.length > length) values = Array.from(values).filter((_, i) => i % (values.length / length) === role);
        return hold(name, kind, values, length);
      });
      const at = [hold("places", "int32", [...sizes, ...places, ...types]), hold("numbers", "double", numbers), hold("arrays", "int32", pointers)];
      this.#checked(call(core, () => with_text(core, look, (text) => core._halflit_mujoco_read(this.#handle, ...at, text))));
    } finally {
      if (!core.ended) held.forEach((place) => core._halflit_free(place));
    }
  }

  #checked(code) {
    if (code === 0) return;
    const core = this.#core, message = core.UTF8ToString(core._halflit_mujoco_error(this.#handle));
    if (message.includes("out of memory")) core.full = true;
    throw new HalflitError(message, code);
  }

  // Structs of a scene, as the module has them.
  #packed(table, name, vector, count) {
    const { found, size } = this.#structs[table];
    let bytes = new Uint8Array(0), whole, floats;
    each_of(name, vector, count, (one, i) => {
      if (i === 0) {
        bytes = new Uint8Array(count * size);
        whole = new Int32Array(bytes.buffer);
        floats = new Float32Array(bytes.buffer);
      }
      for (const { member, kind, place, count: width } of found) {
        const value = one[member], to = kind === "float" ? floats : whole, at = (i * size + place) / 4;
        const length = width > 1 ? value?.length : value === undefined || value === null ? undefined : 1;
        if (!(length >= width)) throw usage(`scene: ${table} ${i}: ${member} has ${length ?? "no"} numbers, ${width} are expected`);
        if (width === 1) to[at] = Number(value);
        else for (let k = 0; k < width; ++k) to[at + k] = Number(value[k]);
      }
    });
    return bytes;
  }

  // Bytes of the scene's arrays. Views of MuJoCo's memory are used at once: they end when it grows, as it may when geoms are read.
  #read_scene(scene) {
    const counts = { geoms: count_of("scene: ngeom", scene.ngeom), lights: count_of("scene: nlight", scene.nlight), camera: 2 };
    if (counts.geoms < 0 || counts.lights < 0) throw usage("scene: a count is below 0");
    const arrays = this.#tables.scene.map(([name, kind]) => {
      if (kind in kStructs) return this.#packed(kind, name, scene[name], counts[name]);
      if (name === "flags") {
        const all = bytes_of("scene: flags", kind, scene.flags, Math.max(...this.#flags) + 1);
        return Uint8Array.from(this.#flags, (place) => all[place]);
      }
      if (name === "transform") {
        const { enabletransform, scale } = scene, of = (member, count) => Array.from({ length: count }, (_, k) => Number(scene[member][k]));
        return bytes_of(name, kind, [enabletransform, ...of("translate", 3), ...of("rotate", 4), scale]);
      }
      return bytes_of(`scene: ${name}`, kind, scene[name] ?? []);
    });
    return { arrays, counts };
  }

  #put(arrays) {
    const core = this.#core;
    arrays.forEach((bytes, which) => {
      const place = call(core, () => core._halflit_mujoco_array(this.#handle, which, bytes.length));
      if (!place && bytes.length > 0) throw out_of_memory(core);
      core.HEAPU8.set(bytes, place);
    });
  }

  #live() {
    if (this.#handle === 0) throw usage("the renderer was freed");
  }

  render(scene, given) {
    const options = options_of(given), core = this.#core, unknown = Object.keys(options).find((name) => !kOwnOptions.includes(name));
    const { width = 320, height = 240, samples = this.#samples, rgb = true, depth = false, segmentation = false } = options;
    if (unknown !== undefined) throw usage(`unknown option ${unknown}: expected ${any_of(kOwnOptions)}`);
    if ((options.width === undefined) !== (options.height === undefined)) throw usage("width and height: expected both or none");
    this.#live();
    for (const side of [width, height])
      if (!Number.isInteger(side) || side < 1 || side > 0x7fffffff) throw usage(`width and height: expected whole numbers above 0, found ${shown(side)}`);
    if (samples !== 1 && samples !== 4) throw usage(`samples: expected 1 or 4, found ${shown(samples)}`);
    if (typeof scene !== "object" || scene === null) throw usage("render: expected an MjvScene");
    const { arrays, counts } = read("scene", () => this.#read_scene(scene));
    this.#live();  // what was read may have been the caller's functions
    this.#put(arrays);
    return call(core, () => {
      this.#checked(core._halflit_mujoco_draw(this.#handle, counts.geoms, counts.lights, width, height, samples, rgb ? 1 : 0, depth ? 1 : 0,
        segmentation ? 1 : 0));
      const report = () => ({ pixel_hash: core.UTF8ToString(core._halflit_mujoco_hash(this.#handle)), size: [width, height], samples, look: this.#look });
      const plane = (place, count) => copied(core, place, 4 * count).buffer, area = width * height;
      return {
        picture: rgb ? new Picture(core, width, height, core._halflit_mujoco_pixels(this.#handle), report()) : null,
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
