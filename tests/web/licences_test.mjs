// Notices of what is compiled in: node licences_test.mjs SOURCE_FOLDER WORK_FOLDER, with sources of decoders that have nothing but them.
import { mkdirSync, rmSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [source, work] = process.argv.slice(2).map((path) => resolve(path));
const { all_licences, licences } = await import(pathToFileURL(join(source, "apps/web/licences.mjs")));
let failures = 0;
function check(fact, holds) {
  if (!holds) ++failures;
  console.log(`${holds ? "ok" : "FAILED"}: ${fact}`);
}
const refused = (attempt) => {
  try {
    attempt();
    return "";
  } catch (error) {
    return error.message;
  }
};

const kFiles = ["draco/LICENSE", "draco/AUTHORS", "expat/COPYING", "libdeflate/COPYING", "libjpeg-turbo/README.ijg", "libjpeg-turbo/LICENSE.md", "libwebp/COPYING",
  "libwebp/PATENTS", "meshoptimizer/LICENSE.md"];
rmSync(work, { recursive: true, force: true });
const place = (file) => join(work, file.replace("/", "-1.0/"));
for (const file of kFiles) {
  mkdirSync(join(place(file), ".."), { recursive: true });
  writeFileSync(place(file), `terms of ${file}\n`);
}
const page = refused(() => all_licences());
if (page.includes("/usr/share/")) {
  console.log(`skipped: ${page}`);
  process.exit(77);
}
const found = licences(work), whole = all_licences(work);
for (const file of kFiles) check(`${file} is in the text of its library`, found[file.split("/")[0]].includes(`terms of ${file}\n`));
check("a page with libjpeg names the Independent JPEG Group", whole.includes("This software is based in part on the work of the Independent JPEG Group."));
check("a page without the decoders has the licences of the headers", /======== fmt =/.test(all_licences()) && !/terms of draco/.test(all_licences()));
check("the licence of halflit is there", /======== halflit =+\n\nMIT License/.test(whole));
check("what Debian cites is there in full", found.emscripten.includes("END OF TERMS AND CONDITIONS") && found.expected.includes("Creative Commons Legal Code"));
check("the C library's notice is there", found.emscripten.includes("musl as a whole is licensed under"));
for (const file of kFiles) {
  rmSync(place(file));
  const words = refused(() => licences(work));
  check(`without ${file} nothing is packed`, words.includes("a licence is missing") && words.includes(place(file)) && !words.includes("\n"));
  writeFileSync(place(file), `terms of ${file}\n`);
}
rmSync(join(work, "expat-1.0"), { recursive: true });
check("without the sources of a library nothing is packed", refused(() => licences(work)).includes("expat"));
process.exit(failures === 0 ? 0 : 1);
