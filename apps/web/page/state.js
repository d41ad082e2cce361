// The page's state as one flat record, and its two other forms: the flags of `halflit render`, and the part of a link after the #.
// kLibrary holds the library's own tables (assemble.mjs).
const kDefaults = {
  scene: "demo", size: "640x360", samples: 4, view: "", time: 0, up: "y",
  lobe: "", wrap: kLibrary.usual_wrap, power: "", normalize: false,
  specular: "blinn", specular_normalize: true,
  scene_lights: true, lights: "", shadows: "soft-split", sun_size: 0, sky_shadows: 1,
  env: "", rotate: 0, show_env: false, sh_order: 0,
  exposure: 0, tonemap: "neutral", budget: 0, ground: false,
};

const lobe_model = (name) => kLibrary.lobes.find((lobe) => lobe.name === name);
const power_of = (model, wrap) => model.power + model.power_per_wrap * wrap;

// {wrap, power, normalize} of the lobe that a state chooses; null: materials have their own.
function lobe_of(state) {
  const model = lobe_model(state.lobe);
  if (!model) return null;
  const wrap = model.takes_wrap ? state.wrap : model.wrap;
  return { wrap, power: state.power === "" ? power_of(model, wrap) : state.power, normalize: model.normalize || state.normalize };
}

// Stops above the exposure that is chosen, as --exposure takes them.
const exposure_text = (stops) => (stops === 0 ? "auto" : `auto${stops > 0 ? "+" : ""}${digits(stops)}`);

// Six digits: the picture is drawn from the same text that the command line shows.
const digits = (x, count = 6) => (Math.abs(x) < 1e-12 ? "0" : String(Number(Number(x).toPrecision(count))));

// "1 light", "2 lights".
const counted = (count, word) => `${typeof count === "number" ? count.toLocaleString("en") : count} ${word}${Number(count) === 1 ? "" : "s"}`;

// "azimuth,elevation,intensity,colour;.." of lights that were added.
function lights_of(state) {
  return state.lights ? state.lights.split(";").map((text) => {
    const [azimuth, elevation, intensity, color] = text.split(",");
    return { azimuth: +azimuth || 0, elevation: +elevation || 0, intensity: intensity === undefined ? 1 : +intensity || 0, color: color || "#ffffff" };
  }) : [];
}

function lights_text(lights) {
  return lights.map((l) => [l.azimuth, l.elevation, l.intensity, l.color].join(",")).join(";");
}

// Quarter turns that take an axis of the file, which points up, to +y, and back.
const kUpright = { x: ([x, y, z]) => [-y, x, z], y: (v) => v, z: ([x, y, z]) => [x, z, -y],
  "-x": ([x, y, z]) => [y, -x, z], "-y": ([x, y, z]) => [x, -y, -z], "-z": ([x, y, z]) => [x, -z, y] };
const kBack = { ...kUpright, x: kUpright["-x"], z: kUpright["-z"], "-x": kUpright.x, "-z": kUpright.z };

// Angles go by the model's up.
function light_flag(light, up) {
  const az = (light.azimuth * Math.PI) / 180, el = (light.elevation * Math.PI) / 180;
  const from = [Math.sin(az) * Math.cos(el), Math.sin(el), Math.cos(az) * Math.cos(el)];
  const direction = kBack[up](from).map((x) => digits(Math.round(-x * 1e4) / 1e4)).join(",");
  return `directional:dir=${direction}:color=${light.color}:intensity=${digits(light.intensity)}`;
}

// "px,py,pz,tx,ty,tz,fov" of a view that was turned; empty: the scene's own.
function view_of(state) {
  const n = state.view ? state.view.split(",").map(Number) : [];
  return n.length === 7 && n.every(Number.isFinite) ? { position: n.slice(0, 3), target: n.slice(3, 6), fov: n[6] } : null;
}

// Coordinates are rounded to a millionth of the view's distance, however far from the origin they are.
function view_text(view) {
  const distance = Math.hypot(...view.position.map((x, i) => x - view.target[i])) || 1;
  const decimals = Math.max(0, Math.min(100, 6 - Math.floor(Math.log10(distance))));
  return [...[...view.position, ...view.target].map((x) => Number(x.toFixed(decimals))), digits(view.fov)].join(",");
}

// A file's name in a command line, where a word that begins with - would be a flag.
const file_word = (name) => (name.startsWith("-") ? `./${name}` : name);

// The words after `halflit SCENE`.
function flags_of(state) {
  const flags = ["--size", state.size];
  const add = (flag, value) => flags.push(flag, String(value));
  if (state.samples != kDefaults.samples) add("--samples", state.samples);
  const view = view_of(state);
  if (view) {
    add("--camera-position", view.position.join(","));
    add("--camera-target", view.target.join(","));
    add("--fov", digits(view.fov));
  }
  if (state.time > 0) add("--time", digits(state.time));
  if (state.lobe) {
    add("--lobe", state.lobe);
    if (lobe_model(state.lobe).takes_wrap) add("--wrap", digits(state.wrap));
    if (state.power !== "") add("--power", digits(state.power));
    if (state.normalize) flags.push("--normalize");
    add("--own-lobes", "off");
  }
  if (state.specular !== kDefaults.specular) add("--specular", state.specular);
  if (!state.specular_normalize) add("--specular-normalize", "off");
  if (!state.scene_lights) flags.push("--no-scene-lights");
  for (const light of lights_of(state)) add("--light", light_flag(light, state.up));
  if (state.shadows !== kDefaults.shadows) add("--shadows", state.shadows);
  if (state.sun_size > 0) add("--sun-size", digits(state.sun_size));
  if (state.sky_shadows !== 1) add("--sky-shadows", state.sky_shadows);
  if (state.env) add("--env", file_word(state.env));
  if (state.rotate != 0) add("--env-rotate", digits(state.rotate));
  if (state.show_env) add("--background", "environment");
  if (state.sh_order > 0) add("--sh-order", state.sh_order);
  if (state.exposure !== 0) add("--exposure", exposure_text(state.exposure));
  if (state.tonemap !== kDefaults.tonemap) add("--tonemap", state.tonemap);
  if (state.budget > 0) add("--max-error", digits(state.budget));
  if (state.ground) flags.push("--ground");
  return flags;
}

function shell_word(word) {
  return /^[A-Za-z0-9_.,:=\/+@%-][A-Za-z0-9_.,:=\/+@%#-]*$/.test(word) ? word : `'${word.replace(/'/g, `'\\''`)}'`;
}

// Name of the picture's file, without its ending.
const stem_of = (scene) => scene.replace(/^.*\//s, "").replace(/\.[^.]*$/, "").replace(/:/g, "-");

function command_of(state) {
  return ["halflit", file_word(state.scene), ...flags_of(state), "-o", file_word(`${stem_of(state.scene)}.png`)].map(shell_word).join(" ");
}

function link_of(state) {
  const query = new URLSearchParams();
  for (const key of Object.keys(kDefaults)) if (state[key] !== kDefaults[key]) query.set(key, String(state[key]));
  return query.toString().replace(/%2C/g, ",").replace(/%3A/g, ":");
}

// Texts that a link may give; the others are free. Control characters are refused in all of them.
const kAllowed = {
  size: (text) => /^\d+(x\d+)?$/.test(text),
  up: (text) => Object.hasOwn(kUpright, text),
  lobe: (text) => text === "" || lobe_model(text) !== undefined,
  specular: (text) => kLibrary.specular.includes(text),
  shadows: (text) => kLibrary.shadows.includes(text),
  tonemap: (text) => kLibrary.tonemap.includes(text),
  env: (text) => ["", "studio", "sky", "none"].includes(text) || kSkyName.test(text),
  lights: (text) => lights_of({ lights: text }).every((light) => /^#[0-9a-f]{6}$/i.test(light.color)),
};
const kNumberOrEmpty = ["power"];

// The state of a link, which anybody may have written: what is not allowed has its default.
function state_of_link(text) {
  const state = { ...kDefaults };
  for (const [key, value] of new URLSearchParams(text)) {
    if (!Object.hasOwn(kDefaults, key) || /[\x00-\x1f\x7f]/.test(value)) continue;
    const kind = typeof kDefaults[key];
    if (kind === "boolean") state[key] = value === "true";
    else if (kind === "number" || (kNumberOrEmpty.includes(key) && value !== "")) state[key] = Number.isFinite(+value) ? +value : kDefaults[key];
    else if (!Object.hasOwn(kAllowed, key) || kAllowed[key](value)) state[key] = value;
  }
  return state;
}
