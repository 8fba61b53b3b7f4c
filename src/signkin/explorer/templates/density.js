// Where binning sees boundaries: a curve an order (single signs), or a stem a boundary.
const ORDER_DASHES = [[], [7, 3], [2, 2], [8, 3, 2, 3], [12, 3], [1, 3], [5, 5], [3, 1]];

function drawDensities(host, chips) {
  if (DENSITIES.length) drawOrders(host, chips);
  else if (STEMS.length) drawStems(host);
}

function drawOrders(host, chips) {
  const first = DENSITIES[0];
  const times = Array.from(first.curve, (_, i) => first.first + i * first.bin);
  const likely = DENSITIES.reduce((a, b) => (b.probability > a.probability ? b : a));
  let top = 0.05;
  for (const one of DENSITIES) for (const v of one.curve) if (v > top) top = v;
  const plot = panel(host, {
    name: "Posterior of boundaries over time, by order", height: 140,
    data: [times, ...DENSITIES.map((one) => Array.from(one.curve))],
    series: DENSITIES.map((one, i) => ({
      label: `order ${one.order}`, show: one === likely, width: one === likely ? 2 : 1.4,
      stroke: () => css(`--order-${i % 8}`), dash: ORDER_DASHES[i % 8], points: { show: false },
    })),
    top: top * 1.08, unit: `${first.hand} wrist, P(boundary) a bin`,
    marks: (u, ctx, to) => {
      DENSITIES.forEach((one, i) => {
        if (!u.series[i + 1].show) return;
        ctx.fillStyle = css(`--order-${i % 8}`);
        each(one.boundaries, to, (x) => triangle(ctx, x, to.top, 4.5 * to.px, true));
      });
    },
  });
  chips.append(element("span", "Orders (posterior):", { class: "soft" }));
  DENSITIES.forEach((one, i) => {
    const text = `${one.order} (${one.probability < 0.001 ? "<0.001" : one.probability.toFixed(3)})`;
    const chip = element("button", text, { type: "button", class: "chip",
      "aria-pressed": String(one === likely), style: `--chip: var(--order-${i % 8})` });
    chip.addEventListener("click", () => {
      const on = chip.getAttribute("aria-pressed") !== "true";
      chip.setAttribute("aria-pressed", String(on));
      plot.setSeries(i + 1, { show: on });
    });
    chips.append(chip);
  });
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
