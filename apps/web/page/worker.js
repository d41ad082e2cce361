// Draws, in a thread of its own, by module/engine.js, which assemble.mjs puts ahead of this. One message is answered at a time.
let queue = Promise.resolve();
let files = new Map();  // by name, a File of the page or its bytes
let opened = null;      // {name, scene}
let last = null;        // {key, picture}

function forget_scene() {
  opened?.scene.free();
  opened = last = null;
}

// The task's scene, which stays open until another one is asked for.
async function scene_of({ scene: name, flags }) {
  if (opened?.name === name) return opened.scene;
  forget_scene();
  const others = new Map([...files].filter(([other]) => other !== name));
  const scene = await load(files.get(name) ?? name, { name, flags, files: others });
  opened = { name, scene };
  return scene;
}

const page_report = (core, handle) => core._halflit_page_report(handle);

async function picture_of(task) {
  const scene = await scene_of(task), key = [task.scene, ...task.flags].join("\n");
  if (last?.key !== key) last = { key, picture: await scene.drawn({ flags: task.flags }, (core, handle, words) => core._halflit_draw(handle, words), page_report) };
  return last.picture;
}

// The pixels stay here too, for the file of the picture.
const answer_of = ({ report, width, height, pixels }) => ({ report, width, height, pixels: pixels.buffer });

const tasks = {
  // wasm, wasm128: bytes. simd: false for the scalar kernels; otherwise those that the browser can run.
  async start({ wasm, wasm128, simd }) {
    set_code((name) => (name === "halflit.wasm" ? wasm : wasm128));
    return { isa: (await init(simd ? {} : { simd })).isa };
  },
  draw: async (task) => answer_of(await picture_of(task)),
  async compare(task) {
    const scene = await scene_of(task);
    return answer_of(await scene.drawn({ flags: task.flags }, (core, handle, words) => core._halflit_compare(handle, words), page_report));
  },
  png: async (task) => ({ file: (await picture_of(task)).png() }),
  lobe: ({ wrap, power, normalize, bands }) =>
    with_module((core) => ({ report: JSON.parse(core.UTF8ToString(core._halflit_lobe(wrap, power, normalize ? 1 : 0, bands))) })),
  files(task) {
    files = new Map(task.files.map(({ name, file }) => [name, file]));
    forget_scene();
    return {};
  },
};

onmessage = (event) => {
  const task = event.data;
  queue = queue.then(async () => {
    let answer;
    try {
      answer = await tasks[task.kind](task);
    } catch (error) {  // where the module or something else than the library failed, another worker goes on
      answer = { error: String(error.message || error), ended: !(error instanceof HalflitError) || await has_ended() };
    }
    postMessage({ ...answer, id: task.id });
  });
};
