// One request, one answer: the npm package and the program draw the same pixels, or refuse with the same words. The requests are those of
// tests/python/same_request_test.py.
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { check, end, program, source, work } from "../web/harness.mjs";
import { begin } from "./project.mjs";

const { halflit } = await begin();
const listed = spawnSync(process.env.HALFLIT_PYTHON, [join(source, "tests/python/same_request_test.py"), "--flags"], { encoding: "utf8",
  env: { ...process.env, PYTHONPATH: [join(source, "apps/python"), join(source, "tests/python")].join(":") } });
if (listed.status !== 0) throw new Error(listed.stderr);
const requests = JSON.parse(listed.stdout), kSize = "48x36";

const camel = (name) => name.replace(/^-+/, "").replace(/-([a-z0-9])/g, (_, letter) => letter.toUpperCase());
// {shadows: "hard"} of ["--shadows", "hard"]: of the last, where a flag is there twice.
function options_of(words) {
  const options = { size: kSize };
  for (let i = 0; i < words.length; ++i) {
    const value = i + 1 < words.length && !words[i + 1].startsWith("--") ? words[++i] : true;
    options[camel(value === true ? words[i] : words[i - 1])] = value;
  }
  return options;
}

// A refusal without what is each front end's own: hyphens, capitals of names, and the place to look further.
const plain = (message) => message.trim().replace(/^halflit: error: /, "").replace(/ \(an empty variable\?\)/, "").replace(/; see halflit render --help$/, "")
  .replace(/[a-z]+[A-Z][A-Za-z]*/g, (name) => name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`)).replaceAll("--", "");

function of_program(words) {
  const files = ["-o", join(work, "native.png"), "--report", "-", "-q"];
  const done = spawnSync(program, ["render", "demo", "--size", kSize, ...words, ...files], { encoding: "utf8" });
  return done.status === 0 ? JSON.parse(done.stdout).pixel_hash : plain(done.stderr.slice(done.stderr.indexOf("halflit: error: ")));
}
const of_package = (words) => halflit.render("demo", options_of(words)).then((picture) => picture.hash, (error) => plain(error.message));

let same = 0;
for (const words of requests) {
  const [ours, theirs] = [await of_package(words), of_program(words)];
  if (ours === theirs) ++same;
  else check(`${words.join(" ")}: "${ours}", the program's "${theirs}"`, false);
}
check(`${same} of ${requests.length} requests have one answer`, same === requests.length && same >= 200);
end();
