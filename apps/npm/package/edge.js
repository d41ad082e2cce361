// Edge functions whose bundler compiles "?module" when they are deployed.
import code from "./halflit.wasm?module";
import kernels from "./halflit_wasm128.wasm?module";
import { set_code } from "./engine.js";

set_code((name) => (name === "halflit.wasm" ? code : kernels));
export * from "./index.js";
