// Numbers as people read them.

const whole = (value) => Math.round(value).toLocaleString("en-US");

// In few characters: 500, 1.5k, 2M, 0.5; below 0.1 as 1/100.
function short(value) {
  if (value > 0 && value < 0.1) return `1/${short(Math.round(1 / value))}`;
  for (const [size, unit] of [[1e9, "G"], [1e6, "M"], [1e3, "k"]]) {
    if (Math.abs(value) >= size) return `${Number((value / size).toPrecision(3))}${unit}`;
  }
  return `${Number(value.toPrecision(4))}`;
}

const exact = (value) => (Math.abs(value) >= 100 ? whole(value) : `${Number(value.toPrecision(3))}`);

// Ticks as simulated time, in brackets; nothing if the habitat has no clock.
function simulated(ticks, rate) {
  if (!rate) return "";
  const seconds = Math.round(ticks / rate);
  if (seconds < 60) return ` (${seconds} s)`;
  if (seconds < 3600) return ` (${Math.floor(seconds / 60)} min ${seconds % 60} s)`;
  return ` (${whole(Math.floor(seconds / 3600))} h ${Math.floor((seconds % 3600) / 60)} min)`;
}

// Round numbers for an axis between two values, about `count` of them.
function roundNumbers(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = Math.max([1, 2, 5, 10].find((each) => each * power >= rough) * power, 1);
  const found = [];
  for (let at = Math.ceil(low / step) * step; at <= high; at += step) found.push(at);
  return found;
}
