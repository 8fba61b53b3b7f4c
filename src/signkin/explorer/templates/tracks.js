// The curves and marks of the recording, unpacked.
const SPEEDS = {};
let SPEED_TIMES = [];
let DENSITIES = [];

async function readTracks() {
  if (DATA.speeds) {
    const columns = await unpacked(DATA.speeds.values);
    DATA.speeds.hands.forEach((hand, i) => (SPEEDS[hand] = columns[i]));
    SPEED_TIMES = Float64Array.from(
      { length: DATA.speeds.values.rows }, (_, i) => i / DATA.speeds.rate);
  }
  DENSITIES = [];
  for (const one of DATA.densities) {
    DENSITIES.push({ ...one, boundaries: summed(one.times), curve: (await unpacked(one.values))[0] });
  }
}

function speedAt(hand, time) {
  const curve = SPEEDS[hand];
  if (!curve) return NaN;
  const place = time * DATA.speeds.rate;
  const i = Math.min(Math.max(0, Math.floor(place)), curve.length - 1);
  const next = Math.min(i + 1, curve.length - 1);
  return curve[i] + (curve[next] - curve[i]) * Math.min(1, place - i);
}

const MINIMA = Object.fromEntries(HANDS.map((hand) => [hand, summed(DATA.minima[hand] || [])]));
const SIGNS = (DATA.lanes.find((lane) => lane.role === "sign") || { tags: [] }).tags
  .map(([start, end, text]) => ({ start: start / 1000, end: end / 1000, text: label(text) }));
const TAGS = [...new Set(SIGNS.flatMap((sign) => [sign.start, sign.end]))].sort((a, b) => a - b);
const FLAGS = DATA.flags.map((flag) => ({ time: flag.at / 1000, why: flag.why }));
const TRANSITIONS = DATA.transitions.rows.map((values) => Object.fromEntries(
  DATA.transitions.fields.map((field, i) => [field, values[i]]))).map((one) => ({
  ...one,
  from: label(one.labels[0]), to: label(one.labels[1]),
  start: one.manual[0] / 1000, end: one.manual[1] / 1000,
}));

// Refined tags: hand -> {time, edge, sign, status, off}, in order of time.
const REFINED = Object.fromEntries(HANDS.map((hand) => [
  hand,
  (DATA.refined[hand] || [])
    .map(([sign, edge, at, status, off]) => ({ sign, edge, time: at / 1000, status, off }))
    .sort((a, b) => a.time - b.time),
]));

// The refined signs of a hand as intervals, for its lane.
function refinedSigns(hand) {
  const found = new Map();
  for (const tag of REFINED[hand]) {
    const one = found.get(tag.sign) || { text: SIGNS[tag.sign]?.text ?? "" };
    one[tag.edge ? "end" : "start"] = tag.time;
    found.set(tag.sign, one);
  }
  return [...found.values()].filter((one) => one.end > one.start).sort((a, b) => a.start - b.start);
}

// Boundaries by binning: a hand, their times and posteriors.
const STEMS = DATA.boundaries.map((one) => ({
  hand: one.hand, order: one.order, times: summed(one.times), values: one.values.map((p) => p / 100),
}));

// The intervals of a sorted list that a time lies in.
const within = (list, time) => list.filter((one) => one.start <= time && time < one.end);
