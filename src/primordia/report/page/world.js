// A world's lives, unpacked: who is in which cell at which time in births, and who descends from whom.

async function readWorld(packedWorld) {
  const { ground, organisms } = packedWorld;
  const [base, segments, facts] = await Promise.all(
    [ground, ground.segments, organisms].map(allUnpacked));
  const world = { ...packedWorld, ...base, segments, facts };
  world.firstOf = firstOfColumns(segments.column, ground.shown);
  return world;
}

// Place of the first segment of each column, and the number of segments at the end.
function firstOfColumns(column, count) {
  return Array.from({ length: count + 1 }, (_, at) => lastUpTo(column, at - 0.5) + 1);
}

// The moment at which the cells were looked at last, at a time in births; its own place and its tick.
function momentAt(world, place) {
  return Math.max(lastUpTo(world.moments, place), 0);
}

const tickAt = (world, place) => world.ticks[momentAt(world, place)];

// The segment in a column at a time in births, or -1 if the cell is empty then.
function segmentAt(world, column, place) {
  const { start, stop } = world.segments;
  const at = world.moments[momentAt(world, place)];
  const found = lastUpTo(start, at, world.firstOf[column], world.firstOf[column + 1]);
  return found >= world.firstOf[column] && stop[found] > at ? found : -1;
}

// The place of an organism among those given, by its birth number, or -1.
function organismOf(world, number) {
  const at = lastUpTo(world.facts.number, number);
  return at >= 0 && world.facts.number[at] === number ? at : -1;
}

// An organism and its ancestors in the picture, the youngest first.
function descentOf(world, organism) {
  const line = [];
  for (let at = organism; at >= 0; at = world.facts.ancestor[at] - 1) line.push(at);
  return line;
}

const [OTHERS, ANCESTORS, DESCENDANTS] = [1, 2, 3];

// For each organism: whether it is of the line of descent, a descendant, or neither; null if none is lit.
function litBy(world, organism) {
  if (organism < 0) return null;
  const lit = new Uint8Array(world.facts.number.length).fill(OTHERS);
  for (let at = organism + 1; at < lit.length; at++) {
    const above = world.facts.ancestor[at] - 1;
    if (above === organism || (above > organism && lit[above] === DESCENDANTS)) lit[at] = DESCENDANTS;
  }
  for (const at of descentOf(world, organism)) lit[at] = ANCESTORS;
  return lit;
}

// The first and last time in births of an organism in the picture, and its column; null if it has none.
function extentOf(world, organism) {
  const { column, organism: of, start, stop } = world.segments;
  const cell = world.facts.cell[organism];
  if (cell % world.step) return null;
  const at = cell / world.step;
  let extent = null;
  for (let i = world.firstOf[at]; i < world.firstOf[at + 1]; i++) {
    if (of[i] !== organism) continue;
    extent = { column: column[i], start: extent ? extent.start : start[i], stop: stop[i] };
  }
  return extent;
}
