// Browsers: the code is fetched from beside this file. Each name is written out, so that bundlers find the files.
import { set_code } from "./engine.js";

const kPlaces = {
  "halflit_wasm128.wasm": () => new URL("./halflit_wasm128.wasm", import.meta.url),
  "halflit.wasm": () => new URL("./halflit.wasm", import.meta.url),
};
set_code((name) => fetch(kPlaces[name]()));
export * from "./index.js";
