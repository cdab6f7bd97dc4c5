// Colours of the phylogeny by a trait of bodies, from the smallest to the largest factor.

// A control with the name of the usual colours and the names of the traits, and the key of the chosen trait;
// `paint` is called after a choice.
function traitControl({ traits, nodes }, usual, state, paint) {
  const select = element("select", { id: "trait" },
    ...[usual, ...traits.names].map((name, at) => element("option", { value: at - 1 }, name)));
  const key = element("span", { class: "scale" });
  const fill = () => key.replaceChildren(...(state.trait < 0 ? [] : traitKey(traits.scale, traitRange(nodes, state.trait))));
  painters.add(fill);
  select.addEventListener("change", () => {
    state.trait = Number(select.value);
    fill();
    paint();
  });
  return element("div", { class: "bar" }, element("label", { for: "trait" }, "Colour"), select, key);
}

function traitKey(scale, [least, most]) {
  const bar = element("i", {});
  bar.style.background = `linear-gradient(to right, ${scale.map(curveColour).join(", ")})`;
  return [`x ${least.toFixed(2)}`, bar, `x ${most.toFixed(2)}`];
}

function traitRange(nodes, trait) {
  const factors = nodes.map((node) => node.traits[trait]);
  return [Math.min(...factors), Math.max(...factors)];
}

// The colour of a factor: equal ratios are equally far apart.
function traitColour(scale, [least, most], factor) {
  const share = most > least ? Math.log(factor / least) / Math.log(most / least) : 0.5;
  return scale[Math.min(Math.floor(share * scale.length), scale.length - 1)];
}

// ", NAME x FACTOR" for each trait of a node; nothing where bodies are not inherited.
function traitText({ traits }, node) {
  return traits ? traits.names.map((name, at) => `, ${name} x ${node.traits[at].toFixed(2)}`).join("") : "";
}
