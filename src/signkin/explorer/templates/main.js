// Reads the content, draws everything, and listens.
function drawPlots() {
  const host = $("plots");
  for (const plot of panels.splice(0)) plot.destroy();
  host.querySelectorAll(".panel").forEach((box) => box.remove());
  $("orders").replaceChildren();
  if (DATA.speeds) drawSpeeds(host);
  drawDensities(host, $("orders"));
  drawLanes(host, false);
  // The last panel has the axis of time; without any other it is the only one.
  panel(host, { name: "Time in the recording", height: 34, last: true });
  $("orders").hidden = !$("orders").children.length;
  placeHead();
}

function placeHead() {
  const plot = panels[0];
  if (!plot) return;
  const px = devicePixelRatio || 1;
  const left = plot.bbox.left / px, width = plot.bbox.width / px;
  const x = left + ((state.time - state.from) / (state.to - state.from)) * width;
  $("head").hidden = x < left - 1 || x > left + width + 1;
  $("head").style.transform = `translateX(${x}px)`;
}

function readout() {
  const time = state.hover ?? state.time;
  const parts = [seconds(time, 3)];
  for (const hand of HANDS) {
    if (SPEEDS[hand]) parts.push(`${hand} ${speedText(speedAt(hand, time))} ${SPEED_UNIT}`);
  }
  for (const sign of within(SIGNS, time)) parts.push(`sign ${short(sign.text)}`);
  for (const lane of LANES) {
    if (["sign", "right", "left", "trans.", "flags"].includes(lane.name)) continue;
    for (const bar of within(lane.bars, time)) parts.push(`${lane.name} ${short(bar.text, 60)}`);
  }
  for (const one of within(TRANSITIONS, time)) {
    parts.push(`transition ${one.number}${one.type ? ` (${one.type})` : ""}, ${seconds(one.end - one.start)}`);
  }
  for (const one of DENSITIES) {
    const i = Math.round((time - one.first) / one.bin);
    if (SHOWN_ORDERS.has(one.order) && i >= 0 && i < one.curve.length) {
      parts.push(`P(boundary), ${one.hand}, order ${one.order}: ${Math.max(0, one.curve[i]).toFixed(3)}`);
    }
  }
  const near = FLAGS.filter((flag) => Math.abs(flag.time - time) < 0.05 + (state.to - state.from) / 200);
  parts.push(...near.slice(0, 2).map((flag) => `⚑ ${flag.why}`));
  $("readout").textContent = parts.join("  ·  ");
}

// The next of sorted times, or the one before; what was reached is said.
function jump(times, way, say) {
  if (!times.length) { $("said").textContent = "There is none."; return; }
  const step = 1e-4;
  let i = way > 0 ? placeOf(times, state.time + step) : placeOf(times, state.time - step) - 1;
  if (i < 0 || i >= times.length) { $("said").textContent = way > 0 ? "That was the last." : "That was the first."; return; }
  play(false);
  open(times[i], Math.max(1, (state.to - state.from) / 2));
  $("said").textContent = say(i);
  told.stopped?.();
}

function tagSaid(i) {
  const time = TAGS[i];
  const ends = SIGNS.filter((s) => Math.abs(s.end - time) < 1e-9).map((s) => `end of ${short(s.text)}`);
  const starts = SIGNS.filter((s) => Math.abs(s.start - time) < 1e-9).map((s) => `start of ${short(s.text)}`);
  return `${seconds(time, 3)}: ${[...ends, ...starts].join(", ")}`;
}

const nextTag = (way) => jump(TAGS, way, tagSaid);
const nextFlag = (way) => jump(FLAGS.map((f) => f.time), way, (i) => `${seconds(FLAGS[i].time, 3)}: ${FLAGS[i].why}`);
const nextTransition = (way) => jump(TRANSITIONS.map((t) => t.start), way, (i) => {
  const one = TRANSITIONS[i];
  return `${seconds(one.start, 3)}: transition ${one.number}, ${short(one.from)} → ${short(one.to)}`;
});

const KEYS = {
  " ": () => play(), n: () => nextTag(1), p: () => nextTag(-1), N: () => nextTag(-1),
  f: () => nextFlag(1), F: () => nextFlag(-1), t: () => nextTransition(1), T: () => nextTransition(-1),
  "+": () => zoom(0.5), "=": () => zoom(0.5), "-": () => zoom(2), 0: () => setView(0, LAST),
  ArrowRight: (event) => step(event.shiftKey ? 1 : 1 / DATA.rate),
  ArrowLeft: (event) => step(event.shiftKey ? -1 : -1 / DATA.rate),
  Home: () => step(-LAST), End: () => step(LAST), c: () => playPair(),
};

function step(by) {
  play(false);
  setTime(state.time + by);
  told.stopped?.();
}

const BUTTONS = {
  play: () => play(), "tag-before": () => nextTag(-1), "tag-after": () => nextTag(1),
  "flag-before": () => nextFlag(-1), "flag-after": () => nextFlag(1),
  closer: () => zoom(0.5), wider: () => zoom(2), whole: () => setView(0, LAST),
};

function listen() {
  for (const [kind, times] of [["tag", TAGS], ["flag", FLAGS]]) {
    $(`${kind}-after`).parentElement.hidden = !times.length;
  }
  for (const [id, act] of Object.entries(BUTTONS)) $(id).addEventListener("click", act);
  for (const button of document.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => lookFrom(button.dataset.view));
  }
  $("pace").addEventListener("change", (event) => (state.pace = Number(event.target.value)));
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.closest("input, select, textarea")) return;
    if (event.key === " " && event.target.closest("button, a, summary")) return;
    const act = KEYS[event.key];
    if (!act) return;
    event.preventDefault();
    act(event);
  });
  addEventListener("hashchange", openHash);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  new ResizeObserver(() => {
    const width = $("plots").clientWidth;
    for (const plot of panels) if (Math.abs(plot.width - width) > 1) plot.setSize({ width, height: plot.height });
    changed("view");
    changed("time");
  }).observe($("plots"));
  told.stopped = () => history.replaceState(null, "", `#t=${state.time.toFixed(2)}`);
}

function redraw() {
  strip = null;
  drawPlots();
  changed("view");
  changed("time");
}

function openHash() {
  const found = /[#&]t=([0-9.]+)/.exec(location.hash);
  if (!found) return false;
  const time = Math.min(Number(found[1]) || 0, LAST);
  const number = TRANSITIONS.find((one) => Math.abs(one.start - time) < 0.02)?.number;
  open(time);
  if (number !== undefined) chooseTransition(number);
  return true;
}

function follow() {
  told.view.push(() => {
    for (const plot of panels) plot.setScale("x", { min: state.from, max: state.to });
    document.body.dataset.from = state.from.toFixed(4);
    document.body.dataset.to = state.to.toFixed(4);
    drawOverview();
    placeHead();
  });
  told.time.push(() => {
    placeHead();
    drawOverview();
    drawBody();
    if (synthesis()) drawPair();
    document.body.dataset.time = state.time.toFixed(4);
    if (state.hover === null) readout();
  });
  told.hover.push(readout);
}

await readTracks();
await readBody();
await readMade();
drawPlots();
follow();
preparePair();
drawLists();
turned($("body"));
stripPointed();
listen();
if (!openHash()) { setView(0, Math.min(LAST, innerWidth < 600 ? 6 : 12)); setTime(0); }
document.body.dataset.ready = "yes";
