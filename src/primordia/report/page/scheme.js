// Light and dark: as the system, or as chosen; figures are painted again when it changes.

const painters = new Set();
const dark = window.matchMedia("(prefers-color-scheme: dark)");

function isDark() {
  return document.documentElement.dataset.scheme === "dark";
}

function applyScheme() {
  const chosen = document.getElementById("scheme").value;
  document.documentElement.dataset.scheme = chosen || (dark.matches ? "dark" : "light");
  painters.forEach((paint) => paint());
}

function beginScheme() {
  document.getElementById("scheme").addEventListener("change", applyScheme);
  dark.addEventListener("change", applyScheme);
  applyScheme();
}

const variable = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const rgbOf = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
const mixed = (from, to, share) => from.map((part, i) => Math.round(part + share * (to[i] - part)));
const css = (rgb) => `rgb(${rgb.join(" ")})`;
const luminance = ([red, green, blue]) => (0.3 * red + 0.59 * green + 0.11 * blue) / 255;

// The colour of a curve: that of the figures on paper, made lighter on a dark page until it can be seen.
function curveColour(hex) {
  if (hex === "#222222") return variable("--ink");
  if (hex === "#d4d4d4") return variable("--soft");
  let rgb = rgbOf(hex);
  while (isDark() && luminance(rgb) < 0.5) rgb = mixed(rgb, [255, 255, 255], 0.1);
  while (!isDark() && luminance(rgb) > 0.75) rgb = mixed(rgb, [0, 0, 0], 0.1);
  return css(rgb);
}

// The inks of lines of descent: strong ones first, then as many pale ones, mixed with the page's ground.
function inks(palette) {
  const strong = palette.slice(0, palette.length / 2);
  const ground = rgbOf(variable("--empty"));
  const shown = strong.map((rgb) => {
    let seen = rgb;
    while (isDark() && luminance(seen) < 0.3) seen = mixed(seen, [255, 255, 255], 0.1);
    return seen;
  });
  return [...shown, ...shown.map((rgb) => mixed(rgb, ground, 0.66))];
}
