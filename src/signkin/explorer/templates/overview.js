// The whole recording as a strip: its speed, what is to be looked at, and the window, to drag.
let strip = null; // its picture without the window, drawn once for a size and a scheme

function drawOverview() {
  const canvas = $("overview");
  const { ctx, width, height } = fitted(canvas);
  if (!strip || strip.width !== width || strip.height !== height) strip = picture(width, height);
  ctx.clearRect(0, 0, width, height);
  ctx.drawImage(strip, 0, 0);
  const at = (time) => (time / LAST) * width;
  const a = at(state.from), b = Math.max(a + 3, at(state.to));
  ctx.fillStyle = css("--veil");
  ctx.fillRect(0, 0, a, height);
  ctx.fillRect(b, 0, width - b, height);
  ctx.strokeStyle = css("--ink");
  ctx.lineWidth = 2;
  ctx.strokeRect(a + 1, 1, Math.max(2, b - a - 2), height - 2);
  ctx.fillStyle = css("--head");
  ctx.fillRect(at(state.time) - 1, 0, 2, height);
}

// Greatest speed of either hand, a column a pixel, and the flags.
function picture(width, height) {
  const made = new OffscreenCanvas(width, height);
  const ctx = made.getContext("2d");
  const speeds = profile(width);
  const top = Math.max(1e-9, ...speeds);
  ctx.fillStyle = css("--profile");
  for (let x = 0; x < width; x++) {
    const tall = (speeds[x] / top) * (height - 4);
    ctx.fillRect(x, height - tall, 1, tall);
  }
  ctx.fillStyle = css("--flag");
  for (const flag of FLAGS) ctx.fillRect((flag.time / LAST) * width, 0, 2, 6);
  return made;
}

function profile(width) {
  const out = new Float32Array(width);
  for (const curve of Object.values(SPEEDS)) {
    for (let x = 0; x < width; x++) {
      const first = Math.floor((x / width) * curve.length);
      const end = Math.max(first + 1, Math.floor(((x + 1) / width) * curve.length));
      for (let i = first; i < end; i++) if (curve[i] > out[x]) out[x] = curve[i];
    }
  }
  return out;
}

// A canvas in the pixels of the screen.
function fitted(canvas) {
  const px = devicePixelRatio || 1;
  const width = Math.max(1, Math.round(canvas.clientWidth * px));
  const height = Math.max(1, Math.round(canvas.clientHeight * px));
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
  return { ctx: canvas.getContext("2d"), width, height, px };
}

function stripPointed() {
  const canvas = $("overview");
  let grip = null;
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return ((event.clientX - box.left) / box.width) * LAST;
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    const time = at(event), span = state.to - state.from;
    if (time < state.from || time > state.to) setView(time - span / 2, time + span / 2);
    grip = time - state.from;
    if (span > 0.95 * LAST) { grip = null; setTime(time); }
  });
  canvas.addEventListener("pointermove", (event) => {
    if (grip === null || !event.buttons) return;
    const from = at(event) - grip;
    setView(from, from + state.to - state.from);
  });
  canvas.addEventListener("pointerup", () => (grip = null));
}
