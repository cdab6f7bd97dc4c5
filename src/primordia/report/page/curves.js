// Curves: one uPlot chart for each panel of curves.py, with a key that tells the values at the cursor.

const KINDS = {
  line: { width: 1.8 },
  faint: { width: 0.8, alpha: 0.35 },
  low: { width: 0 },
  high: { width: 0 },
  steps: { width: 1.8 },
  limit: { width: 1 },
  dots: { width: 0 },
};

function curvesSection(panels, title = "Curves") {
  const about = "Move over a figure to read its values. Drag to zoom; double-click to show all.";
  const hint = "Keys: ← and → read values, + and − zoom, Shift with ← and → moves, 0 shows all.";
  return section(title, about, element("div", { class: "charts" }, ...panels.map(chart)),
    element("p", { class: "hint" }, hint));
}

function chart(panel) {
  const plot = element("div", { class: "plot", tabindex: 0, role: "group",
    "aria-label": `${panel.title}. ${panel.about} Keys: left, right, plus, minus, 0.` });
  const key = element("ul", { class: "key", "aria-live": "off" });
  const holder = { u: null };
  const figure = element("figure", { class: "chart" },
    element("div", { class: "bar" }, element("h3", {}, panel.title),
      zoomButtons(panel.title, (way) => zoomChart(holder.u, way))),
    key, plot);
  const draw = () => {
    if (holder.u) holder.u.destroy();
    holder.u = drawnChart(panel, plot, key, plot.clientWidth);
    const zoom = zooms.get(panel.title);
    if (zoom) holder.u.setScale("x", zoom);
  };
  closers.add(() => holder.u && holder.u.destroy());
  onWidth(plot, draw);
  painters.add(() => holder.u && draw());
  chartControls(plot, holder);
  return figure;
}

function drawnChart(panel, plot, key, width) {
  const curves = panel.tables.flatMap((table) => table.curves);
  const data = uPlot.join(panel.tables.map((table) => [table.x, ...table.curves.map((c) => c.values)]));
  const items = fillKey(key, panel, curves);
  return new uPlot({
    width,
    height: plot.clientHeight,
    padding: [8, 6, 0, 0],
    legend: { show: false },
    cursor: { y: false, points: { show: false }, drag: { x: true, y: false } },
    scales: { x: scale(panel.log_x), y: { ...scale(panel.log_y), range: roomAround(panel.log_y) } },
    axes: [axis(panel.x, panel.log_x, "x"), axis(panel.y, panel.log_y, "y")],
    series: [{}, ...curves.map(series)],
    bands: bandsOf(curves),
    hooks: {
      setCursor: [(u) => tellValues(u, panel, curves, items)],
      setScale: [(u, axis) => axis === "x" && keepZoom(u, panel.title)],
    },
  }, data, plot);
}

// The part of each chart that is in view, by its title, while it is not all of it.
const zooms = new Map();

function keepZoom(u, title) {
  const { min, max } = u.scales.x;
  const xs = u.data[0];
  if (min > xs[0] || max < xs[xs.length - 1]) zooms.set(title, { min, max });
  else zooms.delete(title);
}

const scale = (log) => ({ time: false, distr: log ? 3 : 1, range: (u, low, high) => [low, high] });

function roomAround(log) {
  if (log) return (u, low, high) => [10 ** Math.floor(Math.log10(low)), 10 ** Math.ceil(Math.log10(high * 1.01))];
  return (u, low, high) => [Math.min(low, 0), high > 0 ? high * 1.06 : 1];
}

function axis(label, log, side) {
  const font = "11px system-ui, sans-serif";
  return {
    label, font, labelFont: font, labelGap: 0, stroke: variable("--soft"),
    size: side === "x" ? 30 : 46, labelSize: 16, gap: 4, space: side === "x" ? 56 : 28,
    grid: { stroke: variable("--faint"), width: 1, ...(log && { filter: powersOfTen }) },
    ticks: { show: false },
    values: (u, splits) => splits.map((value) => (value == null ? "" : short(value))),
    ...(log && { filter: powersOfTen }),
  };
}

// Label whole powers of ten only, unless so few are in view that others are needed.
function powersOfTen(u, splits) {
  const isPower = (value) => Math.abs(Math.log10(value) % 1) < 1e-9;
  const enough = splits.filter(isPower).length > 1;
  return splits.map((value) => (!enough || isPower(value) ? value : null));
}

function series(curve) {
  const colour = curveColour(curve.colour);
  const { width, alpha = 1 } = KINDS[curve.kind];
  const made = { stroke: colour, width, alpha, points: { show: false }, scale: "y" };
  if (curve.kind === "steps") made.paths = uPlot.paths.stepped({ align: 1 });
  if (curve.kind === "limit") made.dash = [4, 4];
  if (curve.kind === "dots") {
    made.paths = () => null;
    made.points = { show: true, size: 3.5, width: 0, fill: colour };
    made.alpha = 0.6;
  }
  return made;
}

// Fill between each `high` and the `low` that follows it.
function bandsOf(curves) {
  return curves.flatMap((curve, i) => {
    if (curve.kind !== "high") return [];
    const fill = curveColour(curve.colour).replace(")", " / 22%)");
    return [{ series: [i + 1, i + 2], fill }];
  });
}

function fillKey(key, panel, curves) {
  const named = curves.filter((curve) => curve.name);
  const items = named.map((curve) => {
    const mark = element("i", { class: curve.kind === "dots" ? "dot" : "" });
    mark.style.background = curveColour(curve.colour);
    const value = element("b");
    return { curve, value, row: element("li", {}, mark, curve.name, " ", value) };
  });
  const at = element("b");
  const place = element("li", {}, at);
  key.replaceChildren(...items.map((item) => item.row), place);
  return { items, at };
}

function tellValues(u, panel, curves, { items, at }) {
  const index = u.cursor.idx;
  const here = index != null && u.cursor.left >= 0;
  at.textContent = here ? `at ${whole(u.data[0][index])}` : "";
  for (const { curve, value } of items) {
    const known = here ? nearestValue(u.data[curves.indexOf(curve) + 1], index, curve.kind) : null;
    value.textContent = known == null ? "" : exact(known);
  }
}

// The value at a place of joined data, or that of the curve's last point before it; dots have no such.
function nearestValue(values, index, kind) {
  if (kind === "dots") return values[index];
  for (let i = index; i >= 0; i--) if (values[i] !== undefined) return values[i];
  return null;
}
