// The page: its content is in it, as JSON; all figures are made from that.

const kept = { world: 0, view: null, number: null };
const closers = new Set();

async function render(content) {
  const main = document.getElementById("main");
  [...closers].forEach((close) => close());
  [closers, painters].forEach((group) => group.clear());
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
    ...(content.islands ? [islandsSection(content.islands)] : []),
    ...(content.panels.length ? [curvesSection(content.panels)] : []),
    ...(content.films ? [livesSection(content.films)] : []),
    factsSection(content.facts),
  ];
  await worlds.filled;
  exchange(main, parts);
  main.dataset.drawn = "yes";
}

// Put new parts in place of the old ones; what is read, and what has the focus, stay where they are.
function exchange(main, parts) {
  const nameOf = (each) => each && (each.id || each.getAttribute("aria-label"));
  const name = nameOf(document.activeElement);
  const place = window.scrollY;
  main.style.minHeight = `${main.offsetHeight}px`;
  main.replaceChildren(...parts);
  const same = name && [...main.querySelectorAll("[id], [aria-label]")].find((each) => nameOf(each) === name);
  if (same) same.focus({ preventScroll: true });
  requestAnimationFrame(() => requestAnimationFrame(() => {
    window.scrollTo({ top: place, behavior: "instant" });
    main.style.minHeight = "";
  }));
}

beginScheme();
render(JSON.parse(document.getElementById("content").textContent));
