// Elements are made here and nowhere else, with text as text: no string is ever read as HTML.

function element(name, attributes = {}, ...children) {
  return filled(document.createElement(name), attributes, children);
}

function shape(name, attributes = {}, ...children) {
  return filled(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);
}

function filled(made, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name, value);
    else if (value !== false && value != null) made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children);
  return made;
}

function section(title, about, ...children) {
  const id = title.toLowerCase().replace(/\W+/g, "-");
  const heading = element("h2", { id }, title);
  const text = about ? [element("p", { class: "about" }, about)] : [];
  return element("section", { "aria-labelledby": id }, heading, ...text, ...children);
}

function pairs(values, attributes) {
  const rows = Object.entries(values).flatMap(([name, value]) => [
    element("dt", {}, name),
    element("dd", {}, value),
  ]);
  return element("dl", attributes, ...rows);
}

// Buttons that zoom a figure by the mouse, a finger or Enter; `act` gets "in", "out" or "all".
function zoomButtons(what, act) {
  const button = (sign, way, label) =>
    element("button", { type: "button", "aria-label": `${label}: ${what}`, click: () => act(way) }, sign);
  return element("span", { class: "zoom", role: "group", "aria-label": `Zoom: ${what}` },
    button("−", "out", "Zoom out"), button("+", "in", "Zoom in"), button("All", "all", "Show all"));
}

// Call `draw` with the width of an element, now and whenever it changes.
function onWidth(watched, draw) {
  let before = 0;
  new ResizeObserver(() => {
    const width = Math.floor(watched.clientWidth);
    if (width > 0 && width !== before) draw((before = width));
  }).observe(watched);
}

// Make a canvas as fine as the screen -> its context, in CSS pixels.
function sharp(canvas) {
  const ratio = window.devicePixelRatio || 1;
  canvas.width = Math.round(canvas.clientWidth * ratio);
  canvas.height = Math.round(canvas.clientHeight * ratio);
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return context;
}
