// The arms of an experiment: tables, notes and curves.

function armsSection({ tables, notes, panels }) {
  const made = section("Arms side by side", "", ...tables.map(wideTable),
    ...notes.map((note) => element("p", { class: "hint" }, note)));
  return [made, curvesSection(panels, "Curves of the arms")];
}

function wideTable({ title, head, rows }) {
  const heads = head.map((text) => element("th", { scope: "col" }, text));
  const lines = rows.map(([first, ...others]) =>
    element("tr", {}, element("th", { scope: "row" }, first), ...others.map((text) => element("td", {}, text))));
  return element("div", { class: "wide", tabindex: 0, role: "group", "aria-label": title },
    element("table", {}, element("caption", {}, title), element("thead", {}, element("tr", {}, ...heads)),
      element("tbody", {}, ...lines)));
}
