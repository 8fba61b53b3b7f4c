// The content of the page, unpacked: see explorer/packing.py.
const DATA = JSON.parse(document.getElementById("data").textContent);
const GAP = -32768;

async function inflated(text) {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Returns an array a column, NaN in gaps.
async function unpacked(pack) {
  const bytes = await inflated(pack.data);
  const { rows, columns, step, offsets } = pack;
  const high = rows * columns;
  const out = [];
  for (let c = 0; c < columns; c++) {
    const column = new Float32Array(rows);
    let whole = 0;
    for (let i = 0, k = c * rows; i < rows; i++, k++) {
      whole = ((whole + bytes[k] + (bytes[high + k] << 8)) << 16) >> 16;
      column[i] = whole === GAP ? NaN : whole * step + offsets[c];
    }
    out.push(column);
  }
  return out;
}

// What was written as distances from the one before, in ms, as times in s.
function summed(steps) {
  let at = 0;
  return Float64Array.from(steps, (step) => (at += step) / 1000);
}

// The first place in sorted times that is not before a time.
function placeOf(times, time) {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1; else high = middle;
  }
  return low;
}

const label = (place) => DATA.labels[place];
const short = (text, most = 28) => (text.length > most ? text.slice(0, most - 1) + "…" : text);
const seconds = (time, digits = 2) => time.toFixed(digits) + " s";
const HANDS = ["right", "left"];
const SPEED_UNIT = DATA.unit === "px" ? "px/s" : "m/s";
const speedText = (value) =>
  Number.isFinite(value) ? value.toFixed(DATA.unit === "px" ? 0 : 2) : "–";
const $ = (id) => document.getElementById(id);
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function element(tag, text, attributes = {}) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}
