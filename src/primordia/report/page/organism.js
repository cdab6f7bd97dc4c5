// The organism that is chosen, and the card that tells its life.

const MOST_CHILDREN = 10;

function choice(world, kept) {
  const listeners = [];
  const chosen = { organism: -1, lit: null };
  chosen.set = (organism) => {
    chosen.organism = organism;
    chosen.lit = litBy(world, organism);
    kept.number = organism < 0 ? null : world.facts.number[organism];
    listeners.forEach((listener) => listener(organism));
  };
  chosen.listen = (listener) => listeners.push(listener);
  return chosen;
}

function organismCard(world, chosen, show) {
  const body = element("div", { "aria-live": "polite" });
  const input = element("input", { type: "number", min: 0, step: 1, id: "number" });
  const form = element("form", { class: "bar", submit: (event) => {
    event.preventDefault();
    const found = organismOf(world, Number(input.value));
    if (input.value === "" || found < 0) body.replaceChildren(...unknown(world, input.value));
    else show(found);
  } }, element("label", { for: "number" }, "Organism"), input, element("button", {}, "Show"));
  const fill = () => body.replaceChildren(...card(world, chosen.organism, show));
  chosen.listen(fill);
  fill();
  return element("aside", { class: "organism", "aria-label": "The chosen organism" }, body,
    element("div", { class: "bar" }, ...shortcuts(world, show)), form);
}

function unknown(world, text) {
  const why = world.whole ? "was not born in this world" : "is not in this picture";
  return [element("h3", {}, "No such organism"), element("p", {}, text ? `Organism ${text} ${why}.` : "Give a birth number.")];
}

function shortcuts(world, show) {
  const { lifespan } = world.facts;
  const longest = lifespan.reduce((best, life, at) => (life > lifespan[best] ? at : best), 0);
  const button = (text, at) => element("button", { type: "button", click: () => show(at) }, text);
  return [button("The first", 0), button("The longest-lived", longest)];
}

function card(world, at, show) {
  if (at < 0) {
    return [element("h3", {}, "No organism is chosen"),
      element("p", {}, "Click a cell of the picture, or choose an organism here. Then its ancestors are lit and joined"
        + " by a line; its descendants are half lit.")];
  }
  const { facts } = world;
  const cause = facts.cause[at] ? facts.causes[facts.cause[at] - 1] : null;
  const born = facts.born[at] + facts.first;
  const life = `${whole(facts.lifespan[at])} ticks${simulated(facts.lifespan[at], world.rate)}`;
  const rows = {
    Born: `tick ${whole(born)}, ${{ founder: "a founder", copy: "an exact copy", mutant: "with mutations" }[facts.origins[facts.origin[at]]]}`,
    Cell: whole(facts.cell[at]) + onIsland(world, facts.cell[at]),
    [cause ? "Lived" : "Age"]: life,
    [cause ? "Died" : "State"]: cause ? `tick ${whole(born + facts.lifespan[at])}, ${cause}` : "alive",
    Parent: parentOf(world, at, show),
    Generation: whole(facts.generation[at]),
    Children: childrenOf(world, at, show),
  };
  return [element("h3", {}, `Organism ${whole(facts.number[at])}`), pairs(rows, {})];
}

function link(world, at, show) {
  const number = whole(world.facts.number[at]);
  return element("button", { type: "button", class: "link", "aria-label": `Show organism ${number}`, click: () => show(at) }, number);
}

function parentOf(world, at, show) {
  const number = world.facts.parent[at] - 1;
  if (number < 0) return "none";
  const parent = organismOf(world, number);
  return parent < 0 ? `${whole(number)}, not in the picture` : link(world, parent, show);
}

function childrenOf(world, at, show) {
  const { children, parent, number } = world.facts;
  const span = element("span", {}, whole(children[at]));
  const found = [];
  for (let child = at + 1; child < parent.length && found.length < MOST_CHILDREN; child++) {
    if (parent[child] - 1 === number[at]) found.push(child);
  }
  if (found.length) span.append(": ");
  const more = found.length < children[at] ? ", …" : "";
  found.forEach((child, i) => {
    const after = i < found.length - 1 ? "," : more;
    span.append(element("span", { class: "child" }, link(world, child, show), after), " ");
  });
  return span;
}
