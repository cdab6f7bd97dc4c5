// Arrays as packed.py writes them: base64, gzip, little-endian numbers, and differences where they rise.

const TYPES = { uint8: Uint8Array, uint16: Uint16Array, uint32: Uint32Array, float64: Float64Array };

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

async function unpacked({ type, rising, data }) {
  const values = new TYPES[type](await inflated(bytesOf(data)));
  return rising ? sumsOf(values) : values;
}

function sumsOf(values) {
  const sums = new Float64Array(values.length);
  let sum = 0;
  for (let i = 0; i < values.length; i++) sums[i] = sum += values[i];
  return sums;
}

// Unpack every packed array in an object; other values stay.
async function allUnpacked(group) {
  const entries = Object.entries(group).map(async ([name, value]) => [
    name,
    value && value.data ? await unpacked(value) : value,
  ]);
  return Object.fromEntries(await Promise.all(entries));
}

// The place of the last value that is no greater than `wanted` in rising values, or -1.
function lastUpTo(values, wanted, low = 0, high = values.length) {
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= wanted) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
