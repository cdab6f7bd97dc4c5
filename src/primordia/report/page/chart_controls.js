// Zoom and read a chart by keys, the wheel and buttons; uPlot itself zooms by dragging.

const toLine = (u, value) => (u.scales.x.distr === 3 ? Math.log10(value) : value);
const fromLine = (u, value) => (u.scales.x.distr === 3 ? 10 ** value : value);

function zoomChart(u, way, around = 0.5) {
  const xs = u.data[0];
  const all = { min: xs[0], max: xs[xs.length - 1] };
  if (way === "all") return u.setScale("x", all);
  const low = toLine(u, u.scales.x.min);
  const span = toLine(u, u.scales.x.max) - low;
  const next = span * (way === "in" ? 0.6 : 1 / 0.6);
  showSpan(u, low + (span - next) * around, next, all);
}

function moveChart(u, share) {
  const xs = u.data[0];
  const low = toLine(u, u.scales.x.min);
  const span = toLine(u, u.scales.x.max) - low;
  showSpan(u, low + share * span, span, { min: xs[0], max: xs[xs.length - 1] });
}

function showSpan(u, low, span, all) {
  const [first, last] = [toLine(u, all.min), toLine(u, all.max)];
  if (span > (last - first) * 0.999) return u.setScale("x", all);
  const start = Math.min(Math.max(low, first), last - span);
  u.setScale("x", { min: fromLine(u, start), max: fromLine(u, start + span) });
}

function readChart(u, step) {
  const xs = u.data[0];
  const width = u.bbox.width / (window.devicePixelRatio || 1);
  const now = u.cursor.left >= 0 ? u.cursor.left : step > 0 ? -6 : width + 6;
  const left = Math.min(Math.max(now + step * 6, 0), width);
  if (xs.length) u.setCursor({ left, top: 10 });
}

function chartControls(plot, holder) {
  const keys = {
    "+": (u) => zoomChart(u, "in"),
    "=": (u) => zoomChart(u, "in"),
    "-": (u) => zoomChart(u, "out"),
    0: (u) => zoomChart(u, "all"),
    ArrowLeft: (u, shift) => (shift ? moveChart(u, -0.2) : readChart(u, -1)),
    ArrowRight: (u, shift) => (shift ? moveChart(u, 0.2) : readChart(u, 1)),
  };
  plot.addEventListener("keydown", (event) => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key](holder.u, event.shiftKey);
  });
  plot.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== plot) return;
    event.preventDefault();
    const box = holder.u.over.getBoundingClientRect();
    zoomChart(holder.u, event.deltaY < 0 ? "in" : "out", (event.clientX - box.left) / box.width);
  }, { passive: false });
}
