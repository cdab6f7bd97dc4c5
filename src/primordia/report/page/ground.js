// The space-time picture with its controls: wheel, drag, pinch, keys and buttons.

const KEY_STEPS = {
  ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, -0.15], ArrowDown: [0, 0.15],
  PageUp: [0, -0.8], PageDown: [0, 0.8],
};

function groundFigure(world, palette, chosen, kept) {
  const hint = "Click a cell to see who lived there.";
  const keys = "Drag to move. After a click, the wheel zooms. Keys: arrows, +, − and 0.";
  const canvas = element("canvas", { id: "ground", tabindex: 0, role: "img", "aria-label":
    `Space and time: ${whole(world.cells)} cells across, ${whole(world.births)} births downwards, coloured by`
    + ` line of descent. ${keys} Organisms can also be chosen by their number beside the picture.` });
  const readout = element("p", { class: "readout" }, "\u00a0");
  const figure = { world, palette, chosen, canvas, readout, view: kept.view || wholeView(world) };
  figure.paint = () => paintFigure(figure);
  figure.show = (view) => {
    figure.view = view;
    kept.view = isWhole(world, view) ? null : view;
    figure.paint();
  };
  figure.zoom = (way, x, y) =>
    figure.show(way === "all" ? wholeView(world) : zoomedView(world, figure.view, way === "in" ? 0.6 : 1 / 0.6, x, y));
  groundPointer(figure);
  groundKeys(figure);
  onWidth(canvas, figure.paint);
  painters.add(figure.paint);
  figure.element = element("div", { class: "picture ground" },
    element("div", { class: "bar split" }, element("span", { class: "hint" }, hint),
      zoomButtons("the space-time picture", figure.zoom)),
    canvas, readout, element("p", { class: "hint" }, keys));
  return figure;
}

function paintFigure({ world, palette, chosen, canvas, view }) {
  if (!canvas.clientWidth) return;
  const context = sharp(canvas);
  const box = boxOf(canvas);
  const colours = inks(palette);
  paintGround(context, box, world, view, chosen.lit, colours);
  drawMarks(context, box, world, view);
  if (chosen.organism >= 0) drawDescent(context, box, world, view, chosen.organism);
  drawAxes(context, box, world, view);
  drawIslands(context, box, world, view);
  canvas.classList.toggle("zoomed", !isWhole(world, view));
}

// The column and time in births under a pointer, and as shares of the view; null outside of the picture.
function under(figure, event) {
  const { canvas, view, world } = figure;
  const box = boxOf(canvas);
  const x = (event.offsetX - box.left) / box.width;
  const y = (event.offsetY - box.top) / box.height;
  if (x < 0 || x >= 1 || y < 0 || y >= 1) return null;
  const column = Math.floor(view.left + x * (view.right - view.left));
  const place = view.top + y * (view.bottom - view.top);
  return { x, y, column, place, segment: segmentAt(world, column, place) };
}

function tell(figure, event) {
  const { world, readout } = figure;
  const at = under(figure, event);
  if (!at) return void (readout.textContent = "\u00a0");
  const tick = tickAt(world, at.place);
  const where = `cell ${whole(at.column * world.step)}${onIsland(world, at.column * world.step)}, birth ${whole(at.place + 1)}, tick ${whole(tick)}: `;
  if (at.segment < 0) return void (readout.textContent = `${where}empty`);
  const organism = world.segments.organism[at.segment];
  const age = tick - (world.facts.born[organism] + world.facts.first);
  readout.textContent = `${where}organism ${whole(world.facts.number[organism])}, age ${whole(age)}`;
}

function groundKeys(figure) {
  figure.canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = KEY_STEPS[event.key];
    const way = { "+": "in", "=": "in", "-": "out", 0: "all" }[event.key];
    if (!step && !way) return;
    event.preventDefault();
    if (step) figure.show(movedView(figure.world, figure.view, ...step));
    else figure.zoom(way);
  });
}
