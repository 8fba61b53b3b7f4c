// The skeleton: joints of the recording at a time, turned and projected onto a canvas.
const BODY = DATA.skeleton;
const PLACE = Object.fromEntries(BODY.joints.map((joint, i) => [joint, i]));
const look = { yaw: 0, pitch: 0, zoom: 1 };
const TRAIL_S = BODY.handsOnly ? 1.2 : 0.6;
let MOTION = null; // columns: x, y, z of each joint
let STAGE = null; // middle and extent of what is drawn

async function readBody() {
  MOTION = await unpacked(BODY.positions);
  STAGE = stage();
}

// The middle and the half extents of the middle 98 % of all places: one glitch is no reason to
// make the body small.
function stage() {
  const middle = [], reach = [];
  for (let axis = 0; axis < 3; axis++) {
    const all = [];
    for (let c = axis; c < MOTION.length; c += 3) {
      const column = MOTION[c];
      const every = Math.max(1, Math.floor(column.length / 400));
      for (let i = 0; i < column.length; i += every) if (!Number.isNaN(column[i])) all.push(column[i]);
    }
    all.sort((a, b) => a - b);
    const low = all[Math.floor(all.length * 0.01)] ?? -1;
    const high = all[Math.floor(all.length * 0.99)] ?? 1;
    middle.push((low + high) / 2);
    reach.push(Math.max((high - low) / 2, 1e-9));
  }
  if ("head" in PLACE || "nose" in PLACE) { // the head is drawn around its joint
    const lift = 0.14 * reach[2];
    middle[2] += lift;
    reach[2] += lift;
  }
  const most = Math.max(...reach);
  return { middle, reach: reach.map((r) => Math.max(r, most * 0.35)) };
}

// Positions of all joints at a time, between frames along a straight line.
function posture(time) {
  const rows = BODY.positions.rows;
  const place = Math.min(Math.max(0, time * BODY.rate), rows - 1);
  return between(MOTION, 0, rows, place);
}

function between(columns, first, rows, place) {
  const i = Math.min(Math.floor(place), rows - 1), next = Math.min(i + 1, rows - 1), w = place - i;
  const out = new Float32Array(columns.length);
  for (let c = 0; c < columns.length; c++) {
    const a = columns[c][first + i], b = columns[c][first + next];
    out[c] = w < 1e-6 || Number.isNaN(b) ? (w > 0.5 ? b : a) : a + (b - a) * w;
  }
  return out;
}

// Screen x, y and depth of a place; from in front the signer's right hand is on the left.
function projection(width, height) {
  const { middle, reach } = STAGE;
  const cy = Math.cos(look.yaw), sy = Math.sin(look.yaw);
  const cp = Math.cos(look.pitch), sp = Math.sin(look.pitch);
  const across = BODY.flat ? reach[0] : Math.hypot(reach[0], 0.5 * reach[1]);
  const up = BODY.flat ? reach[2] : Math.hypot(reach[2], 0.3 * reach[1]);
  const scale = look.zoom * Math.min(width / (2.35 * across), height / (2.5 * up));
  return (x, y, z) => {
    x -= middle[0]; y -= middle[1]; z -= middle[2];
    const x1 = x * cy - y * sy, y1 = x * sy + y * cy;
    const z1 = z * cp - y1 * sp;
    return [width / 2 - x1 * scale, height / 2 - z1 * scale, scale, y1 * cp + z * sp];
  };
}

function jointColour(joint) {
  if (joint.startsWith("right_")) return css("--right");
  if (joint.startsWith("left_")) return css("--left");
  return css("--bone");
}

const sideOf = (i) => HANDS.find((hand) => BODY.joints[i].startsWith(`${hand}_`)) ?? "";

const FINE = new Set(BODY.joints.filter((j) => /_(thumb|index|middle|ring|pinky)_/.test(j)).map((j) => PLACE[j]));

function drawPosture(canvas, positions, { trail = null, label: name = "" } = {}) {
  const { ctx, width, height, px } = fitted(canvas);
  ctx.clearRect(0, 0, width, height);
  const project = projection(width, height);
  const at = (i) => project(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
  const known = (i) => !Number.isNaN(positions[3 * i]) && !Number.isNaN(positions[3 * i + 2]);
  if (BODY.handsOnly && BODY.positions.rows < 1500) drawWays(ctx, project, px);
  if (trail !== null) drawTrails(ctx, project, trail, px);
  ctx.lineCap = "round";
  const size = Math.min(width, height);
  const bones = BODY.bones.filter(([a, b]) => known(a) && known(b))
    .map(([a, b]) => ({ a: at(a), b: at(b), fine: FINE.has(a) || FINE.has(b), joint: sideOf(a) === sideOf(b) || !sideOf(a) ? BODY.joints[b] : "" }))
    .sort((one, other) => one.a[3] + one.b[3] - other.a[3] - other.b[3]);
  for (const bone of bones) {
    ctx.strokeStyle = jointColour(bone.joint);
    ctx.lineWidth = (bone.fine ? 0.006 : 0.013) * size;
    ctx.beginPath();
    ctx.moveTo(bone.a[0], bone.a[1]);
    ctx.lineTo(bone.b[0], bone.b[1]);
    ctx.stroke();
  }
  drawHead(ctx, positions, at, known, size);
  const unseen = [];
  BODY.joints.forEach((joint, i) => {
    const wrist = joint.endsWith("_wrist");
    if (!known(i)) { if (wrist) unseen.push(joint.split("_")[0]); return; }
    const [x, y] = at(i);
    ctx.fillStyle = jointColour(joint);
    const radius = wrist ? (BODY.handsOnly ? 0.022 : 0.013) : FINE.has(i) ? 0.004 : 0.006;
    if (wrist && joint.startsWith("left_")) {
      ctx.fillRect(x - radius * size, y - radius * size, 2 * radius * size, 2 * radius * size);
    } else disc(ctx, x, y, radius * size);
  });
  ctx.fillStyle = css("--soft");
  ctx.font = `${12 * px}px system-ui, sans-serif`;
  const told = [name, ...unseen.map((hand) => `${hand} wrist: gap`)].filter(Boolean).join(" · ");
  if (told) ctx.fillText(told, 8 * px, height - 8 * px);
}

function drawHead(ctx, positions, at, known, size) {
  const joint = ["head", "nose"].find((name) => name in PLACE);
  if (!joint || !known(PLACE[joint])) return;
  const [x, y, scale] = at(PLACE[joint]);
  const r = PLACE.right_shoulder, l = PLACE.left_shoulder;
  let radius = (DATA.unit === "m" ? 0.1 : 14) * scale;
  if (r !== undefined && l !== undefined && known(r) && known(l)) {
    const wide = Math.hypot(...[0, 1, 2].map((k) => positions[3 * r + k] - positions[3 * l + k]));
    if (wide > 0) radius = 0.27 * wide * scale;
  }
  ctx.strokeStyle = css("--bone");
  ctx.lineWidth = 0.011 * size;
  ctx.beginPath();
  ctx.arc(x, y - (joint === "head" ? 0.6 * radius : 0), radius, 0, 2 * Math.PI);
  ctx.stroke();
}

// The whole way of the wrists of a short recording of few joints, which has no body to look at.
function drawWays(ctx, project, px) {
  ctx.lineWidth = px;
  ctx.globalAlpha = 0.3;
  for (const hand of HANDS) {
    const i = PLACE[`${hand}_wrist`];
    if (i === undefined) continue;
    ctx.strokeStyle = css(`--${hand}`);
    ctx.beginPath();
    let down = false;
    for (let row = 0; row < BODY.positions.rows; row++) {
      const [x, y, z] = [0, 1, 2].map((a) => MOTION[3 * i + a][row]);
      if (Number.isNaN(x)) { down = false; continue; }
      const [u, v] = project(x, y, z);
      if (down) ctx.lineTo(u, v); else ctx.moveTo(u, v);
      down = true;
    }
    ctx.stroke();
  }
  ctx.globalAlpha = 1;
}

// Where the wrists came from.
function drawTrails(ctx, project, time, px) {
  const steps = 24;
  for (const hand of HANDS) {
    const i = PLACE[`${hand}_wrist`];
    if (i === undefined) continue;
    ctx.strokeStyle = css(`--${hand}`);
    ctx.lineWidth = 1.5 * px;
    let before = null;
    for (let k = 0; k <= steps; k++) {
      const past = time - TRAIL_S * (1 - k / steps);
      const place = Math.max(0, past * BODY.rate);
      const row = Math.min(Math.floor(place), BODY.positions.rows - 1);
      const next = Math.min(row + 1, BODY.positions.rows - 1), w = Math.min(1, place - row);
      const [x, y, z] = [0, 1, 2].map((a) => {
        const column = MOTION[3 * i + a];
        return column[row] + (column[next] - column[row]) * w;
      });
      const here = Number.isNaN(x) || past < 0 ? null : project(x, y, z);
      if (here && before) {
        ctx.globalAlpha = (0.6 * k) / steps;
        ctx.beginPath();
        ctx.moveTo(before[0], before[1]);
        ctx.lineTo(here[0], here[1]);
        ctx.stroke();
      }
      before = here;
    }
    ctx.globalAlpha = 1;
  }
}

function drawBody() {
  drawPosture($("body"), posture(state.time), { trail: state.time });
}

const VIEWS = { front: [0, 0], side: [-Math.PI / 2, 0], above: [0, -Math.PI / 2 + 0.001] };

function lookFrom(view) {
  [look.yaw, look.pitch] = VIEWS[view];
  look.zoom = 1;
  changed("time");
}

// Turning by pointer or arrow keys.
function turned(canvas) {
  if (BODY.flat) return;
  const turn = (dx, dy) => {
    look.yaw += dx;
    look.pitch = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, look.pitch + dy));
    changed("time");
  };
  let held = null;
  canvas.style.touchAction = "pan-y";
  canvas.style.cursor = "grab";
  canvas.addEventListener("pointerdown", (event) => {
    held = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    turn((event.clientX - held[0]) * 0.01, -(event.clientY - held[1]) * 0.01);
    held = [event.clientX, event.clientY];
  });
  canvas.addEventListener("pointerup", () => (held = null));
  canvas.addEventListener("pointercancel", () => (held = null));
  canvas.addEventListener("dblclick", () => lookFrom("front"));
  canvas.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
    if (!by) return;
    turn(...by);
    event.preventDefault();
    event.stopPropagation();
  });
}
