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

class Engine {
  // name: "simd" or "scalar".
  constructor(name) {
    this.name = name;
    this.waiting = new Map();
    this.count = 0;
    const code = ["module_code", "worker_code"].map((id) => document.getElementById(id).textContent).join("\n");
    const address = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
    this.worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.worker.onmessage = (event) => {
      const { id, ...answer } = event.data;
      this.ended = this.ended || answer.ended;
      this.waiting.get(id)?.(answer);
      this.waiting.delete(id);
    };
    this.worker.onerror = (event) => {
      this.ended = true;
      for (const answer of this.waiting.values()) answer({ error: event.message || "the worker ended", ended: true });
      this.waiting.clear();
    };
    this.started = module_bytes(name).then((wasm) => this.ask("start", { wasm }));
  }

  // Resolves with the worker's answer, which has `error` where it failed.
  ask(kind, task = {}) {
    return new Promise((resolve) => {
      const id = ++this.count;
      this.waiting.set(id, resolve);
      this.worker.postMessage({ ...task, kind, id });
    });
  }

  stop() {
    this.ended = true;
    this.worker.terminate();
    for (const answer of this.waiting.values()) answer({ stopped: true });
    this.waiting.clear();
  }
}
