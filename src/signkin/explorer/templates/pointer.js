// What a pointer does to the plots: it shows values, drags the window, zooms, sets the time.
const DRAGGED = 4; // px, from which a press is a drag

const timeAt = (plot, event) => {
  const box = plot.over.getBoundingClientRect();
  return state.from + ((event.clientX - box.left) / box.width) * (state.to - state.from);
};

function pointed(plot) {
  const held = new Map();
  let start = null;
  const over = plot.over;
  over.style.touchAction = "pan-y";
  over.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    held.set(event.pointerId, event.clientX);
    over.setPointerCapture(event.pointerId);
    start = { x: event.clientX, from: state.from, to: state.to, moved: false, gap: spread(held) };
  });
  over.addEventListener("pointermove", (event) => {
    state.hover = timeAt(plot, event);
    changed("hover");
    if (!start || !held.has(event.pointerId)) return;
    held.set(event.pointerId, event.clientX);
    const width = over.clientWidth;
    if (held.size === 2 && start.gap) {
      start.moved = true;
      const wide = ((start.to - start.from) * start.gap) / Math.max(8, spread(held));
      const middle = (start.from + start.to) / 2;
      setView(middle - wide / 2, middle + wide / 2);
    } else if (start.moved || Math.abs(event.clientX - start.x) > DRAGGED) {
      start.moved = true;
      const by = ((start.x - event.clientX) / width) * (start.to - start.from);
      setView(start.from + by, start.to + by);
    }
  });
  const release = (event) => {
    if (!held.delete(event.pointerId) || !start) return;
    if (!start.moved && event.type === "pointerup") {
      play(false);
      setTime(timeAt(plot, event));
      told.stopped?.();
    }
    if (!held.size) start = null;
  };
  over.addEventListener("pointerup", release);
  over.addEventListener("pointercancel", release);
  over.addEventListener("pointerleave", () => { state.hover = null; changed("hover"); });
  over.addEventListener("dblclick", () => setView(0, LAST));
  over.addEventListener("wheel", (event) => {
    event.preventDefault();
    const along = Math.abs(event.deltaX) > Math.abs(event.deltaY);
    if (along || event.shiftKey) pan(((along ? event.deltaX : event.deltaY) / 600) * (state.to - state.from));
    else zoom(Math.exp(event.deltaY / 400), timeAt(plot, event));
  }, { passive: false });
}

function spread(held) {
  const places = [...held.values()];
  return places.length === 2 ? Math.abs(places[0] - places[1]) : 0;
}
