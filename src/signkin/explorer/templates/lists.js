// What is to be looked at, and the transitions, as lists whose rows open at their time.
const PAGE_ROWS = innerWidth < 600 ? 15 : 50;

function list(host, rows, fill) {
  let first = 0;
  const body = host.querySelector("tbody");
  const pager = host.querySelector(".pager");
  const show = () => {
    body.replaceChildren(...rows.slice(first, first + PAGE_ROWS).map(fill));
    pager.hidden = rows.length <= PAGE_ROWS;
    pager.querySelector("span").textContent =
      `${first + 1} to ${Math.min(rows.length, first + PAGE_ROWS)} of ${rows.length}`;
  };
  const [before, after] = pager.querySelectorAll("button");
  before.addEventListener("click", () => { first = Math.max(0, first - PAGE_ROWS); show(); });
  after.addEventListener("click", () => {
    if (first + PAGE_ROWS < rows.length) first += PAGE_ROWS;
    show();
  });
  show();
}

function opener(time) {
  const cell = element("td");
  const button = element("button", seconds(time), { type: "button", class: "link" });
  button.addEventListener("click", () => {
    open(time, 2);
    told.stopped?.();
    $("body").scrollIntoView({ block: "nearest" });
  });
  cell.append(button);
  return cell;
}

function row(...cells) {
  const made = element("tr");
  made.append(...cells.map((cell) => (cell instanceof Node ? cell : element("td", cell))));
  return made;
}

const lasts = (ends) => (ends && ends[0] !== null ? ((ends[1] - ends[0]) / 1000).toFixed(2) : "–");

function drawLists() {
  $("flags").hidden = !FLAGS.length;
  if (FLAGS.length) list($("flags"), FLAGS, (flag) => row(opener(flag.time), flag.why));
  $("transitions").hidden = !TRANSITIONS.length;
  if (TRANSITIONS.length) {
    list($("transitions"), TRANSITIONS, (one) => row(
      opener(one.start), `${short(one.from, 40)} → ${short(one.to, 40)}`,
      one.type ? one.type + (one.kinematic ? "*" : "") : "–",
      lasts(one.manual), lasts(one.right), lasts(one.left),
      one.status === "ok" ? (one.outlier ? "outlier" : "") : one.status.replace("_", " ")));
  }
}
