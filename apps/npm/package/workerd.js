// Cloudflare Workers, which compile modules when they are deployed and have wasm128.
import code from "./halflit.wasm";
import kernels from "./halflit_wasm128.wasm";
import { set_code } from "./engine.js";

set_code((name) => (name === "halflit.wasm" ? code : kernels));
export * from "./index.js";
