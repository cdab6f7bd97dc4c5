// Lives as short films; they are in the page, and do not play by themselves.

// Pixels below a film with a panel, so that the browser's buttons do not cover the panel.
const CONTROLS = 100;

function livesSection({ films, missing }) {
  const about = "Each life was lived again tick for tick, and agrees with its record. Of a long life"
    + " the first and last seconds are shown.";
  const figures = films.map(({ title, about: what, data, panel }) => {
    const video = element("video", { controls: true, loop: true, muted: true, playsinline: true, preload: "auto",
      "aria-label": `${title}: ${what}` });
    if (panel) video.addEventListener("loadedmetadata", () => {
      video.style.aspectRatio = `${video.videoWidth} / ${video.videoHeight + CONTROLS}`;
    });
    video.src = URL.createObjectURL(new Blob([bytesOf(data)], { type: "video/mp4" }));
    return element("figure", {}, video, element("figcaption", {}, element("strong", {}, title), what));
  });
  const why = missing ? [element("p", { class: "about" }, `Not filmed: ${missing}.`)] : [];
  return section("Lives", films.length ? about : "", element("div", { class: "lives" }, ...figures), ...why);
}
