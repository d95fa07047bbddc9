// Pictures, compared in a page: the browser decodes them.

// Returns a PNG file in base64 with two pictures of the same size beside each other.
export function sideBySide(page, one, other) {
  return page.evaluate(async (...pictures) => {
    const images = await Promise.all(pictures.map(async (png) =>
      createImageBitmap(new Blob([Uint8Array.from(atob(png), (c) => c.charCodeAt(0))], { type: "image/png" }))));
    const canvas = new OffscreenCanvas(2 * images[0].width + 4, images[0].height);
    images.forEach((image, i) => canvas.getContext("2d").drawImage(image, i * (image.width + 4), 0));
    const bytes = new Uint8Array(await (await canvas.convertToBlob({ type: "image/png" })).arrayBuffer());
    let text = "";
    for (const byte of bytes) text += String.fromCharCode(byte);
    return btoa(text);
  }, one, other);
}

// Returns the share of the pixels that differ by more than `tolerance` in a channel, and the mean
// difference of a channel. The arguments are PNG files in base64 of the same size.
export function differenceOf(page, one, other, tolerance) {
  return page.evaluate(async (a, b, limit) => {
    const pixels = async (png) => {
      const bytes = Uint8Array.from(atob(png), (c) => c.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const canvas = new OffscreenCanvas(image.width, image.height);
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      return { width: image.width, height: image.height, data: context.getImageData(0, 0, image.width, image.height).data };
    };
    const [first, second] = [await pixels(a), await pixels(b)];
    if (first.width !== second.width || first.height !== second.height)
      throw new Error(`${first.width} x ${first.height} and ${second.width} x ${second.height} pixels`);
    let differ = 0, sum = 0;
    for (let i = 0; i < first.data.length; i += 4) {
      let most = 0;
      for (let c = 0; c < 3; ++c) {
        const d = Math.abs(first.data[i + c] - second.data[i + c]);
        most = Math.max(most, d);
        sum += d;
      }
      if (most > limit) ++differ;
    }
    const count = first.width * first.height;
    return { share: differ / count, mean: sum / (3 * count) };
  }, one, other, tolerance);
}
