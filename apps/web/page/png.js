// A PNG of pixels as they are. A canvas would multiply colours by alpha on the way.
const kCrc = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let k = 0; k < 8; ++k) n = n & 1 ? (n >>> 1) ^ 0xedb88320 : n >>> 1;
  return n;
});

function png_chunk(type, data) {
  const chunk = new Uint8Array(12 + data.length), view = new DataView(chunk.buffer);
  view.setUint32(0, data.length);
  for (let i = 0; i < 4; ++i) chunk[4 + i] = type.charCodeAt(i);
  chunk.set(data, 8);
  let crc = ~0;
  for (let i = 4; i < 8 + data.length; ++i) crc = kCrc[(crc ^ chunk[i]) & 255] ^ (crc >>> 8);
  view.setUint32(8 + data.length, ~crc);
  return chunk;
}

// rgba: Uint8Array of width * height * 4. Opaque pictures are RGB, as those of `halflit render`.
async function png_of(rgba, width, height) {
  let opaque = true;
  for (let i = 3; i < rgba.length && opaque; i += 4) opaque = rgba[i] === 255;
  const channels = opaque ? 3 : 4, rows = new Uint8Array(height * (1 + channels * width));
  for (let y = 0, to = 0; y < height; ++y) {
    rows[to++] = 0;  // no filter
    for (let x = 0; x < width; ++x) for (let c = 0; c < channels; ++c) rows[to++] = rgba[4 * (y * width + x) + c];
  }
  const packed = new Response(new Blob([rows]).stream().pipeThrough(new CompressionStream("deflate")));
  const header = new Uint8Array(13), view = new DataView(header.buffer);
  view.setUint32(0, width);
  view.setUint32(4, height);
  header.set([8, opaque ? 2 : 6, 0, 0, 0], 8);
  return new Blob([new Uint8Array([137, 80, 78, 71, 13, 10, 26, 10]), png_chunk("IHDR", header),
    png_chunk("IDAT", new Uint8Array(await packed.arrayBuffer())), png_chunk("IEND", new Uint8Array(0))], { type: "image/png" });
}
