// The page in headless Chromium against the program: node page_test.mjs PROGRAM PAGE SOURCE_FOLDER WORK_FOLDER
import { spawnSync } from "node:child_process";
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { Page } from "./chromium.mjs";
import { address, answers_of, begin, check, end, idle, native_hash, program, run, shown_hash, source, words_of, work, write_points, write_textured_model } from "./harness.mjs";

const kFiles = ["knot.glb", "textured.gltf", "textured.bin", "photo.jpg", "ball.png", "dots.ply"];

// Every scene by one module, one after the other.
async function compare_scenes(page, module, scenes, expected) {
  const found = await answers_of(page, module, kFiles, scenes.map(([scene, ...flags]) => ["draw", { scene, flags }]));
  const isa = module === "simd" ? "wasm128" : "scalar", told = (answer) => answer.error || `${answer.report.pixel_hash},${answer.report.isa}`;
  scenes.forEach((scene, i) => check(`${module}: ${scene.join(" ")}`, told(found[i]) === `${expected[i]},${isa}`, `${told(found[i])}, native ${expected[i]}`));
}

async function test_page(page) {
  await page.until(idle);
  check("the page's first picture is the program's", (await shown_hash(page)) === native_hash(["demo", "--size", "640x360"]));

  // A turn by the mouse, and its speed.
  const turns = Number(process.env.HALFLIT_WEB_TURNS || 2);
  const rates = [];
  for (let i = 0; i < 3; ++i) {
    await page.value(`(async () => {
      const engine = new halflit.Engine("simd"), ask = (flags) => engine.ask("draw", { scene: "demo", flags: ["--size", "640x360", ...flags] });
      await engine.started;
      const measure = async (samples) => {
        await ask(["--samples", samples]);
        const start = performance.now();
        for (let k = 0; k < ${turns}; ++k) await ask(["--samples", samples, "--camera-position", (9 * Math.sin(k / 9)).toFixed(3) + ",2.5," + (9 * Math.cos(k / 9)).toFixed(3), "--camera-target", "0,1,0", "--fov", "25"]);
        return 1000 * ${turns} / (performance.now() - start);
      };
      window.rates = [await measure("1"), await measure("4")];
      engine.stop();
    })()`);
    rates.push(await page.value("window.rates"));
  }
  const best = [0, 1].map((i) => Math.max(...rates.map((rate) => rate[i])));
  check("the demo turns at 640x360", best[0] > 3, `${best[0].toFixed(1)} pictures a second with 1 sample, ${best[1].toFixed(1)} with 4`);

  const before = await shown_hash(page);
  await page.drag({ x: 400, y: 300 }, { x: 470, y: 280 });
  await page.until(idle);
  const command = await page.value("document.getElementById('command').value"), turned = await shown_hash(page);
  check("a drag turns the view", turned !== before && command.includes("--camera-position"));
  check("the command line gives the turned picture", native_hash(words_of(command)) === turned, command);

  // Controls, as a hand sets them.
  const set = (name, value) => page.value(`(() => { const input = document.querySelector('[name="${name}"]'); input.${typeof value === "boolean" ? "checked" : "value"} = ${JSON.stringify(value)}; input.dispatchEvent(new Event("input", { bubbles: true })); })()`);
  for (const [name, value] of [["lobe", "sloan"], ["wrap", "0.8"], ["power", "2.2"], ["normalize", true], ["specular", "ggx"], ["env", "sky"], ["sh_order", "3"], ["sky_shadows", "16"], ["shadows", "hard"]]) await set(name, value);
  await page.value("(() => { const count = document.getElementById('light_count'); count.value = 2; count.dispatchEvent(new Event('input', { bubbles: true })); })()");
  await page.until(idle);
  const full = await page.value("document.getElementById('command').value"), full_hash = await shown_hash(page);
  check("the command line gives the picture of all controls", native_hash(words_of(full)) === full_hash, full);

  // The PNG of the page.
  const png = await page.value("(async () => { const bytes = (await png_of_shown()).file; let text = ''; for (const b of bytes) text += String.fromCharCode(b); return btoa(text); })()");
  writeFileSync(join(work, "page.png"), Buffer.from(png, "base64"));
  check("the page's PNG has the program's pixels", spawnSync(program, ["diff", "native.png", "page.png"], { cwd: work }).status === 0);

  // The link.
  const link = await page.value("location.href");
  const other = await Page.open(link);
  await other.until(idle);
  check("the link gives the same picture", (await shown_hash(other)) === full_hash, link.split("#")[1]);
  await other.close();

  // The error against the reference, of a picture whose reference is soon drawn.
  for (const [name, value] of [["sky_shadows", "0"], ["env", "none"]]) await set(name, value);
  await page.until(idle);
  await page.value("document.getElementById('toggle_heat').click()");
  await page.until("!document.getElementById('legend').hidden", 120);
  const words = await page.value("document.getElementById('notes').textContent"), most = Number(words.match(/at most ([0-9.e-]+)/)?.[1]);
  check("the error map tells an error", most > 0 && most < 60, words);
  await page.screenshot(join(work, "desktop.png"));
  await page.value("document.getElementById('toggle_heat').click()");

  // A model.
  await page.choose_files("#files", kFiles.slice(1, 5).map((name) => join(work, name)));
  await page.until("halflit.current().state.scene === 'textured.gltf' && halflit.current().idle");
  const model = await page.value("document.getElementById('command').value");
  check("a model that was opened is drawn", native_hash(words_of(model)) === (await shown_hash(page)), model);
  check("no error is shown", await page.value("document.getElementById('error').hidden"), await page.value("document.getElementById('error').textContent"));
  await page.screenshot(join(work, "model.png"));
}

async function test_phone(address) {
  const page = await Page.open(address, { width: 390, height: 844, phone: true });
  await page.until(idle);
  const width = await page.value("document.documentElement.scrollWidth");
  check("nothing is wider than a phone", width <= 390, width);
  const before = await shown_hash(page), box = JSON.parse(await page.value("JSON.stringify(document.getElementById('picture').getBoundingClientRect())"));
  await page.drag({ x: 150, y: box.y + 80 }, { x: 230, y: box.y + 90 }, { touch: true });
  await page.until(idle);
  check("a finger turns the view", (await shown_hash(page)) !== before);
  await page.screenshot(join(work, "phone.png"));
  check("the phone's page has no error", page.faults.length === 0, page.faults.join(", "));
  await page.close();
}

const size = begin();
copyFileSync(join(source, "apps/examples/knot.glb"), join(work, "knot.glb"));
write_textured_model();
write_points();
check("the page has at most 3 MB", size <= 3e6, size);

const scenes = readFileSync(join(source, "tests/web/scenes.txt"), "utf8").split("\n").filter((line) => line && !line.startsWith("#")).map((line) => line.split(" "));
const expected = scenes.map(native_hash);
check("there are at least 20 different pictures", new Set(expected).size >= 20, new Set(expected).size);
const page = await Page.open(address);
try {
  await page.until(idle);
  await compare_scenes(page, "simd", scenes, expected);
  await compare_scenes(page, "scalar", [...scenes].reverse(), [...expected].reverse());
  await test_page(page);
  const outside = page.requests.filter((request) => !/^(file|blob|data):/.test(request));
  check("nothing is asked of a network", outside.length === 0, outside.join(", "));
  check("the page has no error", page.faults.length === 0, page.faults.join(", "));
  await test_phone(address);
} finally {
  await page.close();
}
end();
