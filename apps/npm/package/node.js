// Node.js, Deno and Bun: the code lies beside this file.
import { readFile } from "node:fs/promises";
import { set_code } from "./engine.js";

set_code((name) => readFile(new URL(`./${name}`, import.meta.url)));
export * from "./index.js";
