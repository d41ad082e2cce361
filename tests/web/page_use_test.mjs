// Tests of what a visitor meets: models of all formats, marks of a busy page, words, keys, colours, and screens of all sizes.
import { copyFileSync, existsSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { begin, check, command_of, end, idle, native_hash, open_model, shown_hash, source, text_of, with_page, words_of, work, write_3mf, write_textured_model,
  write_webp_model } from "./harness.mjs";

const kAssets = process.env.HALFLIT_ASSETS ?? "";
const facts = (page) => text_of(page, "facts");

async function formats(page) {
  await page.until(idle);
  const models = [["part.3mf"], ["card.gltf", "card.bin", "photo.webp"], ["textured.gltf", "textured.bin", "photo.jpg", "ball.png"]];
  for (const name of ["BoxDraco/Box_Draco.glb", "BoxMeshopt/BoxMeshopt.glb", "Duck/Duck.glb"]) {
    const place = join(kAssets, "models", name);
    if (!existsSync(place)) continue;
    copyFileSync(place, join(work, basename(name)));
    models.push([basename(name)]);
  }
  for (const files of models) {
    await open_model(page, files);
    const expected = native_hash(words_of(await command_of(page))), found = await shown_hash(page);
    check(`formats: ${files[0]} has the program's pixels`, found === expected, `${found}, native ${expected}`);
  }
  await page.screenshot(join(work, "model.png"));
  check("formats: no error is shown", (await text_of(page, "error")) === "" && page.faults.length === 0, page.faults.join(", "));
  if (!kAssets) console.log("HALFLIT_ASSETS is not set: neither Draco nor meshopt");
}

// Draws wait for window.hold milliseconds.
const kHeldDraws = `{
  window.hold = 0;
  const { postMessage } = Worker.prototype;
  Worker.prototype.postMessage = function (task, ...more) {
    if (task.kind === "draw") setTimeout(() => postMessage.call(this, task, ...more), window.hold);
    else postMessage.call(this, task, ...more);
  };
}`;
const busy = (page) => page.value("document.getElementById('stage').getAttribute('aria-busy') === 'true'");
const dimmed = (page) => page.value("getComputedStyle(document.getElementById('picture')).opacity < 0.5");
const set = (page, name, value) =>
  page.value(`(() => { const input = document.querySelector('[name="${name}"]'); input.value = "${value}"; input.dispatchEvent(new Event("input", { bubbles: true })); })()`);

async function busy_page(page) {
  await page.until(idle);
  check("busy: the first picture has its hash", /hash [0-9a-f]{16}/.test(await facts(page)) && !(await busy(page)), await facts(page));
  await page.value("window.hold = 1e9");
  await set(page, "tonemap", "aces");
  await page.until("document.getElementById('stage').getAttribute('aria-busy') === 'true'", 5);
  check("busy: the picture is said to be drawn", (await text_of(page, "busy")) === "drawing", await text_of(page, "busy"));
  check("busy: the last picture's hash is not shown", (await facts(page)) === "");
  await page.until("getComputedStyle(document.getElementById('picture')).opacity < 0.5", 5);
  check("busy: the last picture is dimmed", await dimmed(page));
  await page.screenshot(join(work, "busy.png"));
}

async function busy_end(page) {
  await page.until(idle);
  await page.value("window.hold = 700");
  await page.choose_files("#files", [join(work, "part.3mf")]);
  await page.until("document.getElementById('stage').getAttribute('aria-busy') === 'true'", 5);
  check("busy: the model that is loaded is named", (await text_of(page, "busy")) === "loading part.3mf", await text_of(page, "busy"));
  await page.until("halflit.current().state.scene === 'part.3mf' && halflit.current().idle");
  check("busy: the marks go with the new picture", !(await busy(page)) && (await text_of(page, "busy")) === "" && /hash/.test(await facts(page)), await facts(page));
  await page.until("getComputedStyle(document.getElementById('picture')).opacity == 1", 5);
}

// The worker answers a draw at once, with the picture that it has drawn before.
async function quick_pictures(page) {
  await page.until(idle);
  await page.value(`{
    const { postMessage } = Worker.prototype;
    Worker.prototype.postMessage = function (task, ...more) {
      if (task.kind !== "draw") return postMessage.call(this, task, ...more);
      const { report, width, height, pixels } = halflit.current().shown;
      setTimeout(() => this.onmessage({ data: { id: task.id, report, width, height, pixels } }), 20);
    };
    window.marks = 0;
    new MutationObserver(() => (window.marks += document.getElementById("stage").classList.contains("old"))).observe(document.getElementById("stage"), { attributes: true });
  }`);
  for (let i = 0; i < 20; ++i) await set(page, "rotate", 5 * i);
  await page.until(idle);
  check("quick pictures: none is marked as old", (await page.value("window.marks")) === 0, await page.value("window.marks"));
}

async function damaged(page) {
  await page.until(idle);
  await page.choose_files("#files", [join(work, "broken.glb")]);
  await page.until("!document.getElementById('error').hidden", 20);
  check("damaged file: the error names it", /broken\.glb/.test(await text_of(page, "error")), await text_of(page, "error"));
  check("damaged file: the last picture is marked, without its hash", (await facts(page)) === "the picture is still that of demo" && !(await busy(page)), await facts(page));
  await page.screenshot(join(work, "damaged.png"));
  await page.choose_files("#files", [join(work, "notes.txt")]);
  await page.until("/expected/.test(document.getElementById('error').textContent)", 10);
  check("wrong file: the formats are named", /\.3mf, \.splat, \.spz or \.sog/.test(await text_of(page, "error")), await text_of(page, "error"));
  await open_model(page, ["part.3mf"]);
  check("a sound file after it: no error is left", (await text_of(page, "error")) === "" && /hash/.test(await facts(page)), await facts(page));
}

async function words_of_lights(page) {
  await page.until(idle);
  check("words: 1 light", / · 1 light · /.test(await facts(page)), await facts(page));
  await page.value("(() => { const count = document.getElementById('light_count'); count.value = 2; count.dispatchEvent(new Event('input', { bubbles: true })); })()");
  await page.until(idle);
  check("words: 2 lights", / · 2 lights · /.test(await facts(page)), await facts(page));
}

const key = async (page, name, code, text = "") => {
  for (const type of ["keyDown", "keyUp"]) await page.send("Input.dispatchKeyEvent", { type, key: name, code: name, windowsVirtualKeyCode: code, ...(type === "keyDown" && text ? { text } : {}) });
};

async function keys(page) {
  await page.until(idle);
  const visited = [];
  await page.value("window.name_of = (e) => e.id || e.name || `${e.tagName} ${[...document.querySelectorAll('*')].indexOf(e)}`");
  for (let i = 0; i < 80; ++i) {
    await key(page, "Tab", 9);
    const at = await page.value("document.activeElement === document.body ? '' : name_of(document.activeElement)");
    if (!at || visited.includes(at)) break;
    visited.push(at);
  }
  const inputs = JSON.parse(await page.value(`JSON.stringify([...document.querySelectorAll("button, select, textarea, input:not([hidden]), summary, canvas[tabindex]")]
    .filter((e) => !e.disabled && e.offsetParent !== null).map(name_of))`));
  check("keys: the invitation comes first", visited[0] === "open", visited.join(" "));
  check("keys: Tab reaches each control", inputs.every((name) => visited.includes(name)), inputs.filter((name) => !visited.includes(name)).join(" "));
  await page.value("document.getElementById('picture').focus()");
  const before = await shown_hash(page);
  await key(page, "ArrowLeft", 37);
  await page.until(idle);
  check("keys: an arrow turns the view", (await shown_hash(page)) !== before);
  await page.value("document.querySelector('#plots summary').focus()");
  await key(page, "Enter", 13, "\r");
  await page.until("document.getElementById('plots').open && document.getElementById('series_name').textContent !== 'series'", 5);
  check("keys: Enter unfolds the plots, which are drawn", await page.value(`(() => { const canvas = document.getElementById("curve"), data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    return canvas.width > 100 && data.some((x) => x > 0); })()`));
}

async function names(page) {
  await page.until(idle);
  const { nodes } = await page.send("Accessibility.getFullAXTree");
  const kRoles = ["button", "slider", "combobox", "checkbox", "textbox", "image", "img", "application", "ColorWell", "DisclosureTriangle"];
  const found = nodes.filter((node) => !node.ignored && kRoles.includes(node.role?.value)), nameless = found.filter((node) => !node.name?.value);
  check("names: each control and picture has one", found.length > 25 && nameless.length === 0, `${found.length}, ${nameless.map((node) => node.role.value).join(" ")}`);
}

// The least contrast of a text with what is behind it, by the formula of WCAG 2.
const kContrast = `(() => {
  const channels = (color) => color.match(/[0-9.]+/g).map(Number);
  const linear = (c) => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  const luminance = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  const behind = (element) => {
    if (!element) return [255, 255, 255];
    const [r, g, b, a = 1] = channels(getComputedStyle(element).backgroundColor);
    if (a === 1) return [r, g, b];
    const under = behind(element.parentElement);
    return [r, g, b].map((c, i) => c * a + under[i] * (1 - a));
  };
  let least = { ratio: 21 };
  for (const element of document.body.querySelectorAll("*")) {
    const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim()) || ["SELECT", "TEXTAREA"].includes(element.tagName);
    if (!own || element.offsetParent === null || element.closest(".off, option, #drop, #loading")) continue;
    const a = luminance(channels(getComputedStyle(element).color)), b = luminance(behind(element)), ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < least.ratio) least = { ratio, what: element.id || element.className || element.tagName };
  }
  return least;
})()`;
async function contrast(page) {
  await page.until(idle);
  await page.value("document.getElementById('toggle_heat').click()");
  await page.value("document.getElementById('error').textContent = 'an error'; document.getElementById('error').hidden = false;");
  for (const scheme of ["light", "dark"]) {
    await page.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: scheme }] });
    const { ratio, what } = await page.value(kContrast);
    check(`contrast: texts have at least 4.5 in the ${scheme} scheme`, ratio >= 4.5, `${ratio.toFixed(2)} of ${what}`);
  }
}

const screen = (width, height) => async (page) => {
  await page.resize(width, height);
  await page.until(idle);
  const wide = await page.value("document.documentElement.scrollWidth");
  check(`screen of ${width}: nothing is wider`, wide <= width, wide);
  const end_of = (id) => page.value(`document.getElementById("${id}").getBoundingClientRect().bottom`);
  check(`screen of ${width}: the invitation and the picture are seen at once`, (await end_of("open")) <= height && (await end_of("picture")) <= height);
  await page.screenshot(join(work, `screen-${width}.png`));
};

begin();
write_textured_model();
write_webp_model();
write_3mf();
writeFileSync(join(work, "broken.glb"), Buffer.from("glTF\x02\0\0\0\x20\0\0\0damaged"));
writeFileSync(join(work, "notes.txt"), "no model");
await with_page({}, "", formats);
await with_page({ prelude: kHeldDraws }, "", busy_page);
await with_page({ prelude: kHeldDraws }, "", busy_end);
await with_page({}, "", damaged, quick_pictures);
await with_page({}, "#scene=sphere:5000&scene_lights=false&lights=0,45,1,%23ffffff&env=none", words_of_lights);
await with_page({}, "#lights=0,45,1,%23ffffff&budget=2&env=sky", names, keys, contrast);
await with_page({}, "#scene=sphere:5000", screen(1280, 800), screen(1000, 700));
await with_page({ phone: true }, "#scene=sphere:5000", screen(390, 844), screen(320, 640));
end();
