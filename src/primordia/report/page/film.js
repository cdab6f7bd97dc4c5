// A world on a torus as a film: a picture for each moment, a slider, and a button that plays.

const PICTURES_A_SECOND = 15;

async function filmSection(world, palette, chosen, show) {
  const film = { ...world.film, cells: await unpacked(world.film.cells), at: world.film.places.length - 1 };
  const about = `All ${whole(film.rows)} × ${whole(film.columns)} cells, one picture after another; opposite edges meet.`
    + " The colour shows the line of descent; young organisms are light. Time runs in births.";
  const canvas = element("canvas", { role: "img", "aria-label": "The cells of the torus" });
  canvas.style.setProperty("--shape", `${film.columns} / ${film.rows}`);
  const slider = element("input", { type: "range", min: 0, max: film.places.length - 1, value: film.at,
    "aria-label": "Moment of the film" });
  const readout = element("p", { class: "readout" });
  const button = element("button", { type: "button" }, "Play");
  const paint = () => {
    paintFilm(canvas, film, inks(palette), world, chosen);
    const text = `birth ${whole(film.places[film.at] + 1)}, tick ${whole(film.ticks[film.at])}, ${whole(film.alive[film.at])} alive`;
    readout.textContent = text;
    slider.setAttribute("aria-valuetext", text);
  };
  slider.addEventListener("input", () => ((film.at = Number(slider.value)), paint()));
  playing(film, slider, button, paint);
  canvas.addEventListener("click", (event) => chooseInFilm(event, canvas, film, world, show));
  chosen.listen(paint);
  painters.add(paint);
  paint();
  return section("The world as a film", about, element("div", { class: "film" }, element("div", { class: "picture" }, canvas, islandBands(world)),
    element("div", { class: "bar" }, button, slider), readout));
}

function playing(film, slider, button, paint) {
  let timer = null;
  const stop = () => {
    clearInterval(timer);
    timer = null;
    button.textContent = "Play";
  };
  const step = () => {
    if (!button.isConnected || film.at >= film.places.length - 1) return stop();
    slider.value = film.at += 1;
    paint();
  };
  button.addEventListener("click", () => {
    if (timer) return stop();
    if (film.at >= film.places.length - 1) film.at = -1;
    button.textContent = "Pause";
    timer = setInterval(step, 1000 / PICTURES_A_SECOND);
    step();
  });
}

function paintFilm(canvas, film, colours, world, chosen) {
  canvas.width = film.columns;
  canvas.height = film.rows;
  const image = new ImageData(film.columns, film.rows);
  const size = film.columns * film.rows;
  const empty = rgbOf(variable("--empty"));
  for (let cell = 0; cell < size; cell++) {
    const byte = film.cells[film.at * size + cell];
    const rgb = byte ? aged(colours[(byte & 31) - 1], byte >> 5) : empty;
    image.data.set([...rgb, 255], 4 * cell);
  }
  const context = canvas.getContext("2d");
  context.putImageData(image, 0, 0);
  markInFilm(context, film, world, chosen.organism);
}

// The young are mixed with white, the old are plain.
const aged = (rgb, shade) => mixed(rgb, [255, 255, 255], 0.5 * (1 - shade / 7));

function markInFilm(context, film, world, organism) {
  if (organism < 0) return;
  const { born, first, lifespan, cause, cell } = world.facts;
  const begun = born[organism] + first;
  const tick = film.ticks[film.at];
  if (tick < begun || (cause[organism] && tick >= begun + lifespan[organism])) return;
  context.fillStyle = variable("--ink");
  context.fillRect(cell[organism] % film.columns, Math.floor(cell[organism] / film.columns), 1, 1);
}

function chooseInFilm(event, canvas, film, world, show) {
  const column = Math.floor((event.offsetX / canvas.clientWidth) * film.columns);
  const row = Math.floor((event.offsetY / canvas.clientHeight) * film.rows);
  const cell = row * film.columns + column;
  if (cell % world.step) return;
  const segment = segmentAt(world, cell / world.step, film.places[film.at]);
  if (segment >= 0) show(world.segments.organism[segment]);
}
