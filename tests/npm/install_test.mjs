// Installs the npm package's tarball, also for other tests: WORK_FOLDER/project/node_modules. Its size, version, licences and examples.
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { check, end } from "../web/harness.mjs";
import { begin, installed } from "./project.mjs";

const kMostBytes = 1.9e6;
const { bytes, halflit } = await begin();
const { version } = JSON.parse(readFileSync(join(installed, "package.json"), "utf8"));
check("the package has the version of its module", halflit.version === version, version);
check("the tarball has at most 1.9 MB", bytes <= kMostBytes, bytes);
const licences = readdirSync(join(installed, "licences")).map((name) => name.replace(".txt", ""));
for (const name of ["draco", "expat", "libdeflate", "libjpeg-turbo", "libwebp", "meshoptimizer", "fmt", "xsimd", "expected", "stb", "nlohmann-json", "emscripten"])
  check(`it has the licence of ${name}`, licences.includes(name));
const terms = (name) => readFileSync(join(installed, "licences", `${name}.txt`), "utf8");
for (const [name, words] of [["draco", "Apache License"], ["draco", "END OF TERMS AND CONDITIONS"], ["libjpeg-turbo", "copyright (C) 1991-2020, Thomas G. Lane"],
  ["libwebp", "Additional IP Rights Grant"], ["expected", "Creative Commons Legal Code"], ["emscripten", "END OF TERMS AND CONDITIONS"]])
  check(`its licence of ${name} has "${words}"`, terms(name).includes(words));
check("its README names the Independent JPEG Group", readFileSync(join(installed, "README.md"), "utf8").includes("based in part on the work of the Independent JPEG Group."));
end();
