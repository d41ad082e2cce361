// The lobe's curve with its series, the bands, and the colours of the error map.
const kRamp = [[0, 0, 4], [40, 11, 84], [101, 21, 110], [159, 42, 99], [212, 72, 66], [245, 125, 21], [250, 193, 39], [252, 255, 164]];

// share: 0 to 1.
function heat_color(share) {
  const at = Math.max(0, Math.min(1, share)) * (kRamp.length - 1), i = Math.min(kRamp.length - 2, Math.floor(at));
  return kRamp[i].map((low, c) => Math.round(low + (at - i) * (kRamp[i + 1][c] - low)));
}

// pixels: each channel is its error, 255 the largest of the picture.
function heat_picture(pixels, width, height) {
  const image = new ImageData(width, height), colors = Array.from({ length: 256 }, (_, i) => heat_color(i / 255));
  for (let i = 0; i < pixels.length; i += 4) {
    const color = colors[Math.max(pixels[i], pixels[i + 1], pixels[i + 2])];
    image.data.set(color, i);
    image.data[i + 3] = 255;
  }
  return image;
}

// A canvas's context with one unit for each CSS pixel.
function context_of(canvas) {
  const box = canvas.getBoundingClientRect(), scale = window.devicePixelRatio || 1;
  canvas.width = Math.round(box.width * scale);
  canvas.height = Math.round(box.height * scale);
  const context = canvas.getContext("2d");
  context.scale(scale, scale);
  return { context, width: box.width, height: box.height };
}

// curves: reports of halflit_lobe(); the last one also has its series drawn. bands: of the series.
function draw_curves(canvas, curves, bands, with_series) {
  const { context, width, height } = context_of(canvas), style = getComputedStyle(document.documentElement);
  const ink = style.getPropertyValue("--ink"), faint = style.getPropertyValue("--line"), accent = style.getPropertyValue("--accent");
  const quiet = style.getPropertyValue("--quiet");
  const left = 26, right = width - 6, top = 8, bottom = height - 18;
  const values = curves.flatMap((c) => c.f).concat(with_series ? curves[curves.length - 1].series : []);
  const most = Math.max(1, ...values) * 1.04, least = Math.min(0, ...values);
  const x_of = (degrees) => left + (degrees / 180) * (right - left);
  const y_of = (value) => bottom - ((value - least) / (most - least)) * (bottom - top);
  context.font = "10px system-ui, sans-serif";
  context.lineWidth = 1;
  context.strokeStyle = faint;
  context.fillStyle = ink;
  context.textAlign = "center";
  for (const degrees of [0, 45, 90, 135, 180]) {
    context.beginPath();
    context.moveTo(x_of(degrees), top);
    context.lineTo(x_of(degrees), bottom);
    context.stroke();
    context.fillText(`${degrees}°`, Math.min(x_of(degrees), right - 8), height - 5);
  }
  context.textAlign = "right";
  for (const value of [0, 0.5, 1]) {
    context.beginPath();
    context.moveTo(left, y_of(value));
    context.lineTo(right, y_of(value));
    context.stroke();
    context.fillText(value, left - 4, y_of(value) + 3);
  }
  const line = (samples, color, thick, dash) => {
    context.beginPath();
    context.setLineDash(dash);
    context.strokeStyle = color;
    context.lineWidth = thick;
    samples.forEach((value, i) => {
      const cosine = (2 * i) / (samples.length - 1) - 1;
      context.lineTo(x_of((Math.acos(cosine) * 180) / Math.PI), y_of(value));
    });
    context.stroke();
    context.setLineDash([]);
  };
  const cosine = Array.from({ length: 181 }, (_, i) => Math.max(0, (2 * i) / 180 - 1));
  line(cosine, quiet, 2, []);
  for (const curve of curves) line(curve.f, accent, 2, []);
  if (with_series) line(curves[curves.length - 1].series, ink, 1.2, [4, 3]);
}

// Bars of the ten bands; those of the series are filled.
function draw_bands(canvas, factors, bands) {
  const { context, width, height } = context_of(canvas), style = getComputedStyle(document.documentElement);
  const ink = style.getPropertyValue("--ink"), accent = style.getPropertyValue("--accent"), faint = style.getPropertyValue("--line");
  const most = Math.max(1, ...factors.map(Math.abs)), least = Math.min(0, ...factors), top = 14, bottom = height - 14;
  const y_of = (value) => bottom - ((value - least) / (most - least)) * (bottom - top);
  const step = (width - 26) / factors.length;
  context.font = "9px system-ui, sans-serif";
  context.textAlign = "center";
  factors.forEach((value, band) => {
    const x = 26 + band * step;
    context.fillStyle = band < bands ? accent : faint;
    context.fillRect(x + 2, Math.min(y_of(0), y_of(value)), step - 4, Math.max(1, Math.abs(y_of(value) - y_of(0))));
    context.fillStyle = ink;
    context.fillText(value === 0 ? "0" : Math.abs(value) < 0.005 ? value.toExponential(0) : value.toFixed(2), x + step / 2, Math.min(y_of(0), y_of(value)) - 3);
    context.fillText(band, x + step / 2, height - 2);
  });
}
