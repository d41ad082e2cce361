// A worker that draws thumbnails: POST a model, with options as the query: /?width=320&height=240&view=iso. The answer is a PNG.
import { HalflitError, init, memory, render } from "halflit";

const kOptions = ["view", "up", "background", "env", "tonemap", "edges"];  // those that cannot make a picture expensive
const kMostSide = 1024, kMostBytes = 32 << 20, kMostGeometry = 48 << 20, kMostMemory = 80 << 20;  // of the 128 MB that a worker has
const kSeconds = 10;

function options_of(query) {
  const options = { samples: 4, timeout: kSeconds, maxTexturePixels: 1 << 22, maxTextureBytes: 32 << 20, maxGeometryBytes: kMostGeometry, width: 256, height: 256 };
  for (const name of kOptions) if (query.has(name)) options[name] = query.get(name);
  for (const name of ["width", "height"]) if (query.has(name)) options[name] = Math.min(kMostSide, Number(query.get(name)));
  return options;
}

// The body's bytes, or null where it has more than kMostBytes: what is beyond them is not read.
async function body_of(request) {
  if (Number(request.headers.get("content-length")) > kMostBytes) return null;
  const reader = request.body?.getReader(), parts = [];
  let size = 0;
  for (let part; reader && !(part = await reader.read()).done;) {
    size += part.value.length;
    if (size > kMostBytes) {
      await reader.cancel();
      return null;
    }
    parts.push(part.value);
  }
  return new Blob(parts).arrayBuffer();
}

export default {
  async fetch(request) {
    if (request.method !== "POST") return new Response("POST a model\n", { status: 405 });
    try {
      const model = await body_of(request);
      if (model === null) return new Response("the model is too large\n", { status: 413 });
      if (await memory() > kMostMemory) await init({});  // a module never gives memory back, so a new one takes its place
      const picture = await render(model, options_of(new URL(request.url).searchParams));
      return new Response(picture.png(), { headers: { "content-type": "image/png", etag: `"${picture.hash}"` } });
    } catch (error) {
      if (!(error instanceof HalflitError)) throw error;
      return new Response(`${error.message}\n`, { status: error.code === 5 ? 413 : 400 });
    }
  },
};
