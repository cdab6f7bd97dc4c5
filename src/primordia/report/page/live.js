// A page that is live: the server says when the run has gone on, and the page asks for its content.

function beginLive() {
  const status = document.querySelector(".live");
  const state = { shown: 0, busy: false, wanted: 0 };
  status.hidden = false;
  const source = new EventSource("/events");
  source.onmessage = (event) => {
    const { count, going } = JSON.parse(event.data);
    status.textContent = going ? "live" : "no process writes this run now";
    status.classList.toggle("on", going);
    state.wanted = count;
    follow(state);
  };
  source.onerror = () => {
    status.textContent = "the server does not answer";
    status.classList.remove("on");
  };
}

async function follow(state) {
  if (state.busy || state.shown === state.wanted) return;
  state.busy = true;
  const count = state.wanted;
  try {
    const answer = await fetch("/data");
    if (answer.ok) await render(await answer.json());
    state.shown = count;
  } catch {
    return; // the server is gone; its events will tell when it is back
  } finally {
    state.busy = false;
  }
  follow(state);
}

beginLive();
