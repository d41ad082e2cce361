// The page: one state, and what follows from it.
const $ = (id) => document.getElementById(id);
let state = state_of_link(location.hash.slice(1));
let shown = null;        // answer of the last picture
let files = [];          // that were dropped
let engine = null, comparer = null;
let heat = false, heat_of = "";
let waiting = false, drawing = false, settle_timer = 0, link_timer = 0, turning = false;
let frame_ms = [];       // of the last pictures while the view turns
let busy_timer = 0, marked = false;
let calm = false;        // the state differs from the last one by its view or samples alone
const kBusyAfter = 150, kBusyAfterMotion = 1000;  // ms from which a picture in the making shows

function fail_with(message) {
  $("error").textContent = message;
  $("error").hidden = !message;
  $("loading").hidden = true;
}

// Marks the picture as an older one when the next one takes long, so that quick ones do not flicker. Its hash goes.
function begin_busy(words, after = kBusyAfter) {
  clearTimeout(busy_timer);
  busy_timer = setTimeout(() => {
    marked = true;
    $("stage").setAttribute("aria-busy", "true");
    $("stage").classList.add("old");
    $("facts").textContent = $("notes").textContent = "";
    show_task(words);
  }, marked ? 0 : after);
}

function end_busy() {
  clearTimeout(busy_timer);
  marked = false;
  $("stage").setAttribute("aria-busy", "false");
  $("stage").classList.remove("old");
  show_task(comparer ? "comparing with the reference" : "");
}

// The words on the picture; none while it says that the library loads.
function show_task(words) {
  $("busy").hidden = !words || !$("loading").hidden;
  $("busy").textContent = words;
}

// An engine that has the files.
function new_engine() {
  const made = new Engine($("module").value);
  made.started.then(({ isa }) => {
    if (isa !== "scalar" || $("module").value === "scalar") return;
    $("module").value = "scalar";  // the browser has no SIMD
    $("module").disabled = true;
  });
  if (files.length) made.ask("files", { files });
  return made;
}

function picture_engine() {
  if (!engine || engine.ended) engine = new_engine();
  return engine;
}

// While the view turns, pictures have one sample.
function flags_now() {
  return flags_of(turning ? { ...state, samples: 1, budget: 0 } : state);
}

function fit_command() {
  $("command").style.height = "auto";
  $("command").style.height = `${$("command").scrollHeight + 2}px`;
}

async function draw_picture() {
  const start = performance.now(), flags = flags_now(), scene = state.scene;
  const answer = await picture_engine().ask("draw", { scene, flags });
  if (answer.stopped) return;
  if (answer.error) {
    const missing = !/^(demo|sphere:|lights:)/.test(scene) && !files.some((file) => file.name === scene);
    throw new Error(missing ? `${scene}: drop this file to see what the link shows` : answer.error);
  }
  fail_with("");
  const canvas = $("picture");
  if (canvas.width !== answer.width || canvas.height !== answer.height) Object.assign(canvas, { width: answer.width, height: answer.height });
  canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(answer.pixels), answer.width, answer.height), 0, 0);
  frame_ms = turning ? [...frame_ms.slice(-9), performance.now() - start] : [];
  shown = { ...answer, scene, flags };
  const { up } = answer.report.view;
  if (up !== state.up && scene === state.scene) {
    state = { ...state, up };
    if (state.lights) set_state(state);
  }
  if (!marked) say_facts();
  show_lobes();
}

// Where the state has no picture, the last one stays, and says so.
function keep_old_picture() {
  $("stage").classList.toggle("old", shown !== null);
  $("facts").textContent = shown ? `the picture is still that of ${shown.scene}` : "";
  $("notes").textContent = "";
}

function say_facts() {
  const { report } = shown, mean = frame_ms.reduce((a, b) => a + b, 0) / (frame_ms.length || 1);
  const parts = [`${report.render_ms.toFixed(0)} ms`, `${report.isa}, one thread`, counted(report.triangles, "triangle"), counted(report.lights, "light")];
  if (report.bands) parts.push(report.bands > 10 ? "a map of 64 bands" : counted(report.bands, "band"));
  if (turning) parts.push(`${counted((1000 / mean).toFixed(0), "picture")} a second, 1 sample`);
  else parts.push(`hash ${report.pixel_hash}`);
  if (state.budget > 0 && !turning) parts.push(`error proven below ${counted(digits(report.bound, 3), "code")}`);
  $("facts").setAttribute("aria-live", turning ? "off" : "polite");
  $("facts").textContent = parts.join(" · ");
  $("notes").textContent = [...report.choices, ...report.warnings].join(" · ");
  const end = Math.max(0, ...report.animations.map((a) => a.end));
  form.querySelector('label[data-for="time"]').hidden = !(end > 0);
  form.time.max = end || 1;
  form.time.step = (end || 1) / 200;
}

async function show_lobes() {
  if (!$("plots").open) return;
  const bands = state.sh_order || Math.min(shown.report.bands, 10) || 3, lobe = lobe_of(state);
  const wanted = lobe ? [lobe] : shown.report.lobes.slice(0, 8), asked = picture_engine();
  const answers = await Promise.all(wanted.map((task) => asked.ask("lobe", { ...task, bands })));
  const curves = answers.map((answer) => answer.report).filter((report) => report && !report.error);
  if (curves.length === 0) return;
  draw_curves($("curve"), curves, bands, curves.length === 1);
  const last = curves[curves.length - 1];
  draw_bands($("bands"), last.bands, bands);
  $("series_name").textContent = curves.length === 1 ? `${counted(bands, "band")}, off by ${last.sup === null ? "over 1" : digits(last.sup, 2)}` : "series (choose a model)";
}

function stop_comparing() {
  comparer?.stop();
  comparer = null;
  if (!marked) show_task("");
}

async function compare_picture() {
  const task = { scene: state.scene, flags: flags_of(state) }, key = [task.scene, ...task.flags].join("\n");
  if (!heat || heat_of === key) return;
  heat_of = key;
  stop_comparing();  // one that is no longer wanted
  try {
    const own = (comparer = new_engine());
    show_task("comparing with the reference");
    const answer = await own.ask("compare", task);
    if (own !== comparer) return;
    stop_comparing();
    if (answer.error) fail_with(answer.error);
    else show_heat(answer);
  } catch (error) {
    stop_comparing();
    fail_with(`the page cannot compare: ${error.message}`);
  }
}

function show_heat(answer) {
  const canvas = $("heat"), { max, mean, p999 } = answer.report;
  Object.assign(canvas, { width: answer.width, height: answer.height });
  canvas.getContext("2d").putImageData(heat_picture(new Uint8Array(answer.pixels), answer.width, answer.height), 0, 0);
  canvas.hidden = $("legend").hidden = false;
  $("ramp_most").textContent = `0 to ${counted(digits(max, 2), "code")}, mean ${digits(mean, 2)}`;
  $("notes").textContent = `Error against float64, before rounding to whole codes: at most ${digits(max, 3)}, mean ${digits(mean, 3)}, ` +
    `99.9 % of the pixels below ${digits(p999, 3)}. The reference took ${(answer.report.reference_ms / 1000).toFixed(1)} s.`;
}

function hide_heat() {
  $("heat").hidden = $("legend").hidden = true;
  heat_of = "";
  stop_comparing();
}

// Draws until the last picture is that of the state.
async function draw_all() {
  waiting = true;
  if (drawing) return;
  drawing = true;
  let fault = "";
  while (waiting) {
    waiting = false;
    begin_busy(shown?.scene === state.scene ? "drawing" : `loading ${state.scene}`, calm ? kBusyAfterMotion : kBusyAfter);
    fault = await draw_picture().then(() => "", (error) => error.message);
  }
  drawing = false;
  end_busy();
  if (fault) {
    fail_with(fault);
    keep_old_picture();
  } else if (shown) say_facts();
  if (!turning) compare_picture();
}

// Browsers count these calls, and throw beyond 100 in half a minute. The picture does not depend on them.
function write_link() {
  link_timer = 0;
  try {
    history.replaceState(null, "", `#${link_of(state)}`);
  } catch (error) {
    console.warn(error);
  }
}

// moves: the view alone changes, by a drag or a key.
function set_state(next, moves = false) {
  calm = moves || turning;
  state = next;
  turning = moves;
  clearTimeout(settle_timer);
  if (moves) settle_timer = setTimeout(() => set_state(state), 250);
  show_state(state);
  show_lights(state, change_light);
  $("command").value = command_of(state);
  fit_command();
  clearTimeout(link_timer);
  link_timer = setTimeout(write_link, 300);
  if (heat) hide_heat();
  draw_all();
}

function change_light(i, key, value) {
  const lights = lights_of(state);
  lights[i][key] = value;
  set_state({ ...state, lights: lights_text(lights) });
}

// list: [{name, file}], or a promise of it.
async function take_files(list) {
  begin_busy("looking at the files");
  const read = await Promise.resolve(list).then(chosen_of).catch((error) => ({ error }));
  if (!drawing) end_busy();
  if (read.error || (!read.model && !read.sky)) {
    fail_with(read.error ? `the browser cannot read the files: ${read.error.message}` : "expected .glb, .gltf, .stl, .ply, .obj, .off, .3mf, .splat, .spz or .sog, or .hdr or .pfm as an environment");
    return;
  }
  files = read.model ? read.files : with_files(files, read.files);
  engine?.ask("files", { files });
  const next = { ...state };
  if (read.model) Object.assign(next, { scene: read.model, view: "", time: 0 });
  if (read.sky) next.env = read.sky;
  set_state(next);
}

form.addEventListener("input", (event) => {
  const input = event.target;
  if (input.name) set_state(state_of_control(state, input));
});
form.addEventListener("submit", (event) => event.preventDefault());
$("light_count").addEventListener("input", (event) => {
  const lights = lights_of(state), kUsual = [{ azimuth: -40, elevation: 40 }, { azimuth: 120, elevation: 20 }, { azimuth: 0, elevation: 80 }, { azimuth: 60, elevation: 30 }];
  while (lights.length < +event.target.value) lights.push({ ...kUsual[lights.length], intensity: 1, color: "#ffffff" });
  set_state({ ...state, lights: lights_text(lights.slice(0, +event.target.value)) });
});
$("module").addEventListener("change", () => {
  engine?.stop();
  engine = null;
  set_state(state);
});
attach_orbit($("picture"), (change) => {
  if (shown?.scene !== state.scene) return;  // the scene that is turned is not drawn yet
  const { view } = shown.report;
  const along = (turn, { position, target, fov }) => ({ position: turn(position), target: turn(target), fov });
  const next = change(along(kUpright[view.up], view_of(state) || view), view.radius);
  set_state({ ...state, view: view_text(along(kBack[view.up], next)) }, true);
});
$("open").addEventListener("click", () => $("files").click());
$("files").addEventListener("change", (event) => take_files([...event.target.files].map((file) => ({ name: file.name, file }))));
$("reset_view").addEventListener("click", () => set_state({ ...state, view: "" }));
$("reset").addEventListener("click", () => set_state({ ...kDefaults }));
$("toggle_heat").addEventListener("click", () => {
  heat = !heat;
  $("toggle_heat").setAttribute("aria-pressed", heat);
  hide_heat();
  if (heat) compare_picture();
});
const png_of_shown = () => picture_engine().ask("png", { scene: shown.scene, flags: shown.flags });
$("download").addEventListener("click", async () => {
  if (!shown) return;
  const { scene } = shown, answer = await png_of_shown(), link = document.createElement("a");
  if (!answer.file) return fail_with(answer.error ?? "");
  link.href = URL.createObjectURL(new Blob([answer.file], { type: "image/png" }));
  link.download = `${stem_of(scene)}.png`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
});
$("copy_link").addEventListener("click", async () => {
  const address = `${location.href.split("#")[0]}#${link_of(state)}`;
  try {
    await navigator.clipboard.writeText(address);
    $("copy_link").textContent = "Copied";
  } catch {  // a page may not be allowed to; the address bar has the link too
    window.prompt("The link:", address);
  }
  setTimeout(() => ($("copy_link").textContent = "Copy link"), 1500);
});
addEventListener("hashchange", () => set_state(state_of_link(location.hash.slice(1))));
addEventListener("dragover", (event) => {
  event.preventDefault();
  $("drop").hidden = false;
});
addEventListener("dragleave", (event) => {
  if (!event.relatedTarget) $("drop").hidden = true;
});
addEventListener("drop", (event) => {
  event.preventDefault();
  $("drop").hidden = true;
  take_files(dropped_files(event.dataTransfer));
});
$("plots").addEventListener("toggle", () => shown && show_lobes());
addEventListener("resize", () => {
  fit_command();
  if (shown) show_lobes();
});

const ramp = $("ramp").getContext("2d");
for (let x = 0; x < 128; ++x) {
  ramp.fillStyle = `rgb(${heat_color(x / 127)})`;
  ramp.fillRect(x, 0, 1, 1);
}
const sides = state.size.split("x");
Object.assign($("picture"), { width: sides[0], height: sides[1] || sides[0] });
set_state(state);

// For tests: pictures without the page's own state.
window.halflit = { Engine, take_files, current: () => ({ state, shown, idle: !drawing && !waiting && !turning && !link_timer && !comparer }) };
