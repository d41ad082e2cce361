// A model that is written by the script
// A vase as the text of an OBJ file; the scene is read once and described by its measures before it is drawn.
import { writeFile } from "node:fs/promises";
import { load } from "halflit";

const around = 64, rows = 40;
const lines = [];
for (let j = 0; j <= rows; ++j)
  for (let i = 0; i < around; ++i) {
    const y = j / rows, angle = (2 * Math.PI * i) / around;
    const radius = 0.35 + 0.25 * Math.sin(5 * y) + 0.015 * Math.cos(16 * angle);
    lines.push(`v ${(radius * Math.cos(angle)).toFixed(5)} ${(1.6 * y).toFixed(5)} ${(radius * Math.sin(angle)).toFixed(5)}`);
  }
for (let j = 0; j < rows; ++j)
  for (let i = 0; i < around; ++i) {
    const [a, b] = [j * around + i + 1, j * around + ((i + 1) % around) + 1];
    lines.push(`f ${a} ${a + around} ${b + around} ${b}`);
  }
const scene = await load(new TextEncoder().encode(lines.join("\n")));
console.log((await scene.info()).measures);
await writeFile("vase.png", (await scene.render({ size: "480x360", env: "sky", lobe: "sloan", wrap: 0.5, elevation: 10 })).png());
scene.free();
