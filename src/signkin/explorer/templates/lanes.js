// Tags as bars: signs, the other tiers, the refined signs of each hand, the transitions.
const ROW = 20;
const SHORT = { utterance: "utter.", translation: "transl." };

function laneRows() {
  const rows = DATA.lanes.map((lane) => ({
    name: lane.role, colour: lane.role === "sign" ? "--tag" : "--soft",
    bars: lane.tags.map(([a, b, text]) => ({ start: a / 1000, end: b / 1000, text: label(text) })),
  }));
  for (const hand of HANDS) {
    if (REFINED[hand].length) rows.push({ name: hand, colour: `--${hand}`, bars: refinedSigns(hand) });
  }
  if (TRANSITIONS.length) {
    rows.push({
      name: "trans.", colour: "--transition",
      bars: TRANSITIONS.filter((t) => t.end > t.start).map((t) => ({
        start: t.start, end: t.end, text: t.type || String(t.number) })),
    });
  }
  if (FLAGS.length) rows.push({ name: "flags", flags: true, bars: [] });
  return rows;
}

const LANES = laneRows();

function drawLanes(host, last) {
  if (!LANES.length) return;
  panel(host, {
    name: "Tags over time", height: LANES.length * ROW + 12 + (last ? 30 : 0), last,
    marks: (u, ctx, to) => {
      ctx.font = `${11.5 * to.px}px system-ui, sans-serif`;
      ctx.textBaseline = "middle";
      const height = to.height / LANES.length;
      LANES.forEach((row, i) => {
        const top = to.top + i * height;
        ctx.fillStyle = css("--soft");
        ctx.textAlign = "right";
        ctx.fillText(SHORT[row.name] ?? short(row.name, 8), to.left - 6 * to.px, top + height / 2);
        ctx.textAlign = "left";
        if (row.flags) drawFlags(ctx, to, top, height); else drawBars(ctx, to, row, top, height);
      });
    },
  });
}

function drawBars(ctx, to, row, top, height) {
  const colour = css(row.colour), ink = css("--ink");
  let before = -Infinity;
  ctx.save();
  ctx.beginPath();
  ctx.rect(to.left, top, to.width, height);
  ctx.clip();
  for (const bar of row.bars) {
    if (bar.end < state.from || bar.start > state.to) continue;
    const a = to.x(bar.start), b = to.x(bar.end);
    if (b - before < to.px) continue;
    before = b;
    const left = Math.max(a, to.left - 4), width = Math.max(1, Math.min(b, to.left + to.width + 4) - left);
    ctx.globalAlpha = 0.28;
    ctx.fillStyle = colour;
    ctx.fillRect(left, top + 2 * to.px, width, height - 4 * to.px);
    ctx.globalAlpha = 1;
    ctx.fillRect(left, top + 2 * to.px, Math.min(2 * to.px, width), height - 4 * to.px);
    if (width > 26 * to.px) {
      ctx.fillStyle = ink;
      ctx.fillText(fitting(ctx, bar.text, width - 8 * to.px), left + 5 * to.px, top + height / 2);
    }
  }
  ctx.restore();
}

function fitting(ctx, text, width) {
  if (ctx.measureText(text).width <= width) return text;
  let most = Math.min(text.length, 60);
  while (most > 1 && ctx.measureText(text.slice(0, most) + "…").width > width) most--;
  return text.slice(0, most) + "…";
}

function drawFlags(ctx, to, top, height) {
  ctx.fillStyle = css("--flag");
  each(FLAGS.map((flag) => flag.time), to, (x) => {
    ctx.beginPath();
    ctx.moveTo(x, top + 3 * to.px);
    ctx.lineTo(x + 9 * to.px, top + 7 * to.px);
    ctx.lineTo(x, top + 11 * to.px);
    ctx.closePath();
    ctx.fill();
    ctx.fillRect(x - to.px / 2, top + 3 * to.px, 1.4 * to.px, height - 6 * to.px);
  });
}
