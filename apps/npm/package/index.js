// The exports of the package. Without one of the files for a host, init({ wasm }) says where the code is.
export { HalflitError, Picture, Scene, init, load, memory, render } from "./engine.js";
export { MujocoRenderer } from "./mujoco.js";
export { pixelEpoch, version } from "./tables.js";
