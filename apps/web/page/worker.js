// Draws, in a thread of its own. It follows the module's own code, which defines halflit_module(), and kernels.js. One message is answered at a time.
"use strict";

let core = null;  // the module
let queue = Promise.resolve();

// Memory of the module, for the caller to free. Where something is thrown, the worker ends, and all of its memory with it.
function allocate(size) {
  const place = core._halflit_allocate(size || 1);
  if (!place) throw new Error("out of memory");
  return place;
}

function on_heap(bytes) {
  const place = allocate(bytes.length);
  core.HEAPU8.set(bytes, place);
  return place;
}

function with_texts(texts, call) {
  const places = texts.map((text) => {
    const size = core.lengthBytesUTF8(text) + 1;
    const place = allocate(size);
    core.stringToUTF8(text, place, size);
    return place;
  });
  const result = call(...places);
  places.forEach(core._halflit_free);
  return result;
}

// The picture's pixels count as they are stored: no rotation by Exif and no colour profile, as glTF asks. So those segments are cut out.
function plain_jpeg(bytes) {
  if (bytes[0] !== 0xff || bytes[1] !== 0xd8) return bytes;
  const parts = [bytes.subarray(0, 2)];
  let at = 2;
  while (at + 4 <= bytes.length && bytes[at] === 0xff && bytes[at + 1] !== 0xda) {
    if (bytes[at + 1] === 0xff) {  // a fill byte before a marker
      ++at;
      continue;
    }
    const end = at + 2 + ((bytes[at + 2] << 8) | bytes[at + 3]);
    if (bytes[at + 1] !== 0xe1 && bytes[at + 1] !== 0xe2) parts.push(bytes.subarray(at, end));
    at = end;
  }
  parts.push(bytes.subarray(at));
  return new Blob(parts);
}

async function decoded(bytes) {
  const options = { premultiplyAlpha: "none", colorSpaceConversion: "none" };
  const bitmap = await createImageBitmap(new Blob([plain_jpeg(bytes)]), options), { width, height } = bitmap;
  const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return context.getImageData(0, 0, width, height);
}

// Has the browser decode what the last attempt lacked. False: it lacked nothing.
async function give_pictures() {
  const count = core._halflit_wanted_count();
  for (let i = 0; i < count; ++i) {
    const start = core._halflit_wanted(i);
    const bytes = core.HEAPU8.slice(start, start + core._halflit_wanted_size(i));
    let picture = { width: 0, height: 0, data: new Uint8Array(0) };
    try {
      picture = await decoded(bytes);
    } catch (error) {
      console.warn(error);
    }
    const place = on_heap(picture.data);
    core._halflit_give_picture(i, picture.width, picture.height, place);
    core._halflit_free(place);
  }
  return count > 0;
}

async function picture_of(call, task) {
  if (task.flags.some((word) => /[\n\0]/.test(word))) return { error: "a flag with a line break", code: 2 };
  const attempt = () => with_texts([task.scene, task.flags.join("\n")], call);
  let code = attempt();
  if (code !== 0 && (await give_pictures())) code = attempt();
  if (code !== 0) return { error: core.UTF8ToString(core._halflit_message()), code };
  const start = core._halflit_pixels();
  const report = JSON.parse(core.UTF8ToString(core._halflit_report()));
  const width = core._halflit_width(), height = core._halflit_height();
  return { report, width, height, pixels: core.HEAPU8.slice(start, start + 4 * width * height).buffer };
}

const tasks = {
  async start(task) {
    const [module, kernels] = await Promise.all([task.wasm, task.wasm128].map((bytes) => bytes && WebAssembly.compile(bytes)));
    core = await start_module(halflit_module, module, kernels);
    return {};
  },
  draw: (task) => picture_of(core._halflit_draw, task),
  compare: (task) => picture_of(core._halflit_compare, task),
  lobe: (task) => ({ report: JSON.parse(core.UTF8ToString(core._halflit_lobe(task.wrap, task.power, task.normalize ? 1 : 0, task.bands))) }),
  files(task) {
    core._halflit_forget_files();
    for (const file of task.files) {
      const place = on_heap(new Uint8Array(file.bytes));
      with_texts([file.name], (name) => core._halflit_add_file(name, place, file.bytes.byteLength));
      core._halflit_free(place);
    }
    return {};
  },
};

onmessage = (event) => {
  const task = event.data;
  queue = queue.then(async () => {
    let answer;
    try {
      answer = await tasks[task.kind](task);
    } catch (error) {  // the module ended; C++ throws here only where memory ends
      const of_code = WebAssembly.Exception !== undefined && error instanceof WebAssembly.Exception;
      answer = { error: of_code ? "out of memory" : String(error.message || error), ended: true };
    }
    postMessage({ ...answer, id: task.id }, answer.pixels ? [answer.pixels] : []);
  });
};
