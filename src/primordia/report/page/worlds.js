// The pictures of one world at a time: space-time, film, phylogeny; and which world is shown.

function worldsSection(content, kept) {
  const body = element("div");
  const select = element("select", { id: "world" },
    ...content.worlds.map(({ name }, at) => element("option", { value: at, selected: at === kept.world }, name)));
  select.addEventListener("change", () => {
    Object.assign(kept, { world: Number(select.value), view: null, number: null });
    fillWorld(body, content, kept);
  });
  const several = content.worlds.length > 1;
  const bar = element("div", { class: "bar" }, element("label", { for: "world" }, "World"), select,
    element("span", { class: "hint" }, content.left_out));
  const filled = fillWorld(body, content, kept);
  return { element: element("div", {}, ...(several || content.left_out ? [section("Worlds", "", bar)] : []), body), filled };
}

async function fillWorld(body, content, kept) {
  const world = await readWorld(content.worlds[kept.world]);
  const chosen = choice(world, kept);
  const figure = groundFigure(world, content.palette, chosen, kept);
  const show = (organism) => {
    chosen.set(organism);
    const extent = extentOf(world, organism);
    if (extent) figure.show(viewWith(world, figure.view, extent.column, extent.start));
  };
  const card = organismCard(world, chosen, show);
  chosen.listen(figure.paint);
  const parts = [section("Space and time", groundText(world),
    element("div", { class: "beside" }, figure.element, card))];
  if (world.film) parts.push(await filmSection(world, content.palette, chosen, show));
  if (world.tree) parts.push(treeSection(world, content.palette, chosen, show));
  body.replaceChildren(...parts);
  const before = kept.number == null ? -1 : organismOf(world, kept.number);
  if (before >= 0) chosen.set(before);
}

function groundText({ topology, cells, shown, whole: complete }) {
  const order = { ring: "in the order of the ring", "well-mixed": "all neighbours of each other" };
  const across = order[topology] || "row after row of the torus";
  const some = shown < cells ? ` ${whole(shown)} of ${whole(cells)} cells are shown.` : "";
  const seen = complete ? "" : " The picture shows the cells after some of the births only; shorter lives may be missing.";
  return `Cells lie across, ${across}; births run downwards. Each colour is a line of descent: strong if the line lasted,`
    + ` pale if the line died out; gaps are empty cells.${some}${seen}`;
}
