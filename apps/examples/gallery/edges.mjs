// Views by the flags of the program
// Options have the names of the program's flags: here outlines, from two sides by parallel rays.
import { readFile, writeFile } from "node:fs/promises";
import { load } from "halflit";

const scene = await load(await readFile(`${process.env.HALFLIT_EXAMPLES}/knot.glb`));
for (const view of ["iso", "top"]) {
  const options = { size: "480x360", view, ortho: true, fit: 20, edges: "silhouette", hiddenEdges: "dashed", background: "white" };
  await writeFile(`${view}.png`, (await scene.render(options)).png());
}
scene.free();
