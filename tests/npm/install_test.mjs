// Installs the npm package's tarball, for other tests: WORK_FOLDER/project/node_modules.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { check, end } from "../web/harness.mjs";
import { begin, installed } from "./project.mjs";

const { halflit } = await begin();
const { version } = JSON.parse(readFileSync(join(installed, "package.json"), "utf8"));
check("the package has the version of its module", halflit.version === version, version);
end();
