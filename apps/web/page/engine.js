// Workers that draw. The page has one for pictures, and a second one for comparisons with the reference, which take seconds.
const kSimdProbe = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);
const has_simd = () => WebAssembly.validate(kSimdProbe);
const wasm_of = {};

// Bytes of a module: base64 of gzip, in the page.
function module_bytes(name) {
  wasm_of[name] ??= (async () => {
    const packed = Uint8Array.from(atob(document.getElementById(name).textContent.trim()), (c) => c.charCodeAt(0));
    return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  })();
  return wasm_of[name];
}

// Tasks are done in the order of ask(). An engine that ended is not used again.
class Engine {
  // name: "simd" or "scalar", of the kernels.
  constructor(name) {
    this.ended = false;
    this.waiting = new Map();
    this.count = 0;
    const code = ["module_code", "kernels_code", "worker_code"].map((id) => document.getElementById(id).textContent).join("\n");
    const address = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
    this.worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.worker.onmessage = (event) => {
      const { id, ...answer } = event.data;
      this.waiting.get(id)?.(answer);
      this.waiting.delete(id);
      if (answer.ended) this.stop(answer);
    };
    this.worker.onerror = (event) => this.stop({ error: event.message || "the worker ended", ended: true });
    const parts = [module_bytes("main_wasm"), name === "simd" ? module_bytes("kernels_wasm") : null];
    this.started = Promise.all(parts).then(([wasm, wasm128]) => this.send("start", { wasm, wasm128 })).catch((error) => {
      this.stop({ error: `this browser cannot start the library: ${error.message}`, ended: true });
      return this.last_answer;
    });
  }

  // Resolves with the worker's answer, which has `error` where it failed, or `stopped` where stop() came first.
  async ask(kind, task = {}) {
    await this.started;
    return this.send(kind, task);
  }

  send(kind, task) {
    if (this.ended) return Promise.resolve(this.last_answer);
    return new Promise((resolve) => {
      const id = ++this.count;
      this.waiting.set(id, resolve);
      this.worker.postMessage({ ...task, kind, id });
    });
  }

  // Frees the worker's memory, which a browser keeps until then. `answer` is that of all tasks that are left.
  stop(answer = { stopped: true }) {
    if (this.ended) return;
    this.ended = true;
    this.last_answer = answer;
    this.worker.terminate();
    for (const resolve of this.waiting.values()) resolve(answer);
    this.waiting.clear();
  }
}
