// Mouse and fingers on the space-time picture: hover tells, a click chooses, drag moves, pinch zooms.

const STILL = 5; // pixels within which a press is a click

function groundPointer(figure) {
  const { canvas } = figure;
  const fingers = new Map();
  let moved = 0;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, event);
    if (fingers.size === 1) moved = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return tell(figure, event);
    moved += Math.hypot(event.offsetX - before.offsetX, event.offsetY - before.offsetY);
    if (fingers.size === 1 && moved > STILL) drag(figure, before, event);
    if (fingers.size === 2) pinch(figure, fingers, event);
    fingers.set(event.pointerId, event);
  });
  const end = (event) => {
    if (fingers.delete(event.pointerId) && event.type === "pointerup" && moved <= STILL) choose(figure, event);
    if (fingers.size) moved = Infinity; // the last finger of a pinch is no click
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("pointerleave", () => (figure.readout.textContent = "\u00a0"));
  canvas.addEventListener("dblclick", () => figure.zoom("all"));
  canvas.addEventListener("wheel", (event) => wheel(figure, event), { passive: false });
}

function drag(figure, before, event) {
  const box = boxOf(figure.canvas);
  const [x, y] = [event.offsetX - before.offsetX, event.offsetY - before.offsetY];
  figure.show(movedView(figure.world, figure.view, -x / box.width, -y / box.height));
}

function pinch(figure, fingers, event) {
  const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, finger]) => finger);
  const before = fingers.get(event.pointerId);
  const apart = (a) => Math.max(Math.hypot(a.offsetX - other.offsetX, a.offsetY - other.offsetY), 10);
  const box = boxOf(figure.canvas);
  const x = ((event.offsetX + other.offsetX) / 2 - box.left) / box.width;
  const y = ((event.offsetY + other.offsetY) / 2 - box.top) / box.height;
  figure.show(zoomedView(figure.world, figure.view, apart(before) / apart(event), x, y));
}

function wheel(figure, event) {
  if (!event.ctrlKey && document.activeElement !== figure.canvas) return;
  const at = under(figure, event);
  if (!at) return;
  event.preventDefault();
  const factor = Math.exp(Math.max(-60, Math.min(60, event.deltaY)) / 150);
  figure.show(zoomedView(figure.world, figure.view, factor, at.x, at.y));
}

function choose(figure, event) {
  const at = under(figure, event);
  if (!at) return;
  figure.chosen.set(at.segment < 0 ? -1 : figure.world.segments.organism[at.segment]);
}
