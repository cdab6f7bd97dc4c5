// Islands: parts of a world's cells with a habitat and rates of their own. A plain world has none.

const islandsOf = (world) => world.islands || [];

const islandOf = (world, cell) => islandsOf(world).find(({ first, last }) => first <= cell && cell <= last);

// ", on NAME" for a cell of an island; nothing in a plain world.
function onIsland(world, cell) {
  const island = islandOf(world, cell);
  return island ? `, on ${island.name}` : "";
}

function islandsSection({ about, places, table }) {
  return section("Islands", about, islandsKey(places), wideTable(table));
}

function islandsKey(places) {
  const key = element("ul", { class: "key" });
  const fill = () => key.replaceChildren(...places.map(({ name, colour }) => {
    const mark = element("i", {});
    mark.style.background = curveColour(colour);
    return element("li", {}, mark, name);
  }));
  fill();
  painters.add(fill);
  return key;
}

// Borders in the space-time picture, and names above it where they have room.
function drawIslands(context, box, world, view) {
  const { x } = scalesOf(box, view);
  context.font = "600 11px system-ui, sans-serif";
  context.textBaseline = "middle";
  for (const { name, colour, first, last } of islandsOf(world)) {
    const left = Math.max(x(first / world.step), box.left);
    const right = Math.min(x((last + 1) / world.step), box.left + box.width);
    if (right <= left) continue;
    context.fillStyle = variable("--ground");
    if (left > box.left) context.fillRect(left - 1.5, box.top, 3, box.height);
    context.fillStyle = variable("--ink");
    if (left > box.left) context.fillRect(left - 0.5, box.top, 1, box.height);
    context.fillStyle = curveColour(colour);
    context.fillRect(left + 1, box.top - 4, right - left - 2, 2);
    if (context.measureText(name).width + 4 < right - left) label(context, name, (left + right) / 2, box.top - 12, "center");
  }
}

// Bands over the pictures of a torus, whose islands are whole rows.
function islandBands(world) {
  const bands = islandsOf(world).map(({ name, first }) => {
    const band = element("span", {}, element("b", {}, name));
    band.style.top = `${(100 * first) / world.cells}%`;
    return band;
  });
  return element("div", { class: "bands", "aria-hidden": true }, ...bands);
}
