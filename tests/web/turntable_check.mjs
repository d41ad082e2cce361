// Turns a page of Scene.turntable() in headless Chromium:   node turntable_check.mjs PAGE WIDTH HEIGHT
// Prints the numbers of the frames that are shown, as JSON. Exit code 77, skipped, without Chromium.
import { close_browser, find_chromium, Page } from "./chromium.mjs";

if (!find_chromium()) process.exit(77);
const [address, width, height] = [`file://${process.argv[2]}`, Number(process.argv[3]), Number(process.argv[4])];
const kShown = `Number(document.getElementById("view").dataset.frame)`;
// Drags in shares of the picture, from its middle.
const kDrags = { left: [-0.25, 0], right: [0.25, 0], down: [0, 0.5], up: [0, -0.5] };
const found = {};
for (const touch of [false, true]) {
  for (const [name, [x, y]] of Object.entries(kDrags)) {
    const page = await Page.open(address, { width: 2 * width, height: 2 * height, phone: touch });
    await page.until(`document.readyState === "complete"`);
    found.first = await page.value(kShown);
    const from = { x: width / 2, y: height / 2 };
    await page.drag(from, { x: from.x + x * width, y: from.y + y * height }, { touch });
    found[(touch ? "finger_" : "") + name] = await page.value(kShown);
    if (name === "left" && !touch) {
      const key = (type) => page.send("Input.dispatchKeyEvent", { type, key: "ArrowRight", code: "ArrowRight", windowsVirtualKeyCode: 39 });
      await page.value(`document.getElementById("view").focus()`);
      await key("keyDown");
      await key("keyUp");
      found.left_and_key = await page.value(kShown);
    }
    const outside = page.requests.filter((one) => !/^(file|data):/.test(one));
    if (page.faults.length || outside.length) throw new Error(`faults: ${page.faults}; requests: ${outside}`);
    await page.close();
  }
}
await close_browser();
console.log(JSON.stringify(found));
