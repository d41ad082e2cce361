// Workers that draw. The page has one for pictures, and a second one for comparisons with the reference, which take seconds.
const part_of = {};

// Bytes of a part of the page: base64 of gzip.
function unpacked(id) {
  part_of[id] ??= (async () => {
    const packed = Uint8Array.from(atob(document.getElementById(id).textContent.trim()), (c) => c.charCodeAt(0));
    return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  })();
  return part_of[id];
}

// Tasks are done in the order of ask(). An engine that ended is not used again.
class Engine {
  // name: "simd" or "scalar", of the kernels. A browser without SIMD has the scalar ones.
  constructor(name) {
    this.ended = false;
    this.waiting = new Map();
    this.count = 0;
    this.worker = null;
    this.started = this.start(name === "simd").catch((error) => {
      this.stop({ error: `this browser cannot start the library: ${error.message}`, ended: true });
      return this.last_answer;
    });
  }

  async start(simd) {
    const [code, wasm, wasm128] = await Promise.all(["worker_code", "main_wasm", "kernels_wasm"].map(unpacked));
    if (this.ended) return this.last_answer;
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
    return this.send("start", { wasm, wasm128, simd });
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
    this.worker?.terminate();
    for (const resolve of this.waiting.values()) resolve(answer);
    this.waiting.clear();
  }
}
