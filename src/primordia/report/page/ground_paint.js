// Paint the space-time picture: one pixel of a buffer for each column and each row of the screen.

function paintGround(context, box, world, view, lit, palette) {
  const ratio = window.devicePixelRatio || 1;
  const first = Math.floor(view.left);
  const columns = Math.min(Math.ceil(view.right), world.shown) - first;
  const rows = Math.max(Math.round(box.height * ratio), 1);
  const buffer = element("canvas", { width: columns, height: rows });
  const image = new ImageData(columns, rows);
  fillPixels(new Uint32Array(image.data.buffer), columns, rows, first, world, view, lit, colourTable(palette));
  buffer.getContext("2d").putImageData(image, 0, 0);
  const scale = box.width / (view.right - view.left);
  context.save();
  context.beginPath();
  context.rect(box.left, box.top, box.width, box.height);
  context.clip();
  context.imageSmoothingEnabled = columns * scale < columns;
  context.drawImage(buffer, box.left + (first - view.left) * scale, box.top, columns * scale, box.height);
  context.restore();
}

function fillPixels(pixels, columns, rows, first, world, view, lit, colours) {
  const { organism, start, stop, ink } = world.segments;
  const places = placesOfRows(rows, world, view);
  for (let x = 0; x < columns; x++) {
    const end = world.firstOf[first + x + 1];
    let at = Math.max(lastUpTo(start, places[0], world.firstOf[first + x], end), world.firstOf[first + x]);
    for (let y = 0; y < rows; y++) {
      while (at < end && stop[at] <= places[y]) at++;
      const there = at < end && start[at] <= places[y];
      const state = lit && there ? lit[organism[at]] : 0;
      pixels[y * columns + x] = there ? colours[state][ink[at]] : colours.empty;
    }
  }
}

// The time in births that each row of pixels shows: a moment at which the cells were looked at.
function placesOfRows(rows, world, view) {
  const height = (view.bottom - view.top) / rows;
  return Float64Array.from({ length: rows }, (_, y) =>
    world.moments[momentAt(world, view.top + (y + 0.5) * height)]);
}

// Pixels of all inks, as they are and as they are when a line of descent is lit.
function colourTable(palette) {
  const ground = rgbOf(variable("--empty"));
  const pixel = ([red, green, blue]) => (255 << 24) | (blue << 16) | (green << 8) | red;
  const all = (share) => Uint32Array.from(palette, (rgb) => pixel(mixed(rgb, ground, share)));
  const half = palette.length / 2;
  const strong = Uint32Array.from(palette, (_, ink) => pixel(palette[ink % half]));
  const table = [all(0), all(0.86), strong, all(0.35)];
  table.empty = pixel(ground) >>> 0;
  return table;
}
