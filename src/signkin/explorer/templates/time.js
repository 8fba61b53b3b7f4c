// Where the page is: the time shown, the window of the plots, and who wants to know.
const LAST = DATA.duration;
const LEAST_SPAN = Math.min(LAST, Math.max(0.1, 8 / DATA.rate));
const state = { time: 0, from: 0, to: LAST, hover: null, playing: false, pace: 1 };
const told = { time: [], view: [], hover: [] };
let dirty = new Set();
let asked = false;

// Everything is drawn once a frame of the screen, however often it changes.
function changed(what) {
  dirty.add(what);
  if (asked) return;
  asked = true;
  requestAnimationFrame(() => {
    asked = false;
    const now = dirty;
    dirty = new Set();
    for (const kind of ["view", "time", "hover"]) {
      if (now.has(kind)) for (const tell of told[kind]) tell();
    }
  });
}

function setView(from, to) {
  const span = Math.min(LAST, Math.max(LEAST_SPAN, to - from));
  from = Math.min(Math.max(0, from), LAST - span);
  state.from = from;
  state.to = from + span;
  changed("view");
}

function setTime(time, follow = true) {
  state.time = Math.min(Math.max(0, time), LAST);
  const span = state.to - state.from;
  if (follow && (state.time < state.from || state.time > state.to)) {
    setView(state.time - span * 0.1, state.time + span * 0.9);
  }
  changed("time");
}

// A time that was asked for: with some of what is around it.
function open(time, around = 3) {
  const span = Math.min(state.to - state.from, 2 * around);
  setView(time - span / 2, time + span / 2);
  setTime(time);
}

function zoom(factor, at = state.time) {
  if (at < state.from || at > state.to) at = (state.from + state.to) / 2;
  const from = at - (at - state.from) * factor;
  setView(from, from + (state.to - state.from) * factor);
}

const pan = (by) => setView(state.from + by, state.to + by);

function play(on = !state.playing) {
  if (on === state.playing) return;
  state.playing = on;
  if (on && state.time >= LAST - 1e-6) setTime(0);
  $("play").textContent = on ? "Pause" : "Play";
  $("play").setAttribute("aria-pressed", String(on));
  let before = performance.now();
  const step = (now) => {
    if (!state.playing) return;
    setTime(state.time + ((now - before) / 1000) * state.pace);
    before = now;
    if (state.time >= LAST) play(false); else requestAnimationFrame(step);
  };
  if (on) requestAnimationFrame(step);
  else told.stopped?.();
}
