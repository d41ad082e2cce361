// The page where a browser refuses, a link is hostile, files come at a bad time, or a model is odd.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { deflateRawSync } from "node:zlib";
import { Page } from "./chromium.mjs";
import { address, answers_of, begin, check, end, idle, native_hash, shown_hash, words_of, work, write_squares } from "./harness.mjs";

const text_of = (page, id) => page.value(`document.getElementById("${id}").hidden ? "" : document.getElementById("${id}").textContent`);
const command_of = (page) => page.value("document.getElementById('command').value");
const view_of = async (page) => JSON.parse(await page.value("JSON.stringify(view_of(halflit.current().state))"));
const report_of = async (page) => JSON.parse(await page.value("JSON.stringify(halflit.current().shown.report)"));
const away = (view) => Math.hypot(...view.position.map((x, i) => x - view.target[i]));

async function with_page(options, hash, test) {
  const page = await Page.open(address + hash, options);
  try {
    await test(page);
  } catch (error) {
    check(`${test.name} runs: ${error.message}`, false);
  } finally {
    await page.close();
  }
}

// A chunk ahead of the header, as Apple's tools write it. Its data and checksum stand where a header has the size. stb_image checks none.
function write_odd_png() {
  const chunk = (name, data, sum = 0) => {
    const out = Buffer.alloc(12 + data.length);
    out.writeUInt32BE(data.length, 0);
    out.write(name, 4, "latin1");
    data.copy(out, 8);
    out.writeUInt32BE(sum, 8 + data.length);
    return out;
  };
  const number = (x) => Buffer.from([x >>> 24, (x >> 16) & 255, (x >> 8) & 255, x & 255]);
  const header = Buffer.concat([number(1), number(1), Buffer.from([8, 6, 0, 0, 0])]);
  writeFileSync(join(work, "odd.png"), Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk("CgBI", number(1024), 1024), chunk("IHDR", header),
    chunk("IDAT", deflateRawSync(Buffer.from([0, 255, 0, 0, 255]))), chunk("IEND", Buffer.alloc(0))]));
}

async function engines(page) {
  await page.until(idle);
  const draw = (scene, ...flags) => ["draw", { scene, flags }];
  const [odd] = await answers_of(page, "simd", ["odd.gltf", "odd.bin", "odd.png"], [draw("odd.gltf", "--size", "64x64")]);
  check("a PNG that does not begin with its header is refused", /PNG/.test(odd.error || ""), odd.error || "drawn");

  const [loaded, resized, sized] = await answers_of(page, "simd", [], [draw("sphere:400000", "--size", "64x64", "--samples", "1"),
    draw("sphere:400000", "--size", "80x60", "--samples", "1"), draw("sphere:400000", "--size", "80x60", "--samples", "1", "--shadow-size", "256")]);
  check("another size of picture or shadow map does not load the scene anew", Math.max(resized.report.apply_ms, sized.report.apply_ms) < loaded.report.apply_ms / 4,
    `${loaded.report.apply_ms} ms, then ${resized.report.apply_ms} and ${sized.report.apply_ms}`);
}

begin();
const matt = [{ doubleSided: true, pbrMetallicRoughness: { baseColorFactor: [0.7, 0.5, 0.3, 1], metallicFactor: 0 } }];
write_squares("odd", { nodes: [{ mesh: 0 }], materials: [{ ...matt[0], pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }], textures: [{ source: 0 }], images: [{ uri: "odd.png" }] });
write_odd_png();
await with_page({}, "", engines);
end();
