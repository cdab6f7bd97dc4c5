// The phylogeny of the living: a bar for each node, time across, one level for each of the living.

function treeSection(world, palette, chosen, show) {
  const { tree } = world;
  const some = tree.shown < tree.living ? `; ${whole(tree.shown)} of the living are shown, spread over the cells` : "";
  const about = `The ${whole(tree.living)} living organisms, and the ancestors at which their lines part${some}.`
    + " Time runs to the right, in births"
    + (islandsOf(world).length ? "; the colour shows the island on which an organism lives."
      : tree.traits ? "." : "; strong lines last to the present.");
  const drawing = element("div", { class: "tree", tabindex: 0, role: "group", "aria-label":
    "Phylogeny of the living. Keys: up and down choose a living organism, Enter shows this organism in the space-time picture." });
  const readout = element("p", { class: "readout", "aria-live": "polite" }, "\u00a0");
  const state = { at: -1, trait: -1 };
  const tellNode = (at) => {
    state.at = at;
    readout.textContent = at < 0 ? "\u00a0" : nodeText(tree.nodes, at, islandsOf(world)) + traitText(tree, tree.nodes[at]);
    markLine(drawing, tree.nodes, at);
  };
  const showNode = (at) => {
    const organism = organismOf(world, tree.nodes[at].number);
    if (organism >= 0) show(organism);
  };
  const draw = () => {
    if (!drawing.clientWidth) return;
    drawing.replaceChildren(drawnTree(world, palette, drawing.clientWidth, state.trait, tellNode, showNode));
    markLine(drawing, tree.nodes, state.at);
  };
  onWidth(drawing, draw);
  painters.add(draw);
  treeKeys(drawing, tree.nodes, state, tellNode, showNode);
  const keys = world.islands ? [islandsKey(world.islands)] : [];
  if (tree.traits) keys.push(traitControl(tree, world.islands ? "island" : "line of descent", state, draw));
  return section("Phylogeny of the living", about, ...keys, drawing, readout,
    element("p", { class: "hint" }, "Move over a line to read its organism; click to see the organism in the space-time picture."));
}

// Mark an organism's line of descent: its bar, and those of all its ancestors.
function markLine(drawing, nodes, at) {
  drawing.querySelectorAll(".on").forEach((each) => each.classList.remove("on"));
  for (let up = at; up >= 0; up = nodes[up].parent) {
    drawing.querySelectorAll(`[data-node="${up}"]`).forEach((each) => each.classList.add("on"));
  }
}

function nodeText(nodes, at, islands = []) {
  const { number, born, alive, skipped, parent, island } = nodes[at];
  const where = islands.length ? `, on ${islands[island].name}` : "";
  const line = parent < 0 ? "no parent on record"
    : `${skipped + 1} generation${skipped ? "s" : ""} from organism ${whole(nodes[parent].number)}`;
  return `organism ${whole(number)}, born at tick ${whole(born)}${where}, ${alive ? "alive" : "an ancestor"}, ${line}`;
}

function treeKeys(drawing, nodes, state, tellNode, showNode) {
  const living = nodes.map((node, at) => at).filter((at) => nodes[at].alive);
  living.sort((one, other) => nodes[one].level - nodes[other].level);
  drawing.addEventListener("keydown", (event) => {
    const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (step) {
      const next = living.indexOf(state.at) + step;
      tellNode(living[Math.min(Math.max(next, 0), living.length - 1)]);
      event.preventDefault();
    } else if (event.key === "Enter" && state.at >= 0) showNode(state.at);
  });
}

function drawnTree(world, palette, width, trait, tellNode, showNode) {
  const { nodes, shown } = world.tree;
  const gap = Math.min(Math.max(420 / shown, 3), 14);
  const [left, right, top] = [4, 4, 24];
  const height = top + gap * shown + 6;
  const x = (place) => left + (place / world.births) * (width - left - right);
  const y = (level) => top + (level + 0.5) * gap;
  const svg = shape("svg", { width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": true });
  svg.append(...timeGrid(world, x, height, width));
  const colourOf = barColours(world, palette, trait);
  nodes.forEach((node, at) => {
    const bar = `M${x(node.start)} ${y(node.level)}H${Math.max(x(node.stop), x(node.start) + 1)}`;
    const rise = node.parent < 0 ? "" : `M${x(node.start)} ${y(nodes[node.parent].level)}V${y(node.level)}`;
    const faint = world.islands && trait < 0 && !node.alive;
    const lines = { "data-node": at };
    svg.append(
      shape("path", { ...lines, class: "line", d: rise }),
      shape("path", { ...lines, class: "bar", d: bar, stroke: colourOf(node), "stroke-opacity": faint ? 0.55 : null, "stroke-width": Math.max(Math.min(gap * 0.5, 5), 1.5) }),
      shape("path", { class: "hit", d: bar + rise, "stroke-width": gap, pointerenter: () => tellNode(at),
        click: () => showNode(at) }));
  });
  return svg;
}

// The colour of each organism: of a trait, or of its island, or of its line if it is alive.
function barColours(world, palette, trait) {
  const { nodes, traits } = world.tree;
  if (trait >= 0) {
    const range = traitRange(nodes, trait);
    return (node) => curveColour(traitColour(traits.scale, range, node.traits[trait]));
  }
  if (world.islands) return (node) => curveColour(world.islands[node.island].colour);
  const colours = inks(palette);
  return (node) => (node.alive ? css(colours[node.ink]) : variable("--soft"));
}

function timeGrid(world, x, height, width) {
  const view = { top: 0, bottom: world.births };
  const places = ticksInView(world, view, width / 3);
  return places.flatMap(([place, tick]) => [
    shape("line", { class: "grid", x1: x(place), x2: x(place), y1: 18, y2: height }),
    shape("text", { x: x(place), y: 11, "text-anchor": x(place) < 20 ? "start" : x(place) > width - 40 ? "end" : "middle" },
      `tick ${short(tick)}`),
  ]);
}
