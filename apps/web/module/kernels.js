// Starts the module, and puts the kernels of wasm128, a module of their own, into its memory and its table of functions.
const kKernelStack = 1 << 16;  // bytes: twenty times the largest frame of a kernel

// Needs of the kernels, by the linker's section dylink.0: a type, a length, and as LEB128 the bytes, log2 of their alignment, functions.
function needs_of(module) {
  const section = new Uint8Array(WebAssembly.Module.customSections(module, "dylink.0")[0]);
  let at = 2;
  const number = () => {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      value |= (section[at] & 127) << shift;
      if (section[at++] < 128) return value;
    }
  };
  return { bytes: number(), align: 1 << number(), functions: number() };
}

// They have a stack of their own, and call nothing.
async function add_kernels(core, exports, module) {
  const of_kind = (kind) => Object.values(exports).find((value) => value instanceof kind);
  const needs = needs_of(module), table = of_kind(WebAssembly.Table), memory = of_kind(WebAssembly.Memory), size = needs.bytes + needs.align;
  const room = core._halflit_allocate(size), stack = core._halflit_allocate(kKernelStack + 16);
  if (!room || !stack) throw new Error("out of memory");
  core.HEAPU8.fill(0, room, room + size);
  const global = (value, mutable = false) => new WebAssembly.Global({ value: "i32", mutable }, value);
  const { exports: found } = await WebAssembly.instantiate(module, { env: {
    memory, __indirect_function_table: table, __stack_pointer: global((stack + kKernelStack) & ~15, true),
    __memory_base: global(Math.ceil(room / needs.align) * needs.align), __table_base: global(table.grow(needs.functions)),
  } });
  core._halflit_use_wasm128(found.halflit_raster_kernels(), found.halflit_shade_kernels());
}

// make: Emscripten's function. module, kernels: compiled; without kernels the scalar ones draw.
export async function start_module(make, module, kernels) {
  let exports = null;
  const core = await new Promise((resolve, reject) => {
    const instantiateWasm = (imports, done) => {
      WebAssembly.instantiate(module, imports).then((instance) => {
        exports = instance.exports;
        done(instance, module);
      }).catch(reject);
      return {};
    };
    make({ instantiateWasm, print() {}, printErr() {} }).then(resolve, reject);
  });
  if (kernels) await add_kernels(core, exports, kernels);
  return core;
}
