// What stands around and upon the space-time picture: axes, marks, the line of descent, the chosen one.

function boxOf(canvas) {
  const narrow = canvas.clientWidth < 480;
  const [left, right, top, bottom] = narrow ? [38, 40, 20, 24] : [52, 58, 22, 28];
  return {
    left, top, width: canvas.clientWidth - left - right, height: canvas.clientHeight - top - bottom,
  };
}

function scalesOf(box, view) {
  const across = box.width / (view.right - view.left);
  const down = box.height / (view.bottom - view.top);
  return {
    x: (column) => box.left + (column - view.left) * across,
    y: (place) => box.top + (place - view.top) * down,
    across,
    down,
  };
}

function drawAxes(context, box, world, view) {
  const { x, y } = scalesOf(box, view);
  context.font = "11px system-ui, sans-serif";
  context.fillStyle = variable("--soft");
  context.textBaseline = "middle";
  const count = Math.max(box.height / 60, 2);
  for (const place of roundNumbers(view.top, view.bottom, count)) {
    label(context, short(place), box.left - 6, y(place), "right");
  }
  for (const [place, tick] of ticksInView(world, view, box.height)) {
    label(context, short(tick), box.left + box.width + 6, y(place), "left");
  }
  for (const column of roundNumbers(view.left, view.right - 0.5, Math.max(box.width / 80, 2))) {
    label(context, whole(column * world.step), x(column + 0.5), box.top + box.height + 14, "center");
  }
  label(context, "births", box.left - 6, box.top - 12, "right");
  label(context, "ticks", box.left + box.width + 6, box.top - 12, "left");
  label(context, "cell", box.left - 8, box.top + box.height + 14, "right");
}

function label(context, text, x, y, align) {
  context.textAlign = align;
  context.fillText(text, x, y);
}

// Round ticks, 1, 2 and 5 times powers of ten, at their times in births, not too close.
function ticksInView(world, view, height) {
  const [first, last] = [tickAt(world, view.top), tickAt(world, view.bottom)];
  const apart = ((view.bottom - view.top) / height) * 22;
  const found = [];
  let before = -Infinity;
  for (const tick of candidates(first, last)) {
    const place = world.moments[Math.max(lastUpTo(world.ticks, tick), 0)];
    if (place < view.top || place > view.bottom || place - before < apart) continue;
    found.push([place, tick]);
    before = place;
  }
  return found;
}

function candidates(first, last) {
  if (last < 4 * Math.max(first, 1)) return roundNumbers(first, Math.max(last, first + 1), 8);
  const powers = Array.from({ length: 16 }, (_, power) => 10 ** power);
  return powers.flatMap((power) => [power, 2 * power, 5 * power]).filter((t) => t >= first && t <= last);
}

function drawMarks(context, box, world, view) {
  const { y } = scalesOf(box, view);
  let before = -Infinity;
  for (const { place, why } of world.marks) {
    const at = y(place);
    if (place <= view.top || place >= view.bottom || at - before < 26) continue;
    before = at;
    context.fillStyle = variable("--ink");
    context.fillRect(box.left, at - 0.5, box.width, 1);
    context.font = "11px system-ui, sans-serif";
    const width = context.measureText(why).width + 10;
    context.fillStyle = variable("--raised");
    context.globalAlpha = 0.85;
    context.fillRect(box.left + box.width - width, at + 1, width, 16);
    context.globalAlpha = 1;
    context.fillStyle = variable("--ink");
    context.textBaseline = "middle";
    label(context, why, box.left + box.width - 5, at + 9, "right");
  }
}

// The line of descent: down each ancestor's cell until the birth of the next, then across to it.
function drawDescent(context, box, world, view, organism) {
  const { x, y } = scalesOf(box, view);
  context.save();
  context.beginPath();
  context.rect(box.left, box.top, box.width, box.height);
  context.clip();
  context.beginPath();
  let below = null;
  for (const at of descentOf(world, organism)) {
    const extent = extentOf(world, at);
    if (!extent) continue;
    const middle = x(extent.column + 0.5);
    if (below) context.lineTo(middle, y(below.start));
    else context.moveTo(middle, y(extent.start));
    context.lineTo(middle, y(extent.start));
    below = extent;
  }
  context.lineWidth = 3.5;
  context.strokeStyle = variable("--ground");
  context.globalAlpha = 0.6;
  context.stroke();
  context.lineWidth = 1.5;
  context.strokeStyle = variable("--ink");
  context.globalAlpha = 1;
  context.stroke();
  outline(context, world, organism, { x, y });
  context.restore();
}

function outline(context, world, organism, { x, y }) {
  const extent = extentOf(world, organism);
  if (!extent) return;
  const [left, right, top, bottom] = [
    x(extent.column), x(extent.column + 1), y(extent.start), y(extent.stop),
  ];
  context.lineWidth = 2;
  context.strokeRect(left - 1, top - 1, right - left + 2, Math.max(bottom - top, 2) + 2);
}
