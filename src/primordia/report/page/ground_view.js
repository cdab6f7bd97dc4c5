// The part of the space-time picture that is in view: columns across, times in births downwards.

const wholeView = (world) => ({ left: 0, right: world.shown, top: 0, bottom: world.births });

const isWhole = (world, view) =>
  view.right - view.left >= world.shown && view.bottom - view.top >= world.births;

// Zoom by a factor about a point given as shares of the view; both directions alike.
function zoomedView(world, view, factor, x = 0.5, y = 0.5) {
  const [left, right] = zoomedSpan(view.left, view.right, factor, x, world.shown, Math.min(4, world.shown));
  const [top, bottom] = zoomedSpan(view.top, view.bottom, factor, y, world.births, Math.min(8, world.births));
  return { left, right, top, bottom };
}

function zoomedSpan(low, high, factor, share, most, least) {
  const span = Math.min(Math.max((high - low) * factor, least), most);
  return within(low + (high - low - span) * share, span, most);
}

function movedView(world, view, x, y) {
  const [width, height] = [view.right - view.left, view.bottom - view.top];
  const [left, right] = within(view.left + x * width, width, world.shown);
  const [top, bottom] = within(view.top + y * height, height, world.births);
  return { left, right, top, bottom };
}

function within(low, span, most) {
  const start = Math.min(Math.max(low, 0), most - span);
  return [start, start + span];
}

// A view of the same size in which a place can be seen.
function viewWith(world, view, column, place) {
  const [width, height] = [view.right - view.left, view.bottom - view.top];
  const seen = column >= view.left && column < view.right && place >= view.top && place < view.bottom;
  if (seen) return view;
  const [left, right] = within(column - width / 2, width, world.shown);
  const [top, bottom] = within(place - height / 2, height, world.births);
  return { left, right, top, bottom };
}
