// How to live the run again; its settings, versions and digests.

function factsSection(all) {
  const about = "The same settings, versions and kind of device give the same run, bit for bit. Equal digests show"
    + " that two runs are the same.";
  return section("Repeat this run", about, ...all.flatMap(factsOf));
}

function factsOf({ name, settings, toml, versions, digests, exact, restarts, commands }) {
  const file = commands[0].includes("config.toml");
  return [
    ...(name ? [element("h3", {}, name)] : []),
    ...(exact ? [] : [element("p", {}, "This run is not exact: parts of the run cannot be repeated bit for bit.")]),
    ...(restarts ? [element("p", {}, `The living got new bodies ${whole(restarts)} times, when the run was resumed.`)] : []),
    copied(commands.join("\n"), "Copy the commands"),
    folded(file ? "config.toml, which the command takes" : "All settings as config.toml", copied(toml, "Copy config.toml")),
    folded("Settings", pairs(settings, { class: "pairs" })),
    folded("Versions", pairs(versions, { class: "pairs" })),
    folded(digests.length > 1 ? "Digests of the worlds" : "Digest of the world",
      pairs(Object.fromEntries(digests.map(({ seed, digest }) => [`seed ${seed}`, digest])), { class: "pairs" })),
  ];
}

const folded = (title, ...children) => element("details", {}, element("summary", {}, title), ...children);

function copied(text, label) {
  const button = element("button", { type: "button", "aria-label": label }, "Copy");
  const pre = element("pre", { tabindex: 0 }, text);
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(pre); // the browser forbids it: what is selected can be copied
      button.textContent = "Selected";
    }
    setTimeout(() => (button.textContent = "Copy"), 2000);
  });
  return element("div", { class: "command" }, pre, button);
}
