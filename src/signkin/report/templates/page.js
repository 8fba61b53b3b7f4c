"use strict";
// Tables that sort, filter and turn pages; marks in plots. Without it the first rows are there.
(() => {
const MOST_AT_ONCE = 500;
const WORDS = ["verdict", "link", "open", "rating"]; // formats of columns that hold text
const place = (tag, text, into, attributes = {}) => {
  const made = document.createElement(tag);
  if (text !== null) made.textContent = text;
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (into) into.append(made);
  return made;
};
const number = text => {
  const found = /[-+]?\d[\d,]*\.?\d*(?:e[-+]?\d+)?/i.exec(text.replace("−", "-"));
  return found ? parseFloat(found[0].replaceAll(",", "")) : NaN;
};
const chosen = { key: "", value: "" };
const tables = [];

const link = (td, address, text) => {
  // Only files: a gloss or a name cannot bring an address of another kind.
  if (/^[\w.+-]*:/.test(address)) return void (td.textContent = text);
  place("a", text, td, { href: address });
};
const fill = (td, text, form, heading) => {
  const length = text.length > 40 ? "text long" : text.length <= 16 ? "text short" : "text";
  td.className = !form ? length : WORDS.includes(form) ? "text" : "number";
  if (form === "verdict") {
    place("span", text, td, { class: "verdict " + text.replaceAll(" ", "-") });
  } else if (form === "link") {
    td.textContent = text ? "" : "–";
    for (const file of text.split(" ").filter(Boolean)) {
      link(td, file, file.split("/").pop().replace(/\.html$/, ""));
      td.append(" ");
    }
  } else if (form === "open") {
    if (text) link(td, text, heading); else td.textContent = "–";
  } else if (form !== "rating") {
    td.textContent = text || "–";
  }
};

class Table {
  constructor(box) {
    this.box = box;
    this.table = box.querySelector("table");
    this.body = this.table.tBodies[0];
    this.heads = [...this.table.tHead.rows[0].cells];
    this.forms = this.heads.map(th => th.dataset.form);
    this.keys = (box.dataset.keys || "").split(" ").filter(Boolean);
    this.size = Number(box.dataset.most);
    this.rows = [...this.body.rows].map((tr, at) => (
      { tr, at, cells: [...tr.cells].map(td => td.textContent.trim()), keys: { ...tr.dataset } }));
    const more = box.querySelector("script.more");
    for (const cells of more ? JSON.parse(more.textContent) : []) {
      const keys = {};
      this.keys.forEach((key, i) => { keys[key] = cells[this.heads.length + i]; });
      this.rows.push({ tr: null, at: this.rows.length, cells, keys });
    }
    this.columnOf = -1;
    this.down = false;
    this.page = 0;
    this.words = [];
    this.bar();
    this.heading();
    this.show();
  }
  bar() {
    const bar = document.createElement("div");
    bar.className = "bar";
    this.box.before(bar);
    const title = this.box.dataset.title;
    if (this.rows.length > 12) {
      const label = place("label", "Filter ", bar);
      const input = place("input", null, label, { type: "search", "aria-label": "Filter the rows of " + title });
      input.addEventListener("input", () => {
        this.words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
        this.page = 0;
        this.show();
      });
    }
    const signers = [...new Set(this.rows.map(row => row.keys.signer).filter(Boolean))].sort();
    if (document.querySelector("svg.plot") && signers.length > 1) {
      const label = place("label", "Mark signer ", bar);
      const select = place("select", null, label);
      for (const name of ["", ...signers]) place("option", name || "–", select, { value: name });
      select.addEventListener("change", () => choose(select.value ? "signer" : "", select.value));
    }
    this.told = place("span", "", bar, { class: "told", "aria-live": "polite" });
    this.buttons = ["Previous", "Next", "All"].map(text => {
      const button = place("button", text, bar, { type: "button", "aria-label": `${text} rows of ${title}` });
      button.addEventListener("click", () => this.turn(text));
      return button;
    });
  }
  heading() {
    if (this.rows.length < 2) return;
    this.heads.forEach((th, i) => {
      if (this.forms[i] === "rating" || this.forms[i] === "open") return;
      const text = th.textContent.trim();
      th.textContent = "";
      const button = place("button", text || "column", th, { type: "button", class: "sort" });
      button.addEventListener("click", () => this.sort(i));
    });
  }
  sort(i) {
    this.down = this.columnOf === i ? !this.down : false;
    this.columnOf = i;
    this.heads.forEach(th => th.removeAttribute("aria-sort"));
    this.heads[i].setAttribute("aria-sort", this.down ? "descending" : "ascending");
    const form = this.forms[i];
    const numeric = form && !WORDS.includes(form);
    const sign = this.down ? -1 : 1;
    this.rows.sort((a, b) => {
      const [x, y] = [a.cells[i], b.cells[i]];
      const [emptyX, emptyY] = [x === "–" || x === "", y === "–" || y === ""];
      if (emptyX || emptyY) return emptyX - emptyY || a.at - b.at; // what is missing goes last
      const order = numeric ? number(x) - number(y) : x < y ? -1 : x > y ? 1 : 0;
      return sign * (order || 0) || a.at - b.at;
    });
    this.page = 0;
    this.show();
  }
  turn(text) {
    if (text === "All") { this.size = MOST_AT_ONCE; this.page = 0; }
    else this.page += text === "Next" ? 1 : -1;
    this.show();
  }
  make(row) {
    const tr = document.createElement("tr");
    this.heads.forEach((th, i) => {
      fill(tr.insertCell(), row.cells[i], this.forms[i], th.textContent.trim());
    });
    Object.assign(tr.dataset, row.keys);
    return tr;
  }
  dress(row) {
    if (row.dressed) return;
    row.dressed = true;
    const at = this.forms.indexOf("rating");
    if (at >= 0 && window.rate && row.keys.what !== "transition") window.rate(row.tr.cells[at], row.keys);
    if (!row.keys.recording || !document.querySelector("svg.plot")) return;
    const first = [...row.tr.cells].find(td => td.textContent.trim() === row.keys.recording);
    if (first && !first.querySelector("a, button")) {
      const text = first.textContent;
      first.textContent = "";
      const button = place("button", text, first, { type: "button", class: "choose", title: "Mark in the plots" });
      button.addEventListener("click", () => choose("recording", row.keys.recording));
    }
  }
  show() {
    const kept = this.rows.filter(row => {
      const text = row.cells.join(" ").toLowerCase();
      return this.words.every(word => text.includes(word));
    });
    const pages = Math.max(1, Math.ceil(kept.length / this.size));
    this.page = Math.min(Math.max(this.page, 0), pages - 1);
    const part = kept.slice(this.page * this.size, (this.page + 1) * this.size);
    this.body.replaceChildren(...part.map(row => {
      row.tr = row.tr || this.make(row);
      this.dress(row);
      return row.tr;
    }));
    const first = this.page * this.size;
    this.told.textContent = kept.length > part.length || this.words.length
      ? `${kept.length ? first + 1 : 0} to ${first + part.length} of ${kept.length} rows` : "";
    this.buttons.forEach((button, i) => {
      button.hidden = pages < 2 || (i === 2 && this.size >= MOST_AT_ONCE);
      button.disabled = i === 0 ? this.page === 0 : i === 1 ? this.page === pages - 1 : false;
    });
    mark();
  }
}

function choose(key, value) {
  const again = chosen.key === key && chosen.value === value;
  Object.assign(chosen, again ? { key: "", value: "" } : { key, value });
  mark();
}
function mark() {
  const on = Boolean(chosen.key);
  for (const plot of document.querySelectorAll("svg.plot")) {
    let any = false;
    for (const point of plot.querySelectorAll("[data-recording]")) {
      const here = on && point.dataset[chosen.key] === chosen.value;
      point.classList.toggle("on", here);
      any = any || here;
    }
    plot.classList.toggle("some", any);
  }
  for (const table of tables) {
    for (const tr of table.body.rows) {
      tr.classList.toggle("on", on && tr.dataset[chosen.key] === chosen.value);
    }
  }
  for (const told of document.querySelectorAll(".marked")) {
    told.textContent = on ? `Marked: ${chosen.key} ${chosen.value} (Esc: none)` : "";
  }
}

for (const box of document.querySelectorAll(".scroll[data-most]")) tables.push(new Table(box));
for (const point of document.querySelectorAll("svg.plot [data-recording]")) {
  point.addEventListener("click", () => {
    const { recording, open } = point.dataset;
    const told = point.closest(".exhibit").querySelector(".marked");
    if (!open || !told) return choose("recording", recording);
    // Another point of the same recording is another place to open, and takes no mark away.
    if (chosen.key !== "recording" || chosen.value !== recording) choose("recording", recording);
    else mark();
    told.append(" ");
    link(told, open, "Open " + point.querySelector("title").textContent);
  });
  point.addEventListener("dblclick", () => {
    if (point.dataset.open) location.href = point.dataset.open;
  });
}
// What is folded: opened where an address leads, all at once, and on paper.
const folds = [...document.querySelectorAll("main details.fold")];
const unfold = () => {
  let there = null;
  try { there = document.getElementById(decodeURIComponent(location.hash.slice(1))); } catch { /* not an address of ours */ }
  const fold = there && there.classList.contains("exhibit") ? there.querySelector("details.fold") : null;
  if (!fold || fold.open) return;
  fold.open = true;
  there.scrollIntoView();
};
for (const section of document.querySelectorAll("main section")) {
  const own = folds.filter(fold => section.contains(fold));
  if (own.length < 3) continue;
  const bar = place("p", null, null, { class: "bar" });
  const name = section.querySelector("h2").textContent.trim();
  for (const [text, open] of [["Open all", true], ["Close all", false]]) {
    const button = place("button", text, bar, { type: "button", "aria-label": `${text} of ${name}` });
    button.addEventListener("click", () => { for (const fold of own) fold.open = open; });
  }
  own[0].closest(".exhibit").before(bar);
}
addEventListener("hashchange", unfold);
document.addEventListener("click", event => { // the same address once more changes no hash
  const to = event.target.closest && event.target.closest("a[href^='#']");
  if (to && to.getAttribute("href") === location.hash) unfold();
});
unfold();
let closed = [];
addEventListener("beforeprint", () => {
  closed = [...document.querySelectorAll("main details:not([open])")];
  for (const folded of closed) folded.open = true;
  for (const image of document.images) image.loading = "eager";
});
addEventListener("afterprint", () => { for (const folded of closed) folded.open = false; });
document.addEventListener("keydown", event => { if (event.key === "Escape") choose("", ""); });
if (matchMedia("(max-width: 900px)").matches) {
  document.querySelector("nav .contents").open = false;
}
document.documentElement.classList.add("ready");
})();
