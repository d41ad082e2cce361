// A thumbnail in Node.js
// The bytes of a model go in, the bytes of a PNG file come out; WebAssembly draws the pixels of the native program.
import { readFile, writeFile } from "node:fs/promises";
import { render } from "halflit";

const knot = await readFile(`${process.env.HALFLIT_EXAMPLES}/knot.glb`);
const picture = await render(knot, { width: 480, height: 360, ground: true, background: "#f4f1ea" });
console.log(picture.hash);
await writeFile("thumbnail.png", picture.png());
