// The page: its content is in it, as JSON; all figures are made from that.

const kept = { world: 0, view: null, number: null };

async function render(content) {
  painters.clear();
  const main = document.getElementById("main");
  const worlds = worldsSection(content, kept);
  const parts = [
    element("h1", {}, content.title),
    element("p", { class: "subtitle" }, content.subtitle),
    element("div", { class: "lede" },
      element("div", { class: "words" }, ...content.words.map((text) => element("p", {}, text))),
      element("dl", { class: "numbers" }, ...content.numbers.map(({ name, value }) =>
        element("div", {}, element("dt", {}, name), element("dd", {}, value))))),
    ...(content.arms ? armsSection(content.arms) : []),
    worlds.element,
    ...(content.panels.length ? [curvesSection(content.panels)] : []),
    ...(content.films ? [livesSection(content.films)] : []),
    factsSection(content.facts),
  ];
  await worlds.filled;
  main.replaceChildren(...parts);
  main.dataset.drawn = "yes";
}

beginScheme();
render(JSON.parse(document.getElementById("content").textContent));
