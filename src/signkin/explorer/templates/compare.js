// A captured transition and the same one made anew, side by side in one time.
const MADE = DATA.syntheses;
const SIDE_S = 0.3; // of the signs around it
const pair = { number: null, method: null, time: 0, playing: false };
const made = {}; // method -> {columns, of: transition -> {first, rows, length}}

async function readMade() {
  for (const [method, one] of Object.entries(MADE?.methods ?? {})) {
    const of = new Map();
    let first = 0;
    for (const [number, rows, length] of one.frames) {
      of.set(number, { first, rows, length });
      first += rows;
    }
    made[method] = { columns: await unpacked(one.positions), of };
  }
  pair.method = Object.keys(made)[0] ?? null;
}

const shownTransition = () => TRANSITIONS.find((one) => one.number === pair.number);
const synthesis = () => (pair.method ? made[pair.method].of.get(pair.number) : undefined);

// The posture of the synthesis at a time after the first sign's end.
function madePosture(transition, time) {
  const one = synthesis();
  if (time <= 0) return posture(transition.start + time);
  if (time >= one.length) return posture(transition.end + time - one.length);
  return between(made[pair.method].columns, one.first, one.rows,
                 (time / one.length) * (one.rows - 1));
}

function chooseTransition(number) {
  pair.number = number;
  pair.time = 0;
  drawPair();
}

function drawPair() {
  const transition = shownTransition();
  const there = transition && synthesis();
  $("pair-none").hidden = Boolean(there);
  $("pair-both").hidden = !there;
  if (!transition) return;
  $("pair-title").textContent =
    `Transition ${transition.number}: ${short(transition.from)} → ${short(transition.to)}`;
  if (!there) return;
  const captured = transition.end - transition.start;
  drawPosture($("captured"), posture(transition.start + pair.time),
              { label: `captured, ${seconds(captured)}` });
  drawPosture($("made"), madePosture(transition, pair.time),
              { label: `${pair.method}, ${seconds(there.length)} (${MADE.model})` });
  const last = Math.max(captured, there.length) + SIDE_S;
  const bar = $("pair-time");
  bar.min = -SIDE_S;
  bar.max = last;
  bar.value = pair.time;
  $("pair-at").textContent = `${pair.time < 0 ? "−" : ""}${seconds(Math.abs(pair.time))} after ${short(transition.from, 16)}`;
}

function playPair(on = !pair.playing) {
  if (!synthesis()) return;
  const was = pair.playing;
  pair.playing = on;
  $("pair-play").textContent = on ? "Pause both" : "Play both";
  if (!on || was) return;
  let before = performance.now();
  const step = (now) => {
    const transition = shownTransition(), one = synthesis();
    if (!pair.playing || !one) { if (pair.playing) playPair(false); return; }
    pair.time += ((now - before) / 1000) * Number($("pair-pace").value);
    before = now;
    if (pair.time > Math.max(transition.end - transition.start, one.length) + SIDE_S) pair.time = -SIDE_S;
    drawPair();
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}

function preparePair() {
  if (!TRANSITIONS.length) { $("pair").hidden = true; return; }
  for (const method of Object.keys(made)) {
    $("pair-method").append(element("option", method, { value: method }));
  }
  $("pair-method").addEventListener("change", (event) => {
    pair.method = event.target.value;
    drawPair();
  });
  $("pair-play").addEventListener("click", () => playPair());
  $("pair-time").addEventListener("input", (event) => {
    playPair(false);
    pair.time = Number(event.target.value);
    drawPair();
  });
  told.time.push(() => {
    // The transition goes with the time: the one that it lies in, or the one before.
    const here = TRANSITIONS.filter((one) => one.start <= state.time + 1e-6).at(-1) ?? TRANSITIONS[0];
    if (here.number !== pair.number) chooseTransition(here.number);
  });
}
