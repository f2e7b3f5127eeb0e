// Domain: what stands and what falls over frequency and amplitude, cell by cell as it is computed.

import { get, post } from "./api.js";
import { el, field, fill, find, labels, later, length, mark, notice, number, warnings } from "./dom.js";
import { tell } from "./news.js";
import { CYCLE, INK, SAND, said, sharp, ticks } from "./plot.js";
import * as run from "./run.js";
import { called, change, listen, state } from "./state.js";
import { numeral, range } from "./typed.js";

const LOOKS = { stands: SAND, collapsed: "#a6372f", undecided: "#c0c0c0", failed: "#ffffff" };
let panel, job = null, cells = new Map(), here = null, place = null;

export function start(where) {
  panel = where;
  listen(keys => {
    if (keys.has("domainJob")) show();
    if (keys.has("domain")) count();
    if (keys.has("tab") && state.tab === "domain") paint();
    if (keys.has("column") || keys.has("assembly") || keys.has("model")) about();
  });
  addEventListener("resize", later(paint, 60));
  render(); show();
}

function set(key, value) { change({ domain: { ...state.domain, [key]: value.trim() } }); }
const box = (key, label, path = key) => field(label, el("input", { value: state.domain[key], inputmode: "decimal", "data-field": path, oninput: event => set(key, event.target.value) }));

function render() {
  const canvas = el("canvas", { role: "application", tabindex: 0, "aria-label": "Map of verdicts: arrows move from cell to cell, Enter opens the film of a cell" });
  fill(panel, el("h1", {}, "Domain"), el("p", { class: "lead" }, "Which sines the column stands, and which bring it down. Cells appear as they are computed; each opens its film."),
    el("div", { class: "sheet left" },
      el("div", {}, el("div", { class: "card", id: "domain-asked", "data-errors": true }, el("p", { class: "hint", id: "domain-case" }),
        el("div", { class: "row tight" }, box("f0", "Hz, from", "frequencies"), box("f1", "to", "frequencies.last"), box("fn", "values", "frequencies.number")),
        el("div", { class: "row tight" }, box("a0", "g, from", "amplitudes"), box("a1", "to", "amplitudes.last"), box("an", "values", "amplitudes.number")),
        el("div", { class: "row" }, box("duration", `${labels.duration} [s]`), field(`${labels.tail} [s]`, el("input", { value: state.tail, placeholder: "0", inputmode: "decimal", "data-field": "tail", oninput: event => change({ tail: event.target.value.trim() }) }))),
        el("div", { class: "row" }, el("button", { type: "button", class: "primary", onclick: go }, "Map it"), el("small", { class: "hint", id: "domain-count" }))),
      el("div", { class: "card", id: "domain-said", "aria-live": "polite", hidden: true })),
      el("div", { class: "card" }, el("div", { class: "map" }, canvas), el("p", { class: "hint", id: "domain-cell", role: "status" }, "Point at a cell."), el("ul", { class: "legend" },
        Object.entries(LOOKS).map(([name, colour]) => { const patch = el("i"); patch.style.background = colour; return el("li", {}, patch, name); })))));
  canvas.onpointermove = event => { point(at(event)); };
  canvas.onpointerleave = () => point(null);
  canvas.onclick = event => { const cell = at(event); if (cell) open(cell); };
  canvas.onkeydown = event => {
    if (!place) return;
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (step) {
      event.preventDefault();
      const [i, j] = here || [0, 0];
      point([Math.min(Math.max(i + step[0], 0), place.f.length - 1), Math.min(Math.max(j + step[1], 0), place.a.length - 1)]);
    } else if (event.key === "Enter" && here) { event.preventDefault(); open(here); }
  };
  about(); count();
}
function about() { find("#domain-case", panel).textContent = state.assembly ? "An assembly stands, and domains are of columns: go back to one." : `${called()} · ${state.model}`; }
function count() {
  const n = Number(state.domain.fn) * Number(state.domain.an);
  find("#domain-count", panel).textContent = n > 0 ? `${n} runs` : "";
}

async function go() {
  const d = state.domain;
  const asked = find("#domain-asked", panel);
  try {
    mark(asked, null);
    const [f0, f1, fn] = range([d.f0, d.f1, d.fn], "frequencies", ["Hz, from", "to", "values"], { unit: "Hz", such: "0.33", number: "12" });
    const [a0, a1, an] = range([d.a0, d.a1, d.an], "amplitudes", ["g, from", "to", "values"], { unit: "g", such: "0.3", number: "16" });
    const duration = numeral(d.duration, "duration", labels.duration, { unit: "s", such: "10" });
    const made = await post("/api/jobs", { kind: "domain", ...run.common(), frequencies: `${f0}:${f1}:${fn}`, amplitudes: `${a0}g:${a1}g:${an}`, duration: `${duration}s`, page: { domain: d } });
    change({ domainJob: made.id });
  } catch (error) { mark(asked, error); }
}

async function show() {
  cells = new Map(); here = null; job = null; place = null;
  if (!state.domainJob) { find("#domain-said", panel).hidden = true; paint(); return; }
  try {
    const id = state.domainJob, found = await get(`/api/jobs/${id}`);
    if (id !== state.domainJob) return;
    hear(found);
    if (!found.asked) return;
    job = found;
    const axis = text => { const [low, high, n] = text.split(":").map(one => parseFloat(one)); return n > 1 ? Array.from({ length: n }, (_, k) => low + (high - low) * k / (n - 1)) : [low]; };
    place = { f: axis(found.asked.frequencies), a: axis(found.asked.amplitudes) };
    add(found.id, (await get(`/api/jobs/${id}/cells`)).cells);
  } catch (error) { notice(error.error); change({ domainJob: "" }); }
}

export function hear(news) {
  if (news.id !== state.domainJob) return;
  const where = find("#domain-said", panel);
  where.hidden = false;
  tell(where, news, () => [el("p", { class: "hint" }, news.title), news.state === "done" && el("p", { class: "verdict" }, tally()), warnings(news.warnings), news.state === "done" && run.files(news)].flat());
}
function tally() {
  const found = {};
  for (const [verdict] of cells.values()) found[verdict] = (found[verdict] || 0) + 1;
  return `${found.collapsed || 0} of ${cells.size} cells collapse, ${found.stands || 0} stand${found.undecided ? `, ${found.undecided} are undecided` : ""}${found.failed ? `, ${found.failed} failed` : ""}.`;
}

let waiting = 0;
export function add(id, list) {
  if (id !== state.domainJob) return;
  for (const [k, verdict, peak] of list) cells.set(k, [verdict, peak]);
  if (!waiting) waiting = requestAnimationFrame(() => { waiting = 0; paint(); });
  const head = find("#domain-said .verdict", panel);
  if (job && head && !head.classList.contains("sentence")) head.textContent = tally();
}

// Edges of the cells, and from there to the canvas.
function frame(width, height) {
  const edges = list => list.length < 2 ? [list[0] * 0.9, list[0] * 1.1] : [list[0] - (list[1] - list[0]) / 2, ...list.slice(1).map((one, k) => (one + list[k]) / 2), list[list.length - 1] + (list[list.length - 1] - list[list.length - 2]) / 2];
  const [fx, ay] = [edges(place.f), edges(place.a)], [l, r, t, b] = [54, width - 12, 10, height - 44];
  const across = f => l + (f - fx[0]) / (fx[fx.length - 1] - fx[0]) * (r - l), up = a => b - (a - ay[0]) / (ay[ay.length - 1] - ay[0]) * (b - t);
  return { fx, ay, l, r, t, b, across, up };
}

function paint() {
  const canvas = find(".map canvas", panel);
  if (!canvas || !canvas.clientWidth) return;
  const [c, width, height] = sharp(canvas);
  if (!place) { c.fillStyle = "#565149"; c.textAlign = "center"; c.fillText("The map appears here, cell by cell.", width / 2, height / 2); return; }
  const { fx, ay, l, r, t, b, across, up } = frame(width, height), rows = place.a.length;
  c.fillStyle = "#fbfaf7"; c.fillRect(l, t, r - l, b - t);
  for (const [k, [verdict]] of cells) {
    const i = Math.floor(k / rows), j = k % rows, x = across(fx[i]), y = up(ay[j + 1]);
    c.fillStyle = LOOKS[verdict] || "#fff"; c.fillRect(x, y, across(fx[i + 1]) - x + 0.4, up(ay[j]) - y + 0.4);
    if (verdict === "undecided" || verdict === "failed") { c.strokeStyle = "#404040"; c.lineWidth = 1; c.beginPath(); c.moveTo(x, up(ay[j])); c.lineTo(across(fx[i + 1]), y); if (verdict === "failed") { c.moveTo(x, y); c.lineTo(across(fx[i + 1]), up(ay[j])); } c.stroke(); }
  }
  boundary(c, fx, ay, across, up, rows);
  c.strokeStyle = c.fillStyle = INK; c.lineWidth = 0.8; c.strokeRect(l, t, r - l, b - t);
  c.textBaseline = "top"; c.textAlign = "center";
  for (const one of ticks(fx[0], fx[fx.length - 1], (r - l) / 90)) { c.beginPath(); c.moveTo(across(one), b); c.lineTo(across(one), b + 4); c.stroke(); c.fillText(said(one), across(one), b + 7); }
  c.fillText("frequency [Hz]", (l + r) / 2, b + 25);
  c.textBaseline = "middle"; c.textAlign = "right";
  for (const one of ticks(ay[0], ay[ay.length - 1], (b - t) / 46)) { c.beginPath(); c.moveTo(l, up(one)); c.lineTo(l - 4, up(one)); c.stroke(); c.fillText(said(one), l - 8, up(one)); }
  c.save(); c.translate(12, (t + b) / 2); c.rotate(-Math.PI / 2); c.textAlign = "center"; c.fillText("amplitude [g]", 0, 0); c.restore();
  if (here) { const [i, j] = here; c.strokeStyle = CYCLE[2][0]; c.lineWidth = 2.5; c.strokeRect(across(fx[i]), up(ay[j + 1]), across(fx[i + 1]) - across(fx[i]), up(ay[j]) - up(ay[j + 1])); }
}
// The smallest amplitude that brings the column down, at each frequency that is known so far.
function boundary(c, fx, ay, across, up, rows) {
  c.strokeStyle = INK; c.lineWidth = 1.4;
  let last = null;
  place.f.forEach((_, i) => {
    let first = -1;
    for (let j = 0; j < rows && first < 0; j++) { const one = cells.get(i * rows + j); if (!one) break; if (one[0] === "collapsed") first = j; }
    if (first < 0) { last = null; return; }
    const y = up(ay[first]);
    c.beginPath();
    if (last !== null) { c.moveTo(across(fx[i]), last); c.lineTo(across(fx[i]), y); } else c.moveTo(across(fx[i]), y);
    c.lineTo(across(fx[i + 1]), y); c.stroke();
    last = y;
  });
}

function at(event) {
  if (!place) return null;
  const canvas = find(".map canvas", panel), { fx, ay, across, up } = frame(canvas.clientWidth, canvas.clientHeight);
  const i = place.f.findIndex((_, k) => event.offsetX >= across(fx[k]) && event.offsetX < across(fx[k + 1]));
  const j = place.a.findIndex((_, k) => event.offsetY <= up(ay[k]) && event.offsetY > up(ay[k + 1]));
  return i < 0 || j < 0 ? null : [i, j];
}
function point(cell) {
  if (String(cell) === String(here)) return;
  here = cell;
  paint();
  const text = find("#domain-cell", panel);
  if (!cell) { text.textContent = "Point at a cell."; return; }
  const [i, j] = cell, known = cells.get(i * place.a.length + j);
  text.textContent = `${number(place.f[i])} Hz, ${number(place.a[j])} g: ${known ? `${known[0]}, peak top displacement ${length(known[1])}` : "not computed yet"}. Click or Enter: its film.`;
}
function open([i, j]) {
  const f = String(+place.f[i].toPrecision(12)), a = String(+place.a[j].toPrecision(12)), from = job.asked;
  run.go(() => ({ column: from.column, assembly: from.assembly, tail: from.tail, model: from.model, settings: from.settings || {}, motion: { kind: "harmonic", text: `${f}Hz,${a}g,${from.duration}` },
    page: { motion: { ...state.motion, kind: "harmonic", frequency: f, amplitude: a, duration: String(parseFloat(from.duration)), both: false, azimuth: "", pga: "" } } }));
}
