// Where binning sees boundaries: a curve an order (single signs), or a stem a boundary.
const ORDER_DASHES = [[], [7, 3], [2, 2], [8, 3, 2, 3], [12, 3], [1, 3], [5, 5], [3, 1]];

const SHOWN_ORDERS = new Set();

function drawDensities(host, chips) {
  if (DENSITIES.length) drawOrders(host, chips);
  else if (STEMS.length) drawStems(host);
}

// A panel a hand: the curves of the orders chosen, their boundaries on top, and, for the order
// that the run's tables have, a stem a boundary with its posterior.
function drawOrders(host, chips) {
  const orders = [...new Set(DENSITIES.map((one) => one.order))].sort((a, b) => a - b);
  const likely = DENSITIES.reduce((a, b) => (b.probability > a.probability ? b : a)).order;
  if (!SHOWN_ORDERS.size) SHOWN_ORDERS.add(STEMS.length ? STEMS[0].order : likely);
  const hands = HANDS.filter((hand) => DENSITIES.some((one) => one.hand === hand));
  const plots = hands.map((hand) => [hand, drawHand(host, hand, hands.length)]);
  const of = hands.length > 1 ? ` of ${hands.join(" and ")}` : "";
  chips.append(element("span", `Orders (posterior${of}):`, { class: "soft" }));
  for (const order of orders) {
    const own = DENSITIES.filter((one) => one.order === order);
    const shares = own.map((one) => (one.probability < 0.001 ? "<0.001" : one.probability.toFixed(3)));
    const chip = element("button", `${order} (${shares.join(", ")})`, { type: "button", class: "chip",
      "aria-pressed": String(SHOWN_ORDERS.has(order)), style: `--chip: var(--order-${order % 8})` });
    chip.addEventListener("click", () => {
      if (!SHOWN_ORDERS.delete(order)) SHOWN_ORDERS.add(order);
      chip.setAttribute("aria-pressed", String(SHOWN_ORDERS.has(order)));
      for (const [hand, plot] of plots) {
        const i = DENSITIES.filter((one) => one.hand === hand).findIndex((one) => one.order === order);
        if (i >= 0) plot.setSeries(i + 1, { show: SHOWN_ORDERS.has(order) });
      }
      readout();
    });
    chips.append(chip);
  }
}

function drawHand(host, hand, hands) {
  const own = DENSITIES.filter((one) => one.hand === hand);
  const stems = STEMS.find((one) => one.hand === hand);
  const first = own[0];
  const times = Array.from(first.curve, (_, i) => first.first + i * first.bin);
  let top = 0.05;
  for (const one of own) for (const v of one.curve) if (v > top) top = v;
  return panel(host, {
    name: `Posterior of boundaries over time, by order: ${hand} wrist`, height: hands > 1 ? 110 : 140,
    data: [times, ...own.map((one) => Array.from(one.curve))],
    series: own.map((one) => ({
      label: `order ${one.order}`, show: SHOWN_ORDERS.has(one.order), width: 1.6,
      stroke: () => css(`--order-${one.order % 8}`), dash: ORDER_DASHES[one.order % 8],
      points: { show: false },
    })),
    top: stems ? 1.08 : top * 1.08, unit: `${hand} wrist, P(boundary) a bin`,
    marks: (u, ctx, to) => {
      for (const one of own) {
        if (!SHOWN_ORDERS.has(one.order)) continue;
        const colour = css(`--order-${one.order % 8}`);
        if (stems && stems.order === one.order) drawStemsOf(stems, ctx, to, colour);
        ctx.fillStyle = colour;
        if (!crowded(one.boundaries, to)) each(one.boundaries, to, (x) => triangle(ctx, x, to.top, 4.5 * to.px, true));
      }
    },
  });
}

function drawStemsOf(stems, ctx, to, colour) {
  const close = crowded(stems.times, to);
  ctx.strokeStyle = ctx.fillStyle = colour;
  ctx.lineWidth = to.px;
  ctx.globalAlpha = 0.35;
  ctx.beginPath();
  each(stems.times, to, (x, i) => {
    ctx.moveTo(x, to.y(0));
    ctx.lineTo(x, to.y(stems.values[i]));
  });
  ctx.stroke();
  ctx.globalAlpha = 1;
  if (!close) each(stems.times, to, (x, i) => disc(ctx, x, to.y(stems.values[i]), 2.4 * to.px));
}

function drawStems(host) {
  const orders = [...new Set(STEMS.map((one) => one.order))].join(", ");
  panel(host, {
    name: "Boundaries by binning, with their posterior", height: 90,
    data: [[0, LAST], [null, null]], series: [{ points: { show: false } }],
    top: 1.1, unit: `boundaries by binning (order ${orders}), posterior`,
    marks: (u, ctx, to) => {
      for (const one of STEMS) {
        const shift = (one.hand === "left" ? 1 : -1) * to.px;
        ctx.strokeStyle = ctx.fillStyle = css(`--${one.hand}`);
        ctx.lineWidth = 1.6 * to.px;
        ctx.globalAlpha = crowded(one.times, to) ? 0.5 : 1;
        ctx.beginPath();
        each(one.times, to, (x, i) => {
          ctx.moveTo(x + shift, to.y(0));
          ctx.lineTo(x + shift, to.y(one.values[i]));
        });
        ctx.stroke();
        if (crowded(one.times, to)) continue;
        each(one.times, to, (x, i) => {
          const y = to.y(one.values[i]);
          if (one.hand === "left") ctx.fillRect(x + shift - 2 * to.px, y - 2 * to.px, 4 * to.px, 4 * to.px);
          else disc(ctx, x + shift, y, 2.4 * to.px);
        });
      }
    },
  });
}
