// The plots above one time axis: uPlot draws axes, curves and the cursor, the marks are ours.
const panels = [];
const AXIS = { wide: 56, narrow: 44 };
const FONT = "12px system-ui, sans-serif";
const axisWidth = () => (innerWidth < 600 ? AXIS.narrow : AXIS.wide);

function panel(host, { name, height, data, series = [], top = 1, unit = "", marks, below, last }) {
  const box = element("div", undefined, { class: "panel", "data-panel": name });
  host.append(box);
  const axis = {
    stroke: () => css("--soft"), font: FONT,
    grid: { stroke: () => css("--grid"), width: 1 }, ticks: { stroke: () => css("--grid"), width: 1 },
  };
  const options = {
    width: Math.max(200, host.clientWidth), height, padding: [unit ? 19 : 6, 8, last ? 0 : 4, 0],
    legend: { show: false },
    cursor: { y: false, drag: { x: false, y: false, setScale: false }, sync: { key: "time" },
              points: { show: series.length > 0 } },
    scales: { x: { time: false, min: state.from, max: state.to, range: (u, a, b) => [a, b] },
              y: { range: [0, top] } },
    axes: [
      { ...axis, show: !!last, size: last ? 30 : 0, incrs: STEPS_S, space: 60, values: (u, ticks) => ticks.map(tickText) },
      { ...axis, show: true, size: axisWidth, values: (u, v) => (series.length ? v : v.map(() => "")),
        grid: series.length ? axis.grid : { show: false },
        ticks: series.length ? axis.ticks : { show: false } },
    ],
    series: [{}, ...(series.length ? series : [{ show: false }])],
    hooks: {
      drawClear: below ? [(u) => clipped(u, below)] : [],
      draw: marks ? [(u) => clipped(u, marks)] : [],
    },
  };
  const plot = new uPlot(options, data || [[0, LAST], [null, null]], box);
  const note = element("div", unit, { class: "unit" });
  box.append(note);
  plot.over.setAttribute("role", "img");
  plot.over.setAttribute("aria-label", name);
  pointed(plot);
  panels.push(plot);
  return plot;
}

// Between ticks, in s: parts of a second, then of a minute, then of an hour.
const STEPS_S = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 1200, 3600];

const tickText = (value) => {
  if (LAST < 120) return String(+value.toFixed(3));
  const minutes = Math.floor(value / 60 + 1e-9);
  const rest = +(value - 60 * minutes).toFixed(3);
  return `${minutes}:${rest < 10 ? "0" : ""}${rest}`;
};

function clipped(u, draw) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.beginPath();
  ctx.rect(0, bbox.top, bbox.left + bbox.width, bbox.height);
  ctx.clip();
  draw(u, ctx, { x: (time) => u.valToPos(time, "x", true), y: (v) => u.valToPos(v, "y", true),
                 left: bbox.left, top: bbox.top, width: bbox.width, height: bbox.height,
                 px: devicePixelRatio });
  ctx.restore();
}

// Draws what of a sorted list of times is in the window, no two on one pixel.
function each(times, to, draw) {
  let before = -Infinity;
  const end = state.to + 1e-9;
  for (let i = placeOf(times, state.from); i < times.length && times[i] <= end; i++) {
    const x = to.x(times[i]);
    if (x - before < to.px) continue;
    before = x;
    draw(x, i);
  }
}

function shadeSigns(u, ctx, to) {
  ctx.fillStyle = css("--wash");
  for (const sign of SIGNS) {
    if (sign.end < state.from || sign.start > state.to) continue;
    const x = Math.max(to.left, to.x(sign.start));
    ctx.fillRect(x, to.top, Math.max(1, to.x(sign.end) - x), to.height);
  }
}

function shadeGaps(ctx, to, hand) {
  for (const [first, last, filled] of DATA.gaps[hand] || []) {
    const a = first / 1000, b = last / 1000 + 1 / DATA.rate;
    if (b < state.from || a > state.to) continue;
    ctx.fillStyle = css(filled ? "--filled" : "--gap");
    const x = Math.max(to.left, to.x(a));
    ctx.fillRect(x, to.top + to.height - 6 * to.px, Math.max(1, to.x(b) - x), 6 * to.px);
  }
}

// Whether marks stand so close in the window that lines would fill it: then they are ticks.
const crowded = (times, to) =>
  placeOf(times, state.to) - placeOf(times, state.from) > to.width / (8 * to.px);

// Upright lines at times, in one stroke: hundreds of strokes would make moving along jerky.
function lines(ctx, times, to, top, foot) {
  ctx.beginPath();
  each(times, to, (x) => { ctx.moveTo(x, top); ctx.lineTo(x, foot); });
  ctx.stroke();
}

function speedMarks(hand) {
  const refinedTimes = REFINED[hand].map((tag) => tag.time);
  return (u, ctx, to) => {
    const foot = to.top + to.height;
    const tick = 8 * to.px;
    ctx.lineWidth = to.px;
    ctx.strokeStyle = css("--tag");
    const full = !crowded(TAGS, to);
    if (full) ctx.setLineDash([4 * to.px, 3 * to.px]);
    lines(ctx, TAGS, to, full ? to.top : foot - tick, foot);
    ctx.setLineDash([]);
    shadeGaps(ctx, to, hand);
    ctx.fillStyle = css("--ink");
    const radius = (crowded(MINIMA[hand], to) ? 1.2 : 2.4) * to.px;
    each(MINIMA[hand], to, (x, i) => {
      const y = to.y(speedAt(hand, MINIMA[hand][i]));
      if (!Number.isFinite(y)) return;
      if (radius < 2 * to.px) ctx.fillRect(x - radius, y - radius, 2 * radius, 2 * radius);
      else disc(ctx, x, y, radius);
    });
    ctx.strokeStyle = ctx.fillStyle = css(`--${hand}`);
    ctx.lineWidth = 1.5 * to.px;
    if (crowded(refinedTimes, to)) { lines(ctx, refinedTimes, to, to.top, to.top + tick); return; }
    lines(ctx, refinedTimes, to, to.top + tick, foot);
    each(refinedTimes, to, (x, i) => {
      triangle(ctx, x, to.top, 5 * to.px, REFINED[hand][i].status === "m");
    });
  };
}

function disc(ctx, x, y, radius) {
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
  ctx.fill();
}

function triangle(ctx, x, y, size, full) {
  ctx.beginPath();
  ctx.moveTo(x - size, y + 1);
  ctx.lineTo(x + size, y + 1);
  ctx.lineTo(x, y + 1.6 * size);
  ctx.closePath();
  if (full) ctx.fill(); else ctx.stroke();
}

function drawSpeeds(host) {
  const hands = DATA.speeds.hands;
  for (const hand of hands) {
    const curve = Array.from(SPEEDS[hand], (v) => (Number.isNaN(v) ? null : v));
    panel(host, {
      name: `Speed of the ${hand} wrist over time`, height: 150, data: [SPEED_TIMES, curve],
      series: [{ stroke: () => css(`--${hand}`), width: 1.6, points: { show: false } }],
      top: DATA.speeds.top * 1.08 || 1, unit: `${hand} wrist, ${SPEED_UNIT}`,
      below: shadeSigns, marks: speedMarks(hand),
    });
  }
}
