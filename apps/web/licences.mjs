// Notices of the code that is compiled into the modules, in full. A text that is missing is an error, as it may not be left out.
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

// Files of the decoders' sources.
const kDecoders = {
  draco: ["LICENSE", "AUTHORS"],
  expat: ["COPYING"],
  libdeflate: ["COPYING"],
  "libjpeg-turbo": ["README.ijg", "LICENSE.md"],
  libwebp: ["COPYING", "PATENTS"],
  meshoptimizer: ["LICENSE.md"],
};
// Debian's packages of headers, and of the compiler with its C and C++ libraries.
const kPackages = {
  expected: "libexpected-dev", fmt: "libfmt-dev", "nlohmann-json": "nlohmann-json3-dev", stb: "libstb-dev", xsimd: "libxsimd-dev", emscripten: "emscripten",
};
const kMusl = "/usr/share/emscripten/system/lib/libc/musl/COPYRIGHT";
export const kJpegSentence = "This software is based in part on the work of the Independent JPEG Group.";

function text(file) {
  try {
    return `${readFileSync(file, "utf8").trimEnd()}\n`;
  } catch (error) {
    throw new Error(`a licence is missing: ${file} (${error.code})`);
  }
}

const joined = (files) => files.map(text).join("\n\n");

// Paragraphs about what is linked: the libraries of the system, the code around them, and the licences that these have.
function of_linked(copyright) {
  const paragraphs = copyright.split(/\n\n+/), linked = paragraphs.filter((one) => /^Files:/.test(one) && /^(Files:)? (\*$|system\/lib\/|src\/)/m.test(one));
  const names = linked.map((one) => /^License: *(.*)/m.exec(one)?.[1]).join("\n");
  const terms = paragraphs.filter((one) => /^License:/.test(one) && names.includes(/^License: *(.*)/.exec(one)[1]));
  return [...linked, ...terms].join("\n\n");
}

// With the licences that Debian's file only cites.
function of_package(name) {
  const whole = text(`/usr/share/doc/${name}/copyright`), copyright = name === "emscripten" ? of_linked(whole) : whole;
  const cited = new Set(copyright.match(/\/usr\/share\/common-licenses\/[A-Za-z0-9.-]*[A-Za-z0-9]/g));
  return [`${copyright.trimEnd()}\n`, ...[...cited].map(text), ...(name === "emscripten" ? [text(kMusl)] : [])].join("\n\n");
}

// {name: text}. libraries: the folder of the decoders' sources, or nothing where these are not compiled in.
export function licences(libraries) {
  const found = {};
  if (libraries) {
    const folders = readdirSync(libraries);
    for (const [name, files] of Object.entries(kDecoders)) {
      const folder = folders.find((one) => one.startsWith(`${name}-`));
      if (!folder) throw new Error(`a licence is missing: ${libraries} has no ${name}`);
      found[name] = joined(files.map((file) => join(libraries, folder, file)));
    }
    found["libjpeg-turbo"] = `${kJpegSentence}\n\n\n${found["libjpeg-turbo"]}`;
  }
  for (const [name, debian] of Object.entries(kPackages)) found[name] = of_package(debian);
  return found;
}

// One text: the licence of halflit, and all others.
export function all_licences(libraries) {
  const own = { halflit: text(fileURLToPath(new URL("../../LICENSE", import.meta.url))) };
  return Object.entries({ ...own, ...licences(libraries) }).map(([name, terms]) => `======== ${name} ========\n\n${terms}`).join("\n\n");
}
