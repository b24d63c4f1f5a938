// Compares pictures; the page's own canvas reads the PNG files, so that no library is needed.

/** Runs `use(pixels, ..)` in the page on the pixels of PNG files. */
function withPixels(page, pictures, use) {
  return page.evaluate(async (files, body) => {
    const pixels = [];
    for (const file of files) {
      const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${file}`)).blob());
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
      context.drawImage(image, 0, 0);
      pixels.push(context.getImageData(0, 0, image.width, image.height).data);
    }
    return new Function("pixels", `return (${body})(pixels);`)(pixels);
  }, pictures.map((picture) => Buffer.from(picture).toString("base64")), String(use));
}

/** The share of pixels that differ visibly: by more than 24 of 255 in a channel. 1 if the sizes differ. */
export const difference = (page, a, b) => withPixels(page, [a, b], ([p, q]) => {
  if (p.length !== q.length) return 1;
  let differing = 0;
  for (let i = 0; i < p.length; i += 4) {
    if (Math.max(Math.abs(p[i] - q[i]), Math.abs(p[i + 1] - q[i + 1]), Math.abs(p[i + 2] - q[i + 2])) > 24) ++differing;
  }
  return (4 * differing) / p.length;
});

/** How many shades a picture has, sixteen to a channel. */
export const shades = (page, picture) => withPixels(page, [picture], ([p]) => {
  const seen = new Set();
  for (let i = 0; i < p.length; i += 4) seen.add((p[i] >> 4) | ((p[i + 1] >> 4) << 4) | ((p[i + 2] >> 4) << 8));
  return seen.size;
});
