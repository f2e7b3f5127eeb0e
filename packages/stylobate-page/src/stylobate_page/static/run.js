// Run: model and certainty; the verdict; the column as it moves, with its histories in step.

import { get, post } from "./api.js";
import * as curves from "./curves.js";
import { choice, el, facts, field, fill, find, labels, later, length, mark, notice, number, redraw, select, warnings } from "./dom.js";
import * as motion from "./motion.js";
import { isOpen, tell } from "./news.js";
import { BLUE, CYCLE, INK, moving, plot } from "./plot.js";
import * as records from "./records.js";
import { called, change, declared, listen, state } from "./state.js";
import { numeral } from "./typed.js";

export const MODELS = [
  ["dem2d", "dem2d", "Distinct elements in the plane: rigid drums that rock, slide and fall."],
  ["dem3d", "dem3d", "Distinct elements in space: drums that wobble, twist and roll as well; both horizontal components."],
  ["rigid-block", "rigid-block", "Rigid blocks with interfaces, in the plane."],
  ["rigid-beam", "rigid-beam", "The founding paper's beam: one rigid body whose base follows a law of moment and rotation."],
  ["housner", "housner", "Housner's rocking block: the column as one rigid body."],
];

let panel, player = null, plots = [], loaded = "", followed = null, data = null, round = null;

export function start(place, fromAllDirections) {
  panel = place; round = fromAllDirections;
  listen(keys => {
    if (["model", "replicates", "tail", "motion", "column", "settings", "assembly"].some(key => keys.has(key))) renderAsked();
    if (keys.has("job")) show();
    if (keys.has("tab")) { if (state.tab === "run") paint(); else stop(); }
  });
  addEventListener("resize", later(() => plots.forEach(one => one.redraw()), 60));
  fill(panel, el("h1", {}, "Run"), el("p", { class: "lead", id: "run-case" }),
    el("div", { class: "sheet left" }, el("div", {}, el("div", { class: "card", id: "run-asked", "data-errors": true }), el("div", { class: "card", id: "run-said", "aria-live": "polite", hidden: true })),
      el("div", { id: "run-film" })));
  renderAsked(); show();
}
function stop() { if (player && find("#play", panel) && find("#play", panel).textContent === "Pause") player.toggle(); }

function renderAsked() {
  const about = MODELS.find(one => one[0] === state.model), twins = !state.assembly || state.model === "dem3d";
  const drums = ((state.column || {}).drum || []).length;
  find("#run-case", panel).textContent = `${called()}${state.assembly ? "" : `, ${drums === 1 ? "1 drum" : `${drums} drums`}`} · ${motion.words()}`;
  const place = find("#run-asked", panel);
  redraw(place,
    field(labels.model, select(MODELS.filter(([key]) => !state.assembly || key === state.model).map(([key, text]) => [key, text]), state.model, model => change({ model, settings: {} }), { "data-field": "model" })),
    el("p", { class: "hint" }, about ? about[2] : ""),
    state.model === "dem3d" && !state.assembly && choice("law", "Contact in space", [["rim", "rim"], ["bed", "bed"]], state.settings.law || "rim", law => change({ settings: { ...state.settings, law } })),
    el("div", { class: "row" },
      twins && field(labels.replicates, el("input", { value: state.replicates, placeholder: "15", inputmode: "numeric", "data-field": "replicates", oninput: event => change({ replicates: event.target.value.trim() }) })),
      field(`${labels.tail} [s]`, el("input", { value: state.tail, placeholder: "0", inputmode: "decimal", "data-field": "tail", oninput: event => change({ tail: event.target.value.trim() }) }))),
    twins && el("p", { class: "hint" }, `How sure the verdict is: ${state.assembly ? "assemblies" : "columns"} that differ by what nobody has measured.`),
    el("div", { class: "row" }, el("button", { type: "button", class: "primary", id: "go", onclick: () => go() }, "Run"), el("small", { class: "hint" }, "Ctrl + Enter")),
    critical(),
    el("div", { class: "row" }, el("button", { type: "button", onclick: () => round() }, "From all directions"), el("small", { class: "hint" }, "twelve, in space: which does most harm")));
}

// The smallest amplitude of this motion that brings the column down.
function critical() {
  const box = (key, label) => field(label, el("input", { value: state.critical[key], inputmode: "decimal", "data-field": { first: "start", last: "stop" }[key] || key,
    oninput: event => change({ critical: { ...state.critical, [key]: event.target.value.trim() } }) }));
  return el("details", { id: "critical", open: criticalOpen }, el("summary", { onclick: () => { criticalOpen = !find("#critical", panel).open; } }, "What amplitude brings it down?"),
    el("div", { class: "row tight" }, box("first", `${labels.from} [g]`), box("last", `${labels.to} [g]`), box("step", `${labels.step} [g]`)),
    el("div", { class: "row" }, el("button", { type: "button", onclick: goCritical }, "Find it"), el("small", { class: "hint" }, "the motion above, made larger step by step")));
}
let criticalOpen = false;

function goCritical() {
  const typed = (key, field, label) => `${numeral(state.critical[key], field, label, { unit: "g", such: "0.05" })}g`;
  go(() => {
    const { pga, ...asked } = motion.asked();
    if (["harmonic", "pulse"].includes(asked.kind)) asked.text = asked.text.replace(/,[^,]*g(,|$)/, ",?g$1");
    if (asked.across) asked.across = asked.across.replace(/,[^,]*g(,|$)/, ",?g$1");
    return { kind: "critical", motion: asked, first: typed("first", "start", labels.from), last: typed("last", "stop", labels.to), step: typed("step", "step", labels.step) };
  });
}

// What every job of what stands has. Thrown is what is wrong in a field.
export const common = () => ({
  ...(state.assembly ? { assembly: state.assembly } : { column: state.column }), model: state.model, settings: state.settings,
  ...(state.tail ? { tail: `${numeral(state.tail, "tail", labels.tail, { unit: "s", such: "5" })}s` } : {}),
});

// A run, or what "asked" makes of it.
export async function go(asked = () => ({ motion: motion.asked() })) {
  try {
    mark(find("#run-asked", panel), null);
    const given = asked();
    const job = await post("/api/jobs", { kind: "run", ...common(), page: { motion: state.motion, replicates: state.replicates, tail: state.tail }, ...(state.replicates ? { replicates: state.replicates } : {}), ...given });
    change({ tab: "run", job: job.id }, { record: true });
  } catch (error) {
    if (state.tab === "run") mark(find("#run-asked", panel), error); else notice(error.error);
  }
}

// The job of the address: what is known of it now.
async function show() {
  if (!state.job) { fill(find("#run-film", panel), el("div", { class: "card empty" }, "Run it to see how it moves.")); find("#run-said", panel).hidden = true; loaded = ""; return; }
  try { hear(await get(`/api/jobs/${state.job}`)); }
  catch (error) { notice(error.error); change({ job: "" }); }
}

// News of a job: only those of the one that is shown matter here.
export async function hear(job) {
  if (job.id !== state.job) return;
  if (job.state === "done" && !job.results) job = await get(`/api/jobs/${job.id}`).catch(() => job);
  if (job.id !== state.job) return;
  followed = job;
  said(job);
  if (["running", "done"].includes(job.state) && job.film && loaded !== job.id) {  // the film is there before all files are
    loaded = job.id; data = null;
    const found = await get(`/api/jobs/${job.id}/film`).catch(error => { notice(error.error); return null; });
    if (found && state.job === job.id) { data = found; film(found); said(followed); }
  } else if (job.state === "done" && job.kind === "critical") {
    loaded = "";
    foundCritical(job);
  } else if (job.state !== "done" && loaded !== job.id) { loaded = ""; fill(find("#run-film", panel), waiting(job)); }
}

function foundCritical(job) {
  const r = (job.results || [])[0], { asked } = job;
  if (!r || !asked) return;
  const place = find("#run-said", panel), none = r.critical_g === null, [verdict, ...rest] = r.sentence.split(/(?<=\.) /);
  const peak = Number.isFinite(r.critical_g) && asked.motion && ["harmonic", "pulse"].includes(asked.motion.kind);
  const near = peak ? { ...asked.motion, text: asked.motion.text.replace("?g", `${r.critical_g}g`), ...(asked.motion.across ? { across: asked.motion.across.replace("?g", `${r.critical_g}g`) } : {}) } : { ...asked.motion, pga: `${r.critical_g}g` };
  place.dataset.key = "";
  tell(place, job, () => [
    el("p", { class: `verdict ${r.lowest_collapse_g !== null ? "collapsed" : r.open_below ? "undecided" : "stands"}` }, verdict, ...rest.map(one => el("small", {}, one))),
    facts([["runs", r.runs], ["amplitudes", `${asked.first} to ${asked.last}`], ["steps of", asked.step], ["undecided", r.undecided || ""], ["failed", r.failed || ""]]),
    warnings((job.warnings || []).map(records.named)),
    !none && el("div", { class: "row" }, el("button", { type: "button", onclick: () => go(() => ({ column: asked.column, assembly: asked.assembly, tail: asked.tail, model: asked.model, settings: asked.settings || {}, motion: near })) }, "Run it at this amplitude")),
    files(job),
  ].flat());
  curves.show(find("#run-film", panel), job.id).catch(error => notice(error.error || String(error)));
}

function waiting(job) {
  const text = { waiting: "It waits for its turn.", running: "It is computed. The first run of a model after an update takes up to a minute more, for its code to be compiled.", cancelled: "It was cancelled.", refused: "It was not computed.", failed: "It was not computed to its end." }[job.state] || "";
  return el("div", { class: "card empty" }, text);
}

function said(job) {
  const place = find("#run-said", panel), result = job.state === "done" && ["run", "sequence"].includes(job.kind) && job.results && job.results[0];
  place.hidden = false;
  if (result) place.dataset.key = "";
  tell(place, job, () => [
    el("p", { class: "hint" }, job.title),
    result && verdict(result, data && loaded === job.id ? data.sentence : ""),
    result && job.kind === "run" && !result.decided && result.outcome !== "failed" && el("div", { class: "row" },
      el("button", { type: "button", onclick: () => { change({ tail: String((Number(state.tail) || 0) + 5) }); go(); } }, "Go on for 5 s more")),
    result && measures(result), result && result.collapse_time_s !== null && result.peak_top_displacement_m !== undefined && el("p", { class: "hint" }, "Peaks are those before the fall; the film shows the fall as well, in which the top goes farther."), warnings((job.warnings || []).map(records.named)), job.state === "done" && files(job),
  ].flat());
}

function verdict(r, words) {
  const sure = r.certainty, beside = sure && sure.beside;
  const look = r.outcome === "failed" ? "failed" : !r.decided ? "undecided" : r.collapsed ? "collapsed" : beside ? "doubted" : "stands";
  const parts = sure ? [["fell", sure.collapsed], ["", sure.stands], ["open", sure.undecided]] : [];
  const total = parts.reduce((sum, one) => sum + one[1], 0);
  const bar = total > 0 && el("div", { class: "chance", role: "img", "aria-label": sure.sentence }, parts.map(([name, count]) => {
    const piece = el("i", { class: name }); piece.style.width = `${100 * count / total}%`; return piece;
  }));
  return [el("p", { class: `verdict ${look}` }, words || r.outcome.replace("_", " "), sure && el("small", {}, sure.sentence)), bar, beside && el("p", { class: "warning" }, beside),
    r.doubt && el("p", { class: "warning" }, r.doubt),
    r.under_other_laws && el("p", {}, `Under other laws: ${r.under_other_laws}.`)];
}

function measures(r) {
  const fell = r.collapse_time_s !== null, shown = (value, unit) => unit === "m" ? length(value) : `${number(value)} ${unit}`;
  return facts([
    fell && ["collapse certain at", `${number(r.collapse_time_s)} s`], (r.fallen || []).length > 0 && ["fallen", r.fallen.join(", ")],
    ...declared.filter(({ key }) => Number.isFinite(r[key])).map(({ key, label, unit }) => [fell && key.startsWith("peak_top") ? `${label} before the fall` : label, shown(r[key], unit)]),
    ["energy imbalance", number(r.energy_imbalance, 2)], ["computed in", `${number(r.wall_s)} s, ${r.steps} steps`],
  ]);
}

export function files(job) {
  const link = name => el("li", {}, el("a", { href: `/api/jobs/${job.id}/files/${name.split("/").map(encodeURIComponent).join("/")}`, download: name.split("/").pop() }, name));
  return [report(job), el("details", {}, el("summary", {}, "Files"),
    (job.files || []).length > 0 && el("p", {}, el("a", { class: "button", href: `/api/jobs/${job.id}/zip`, download: `stylobate-${job.kind}-${job.id}.zip` }, "Save all in one ZIP file"), " ",
      el("a", { class: "button", href: `/api/jobs/${job.id}/commands.txt`, download: "commands.txt" }, "Save what repeats it without the page")),
    el("ul", {}, (job.files || []).map(link)))];
}

// A button that has the report made, and becomes a link to it.
function report(job) {
  const made = job.kind === "report" ? job : null, link = one => el("a", { class: "button", href: `/api/jobs/${one.id}/files/report.html`, target: "_blank", rel: "noopener" }, "Open the report");
  const place = el("div", { class: "row" });
  if (made) return fill(place, link(made));
  if (!(job.files || []).some(name => name.startsWith("result/"))) return null;
  const wait = asked => {
    fill(place, el("small", { class: "hint" }, "The report is made …"));
    const hear = event => {
      const news = event.detail;
      if (news.id !== asked.id || isOpen(news)) return;
      document.removeEventListener("news", hear);
      fill(place, news.state === "done" ? link(news) : el("p", { class: "error" }, news.sentence));
    };
    document.addEventListener("news", hear);
  };
  return fill(place, el("button", { type: "button", onclick: async () => { try { wait(await post(`/api/jobs/${job.id}/report`)); } catch (error) { notice(error.error); } } }, "Report"));
}

function film({ film: shown, histories: h }) {
  const canvas = (id, label, kind) => el("canvas", { id, class: kind, role: "img", "aria-label": label });
  const speeds = [["0.1", "× 0.1"], ["0.25", "× ¼"], ["0.5", "× ½"], ["1", "true speed"], ["2", "× 2"]], factors = [1, 2, 5, 10, 20, 50, 100];
  const parts = {
    film: canvas("film", "The column as it moves", ""), trace: canvas("trace", "Acceleration of the ground", ""), play: el("button", { type: "button", id: "play" }, "Play"),
    place: el("input", { id: "place", type: "range", min: 0, max: 0, value: 0, "aria-label": "time" }), now: el("output", { id: "now" }),
    speed: select(speeds, "1", () => {}, { "aria-label": "speed" }), larger: select(factors.map(one => [String(one), `displacements × ${one}`]), "1", () => {}, { "aria-label": "displacements" }),
  };
  const top = canvas("top", "Top displacement over time", "plot low"), opening = canvas("opening", "Opening of the joints over time", "plot low"), energy = canvas("energy", "Energy over time", "plot");
  fill(find("#run-film", panel),
    el("div", { class: "card" }, parts.film, el("div", { class: "bar" }, parts.play, parts.place, parts.now, parts.speed, parts.larger), parts.trace,
      el("p", { class: "hint" }, `Drag to ${shown.space ? "turn" : "move"}, wheel or two fingers to zoom, double click to return; or arrows, + − and 0; the space bar plays.${shown.space ? " The blue mark is on the same side of every body." : ""}`)),
    el("div", { class: "card" }, h.top && [el("h2", {}, "Top"), top], el("h2", {}, "Joints"), joints(h, opening), el("h2", {}, "Energy"), energy));
  const x = shown.time;
  const widest = h.opening.map((values, i) => [peak(values), i]).sort((a, b) => b[0] - a[0]).slice(0, 4).map(one => one[1]).sort((a, b) => a - b);
  const kind = { name: "opening" };
  const many = (list, each) => list.map((i, k) => ({ x, y: each[i], label: `joint ${i + 1}`, color: CYCLE[k][0], dash: CYCLE[k][1] }));
  plots = [
    h.top && moving(top, () => plot(top, [{ x, y: h.top.x, color: INK, label: h.top.y ? "x" : "" }, ...(h.top.y ? [{ x, y: h.top.y, color: BLUE, dash: [5, 3], label: "y" }] : [])], { xLabel: "time [s]", yLabel: "[mm]", ...limits(h.top, shown) })),
    moving(opening, () => plot(opening, many(widest, h[kind.name]), { xLabel: "time [s]", yLabel: kind.name === "twist" ? "[rad]" : `${kind.name} [mm]` })),
    moving(energy, () => plot(energy, Object.entries(h.energy).filter(([, y]) => peak(y) > 0).slice(0, 6).map(([label, y], k) => ({ x, y, label, color: CYCLE[k][0], dash: CYCLE[k][1] })), { xLabel: "time [s]", yLabel: "[kJ]" })),
  ].filter(Boolean);
  find("#joints", panel).onchange = event => { kind.name = event.target.value; plots.forEach(one => one.redraw()); player.seek(player.time()); };
  for (const one of [top, opening, energy]) one.onclick = event => { const near = plots.find(other => other.canvas === one); if (near) player.seek(near.at(event.offsetX)); };
  parts.painter = (shown.space ? spacePainter : planePainter)(shown, parts.film);
  parts.shown = k => plots.forEach(one => one.cursor(x[k]));
  if (player) player.end();
  plots.forEach(one => one.redraw());
  player = filmPlayer(shown, parts);
  player.seek(beginning(h.top, x));
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches && state.tab === "run") player.toggle();
}
// A second before the column begins to move: records are quiet for long at first.
const beginning = (top, time) => {
  if (!top) return time[0];
  const most = peak(top.x), first = top.x.findIndex(one => one !== null && Math.abs(one) > 0.02 * most);
  return most > 0 ? Math.max(time[0], time[Math.max(first, 0)] - 1) : time[0];
};
const peak = values => values.reduce((most, one) => one !== null && Math.abs(one) > most ? Math.abs(one) : most, 0);
// Debris lies metres away: the axis ends where the column itself does.
const limits = (top, shown) => {
  const tall = 1000 * (shown.view[3] - shown.view[2]), most = Math.max(...Object.values(top).flat().map(one => one === null ? 0 : Math.abs(one)));
  return most > tall ? { low: -tall, high: tall } : {};
};
const joints = (h, canvas) => [el("div", { class: "bar" }, el("select", { id: "joints", "aria-label": "what of the joints" },
  [["opening", "opening"], ["slip", "slip"], ...(h.twist ? [["twist", "twist"]] : [])].map(([key, text]) => el("option", { value: key }, text)))), canvas];

function paint() { curves.redraw(); if (player) { plots.forEach(one => one.redraw()); player.fit(); } }
export const current = () => followed;
