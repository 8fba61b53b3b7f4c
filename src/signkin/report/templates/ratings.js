"use strict";
// What the owner thinks of recordings and tags: kept by the browser, saved as CSV.
(() => {
const bar = document.querySelector(".ratings");
const corpus = bar.dataset.corpus;
const store = "signkin-ratings-" + corpus;
const columns = ["corpus", "recording", "start_s", "end_s", "gloss", "rating", "note"];
const words = ["ok", "check", "exclude"];
let kept = {};
try { kept = JSON.parse(localStorage.getItem(store) || "{}"); } catch { kept = {}; }
const shown = [];

const nameOf = keys => JSON.stringify([keys.recording, keys.start || "", keys.end || "", keys.gloss || ""]);
const told = () => {
  const many = Object.keys(kept).length;
  bar.querySelector(".many").textContent = many === 1 ? "1 rating" : `${many} ratings`;
  bar.querySelector(".save").disabled = !many;
};
const keep = (name, rating, note, had) => {
  // One that a run has read already is taken back by an empty one.
  if (rating || note || had) kept[name] = { rating, note }; else delete kept[name];
  try { localStorage.setItem(store, JSON.stringify(kept)); } catch { /* only this page's, then */ }
  for (const one of shown) {
    if (one.name === name) { one.select.value = rating; one.input.value = note; }
  }
  told();
};
window.rate = (td, keys) => {
  const name = nameOf(keys);
  const what = keys.gloss ? `tag ${keys.gloss} of ${keys.recording}` : `recording ${keys.recording}`;
  const select = document.createElement("select");
  select.setAttribute("aria-label", "Rating of " + what);
  for (const word of ["", ...words]) {
    const option = document.createElement("option");
    option.value = word;
    option.textContent = word || "–";
    select.append(option);
  }
  const input = document.createElement("input");
  input.setAttribute("aria-label", "Note on " + what);
  input.placeholder = "note";
  td.textContent = "";
  td.className = "rating";
  td.append(select, input);
  const one = { name, select, input };
  shown.push(one);
  const had = Boolean(keys.rated || keys.noted);
  const now = kept[name] || { rating: keys.rated || "", note: keys.noted || "" };
  select.value = now.rating;
  input.value = now.note;
  const changed = () => keep(name, select.value, input.value.trim(), had);
  select.addEventListener("change", changed);
  input.addEventListener("change", changed);
};
const quoted = text => /[",\n\r]/.test(text) ? '"' + text.replaceAll('"', '""') + '"' : text;
bar.querySelector(".save").addEventListener("click", () => {
  const lines = [columns.join(",")];
  for (const name of Object.keys(kept).sort()) {
    const [recording, start, end, gloss] = JSON.parse(name);
    lines.push([corpus, recording, start, end, gloss, kept[name].rating, kept[name].note].map(quoted).join(","));
  }
  const a = document.createElement("a");
  a.href = URL.createObjectURL(new Blob([lines.join("\n") + "\n"], { type: "text/csv" }));
  a.download = `ratings-${corpus}.csv`;
  a.click();
  setTimeout(() => URL.revokeObjectURL(a.href), 1000);
});
bar.querySelector(".forget").addEventListener("click", () => {
  for (const name of Object.keys(kept)) keep(name, "", "");
});
bar.hidden = false;
told();
})();
