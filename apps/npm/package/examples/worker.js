// A worker that draws thumbnails: POST a model, with options as the query: /?width=320&height=240&view=iso. The answer is a PNG.
import { HalflitError, render } from "halflit";

const kOptions = ["view", "up", "background", "env", "tonemap", "edges"];  // those that cannot make a picture expensive
const kMostSide = 1024, kMostBytes = 32 << 20, kSeconds = 10;

function options_of(query) {
  const options = { samples: 4, timeout: kSeconds, maxTexturePixels: 1 << 24, width: 256, height: 256 };
  for (const name of kOptions) if (query.has(name)) options[name] = query.get(name);
  for (const name of ["width", "height"]) if (query.has(name)) options[name] = Math.min(kMostSide, Number(query.get(name)));
  return options;
}

export default {
  async fetch(request) {
    if (request.method !== "POST") return new Response("POST a model\n", { status: 405 });
    try {
      const model = await request.arrayBuffer();
      if (model.byteLength > kMostBytes) return new Response("the model is too large\n", { status: 413 });
      const picture = await render(model, options_of(new URL(request.url).searchParams));
      return new Response(picture.png(), { headers: { "content-type": "image/png", etag: `"${picture.hash}"` } });
    } catch (error) {
      if (!(error instanceof HalflitError)) throw error;
      return new Response(`${error.message}\n`, { status: error.code === 5 ? 413 : 400 });
    }
  },
};
