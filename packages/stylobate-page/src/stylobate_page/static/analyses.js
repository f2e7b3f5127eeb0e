// Analyses: a form for each, made from what the page knows of it, and its answer in words, a table and pictures.

import { get, post } from "./api.js";
import { el, facts, field, fill, find, labels, mark, notice, number, opener, redraw, save, select, warnings } from "./dom.js";
import * as jobs from "./jobs.js";
import * as motion from "./motion.js";
import { isOpen, tell } from "./news.js";
import * as records from "./records.js";
import * as run from "./run.js";
import { called, change, listen, state } from "./state.js";
import { numeral } from "./typed.js";

let panel, forms, typing = false;

// A ruin file to begin with: the column of the page, and what may be seen of it.
const ruin = () => `columns = ["${state.assembly ? "assembly.toml" : "column.toml"}"]   # what stands on the page; or presets by name
simulations = 1000
seed = 1

[[observed]]
column = "${state.assembly ? "assembly.toml" : "column.toml"}"
state = "stands"                           # or "fell", "fell before", "unknown"
no_slip_above = 0.02                       # no joint is out of place by more [m]
# offsets = [[1, 0.004, 0.002, 0.003]]     # joint, x, y, standard deviation [m]
# fell_towards = 200                       # from x towards y [degrees], of what fell
# towards_sd = 15                          # and its standard deviation

[prior]
pgv = [0.1, 1.5]                           # m/s
period = [0.3, 1.6]                        # s
`;
const text = () => state.ruin || ruin();
const form = () => forms[state.analysis.kind] || Object.values(forms)[0];
const takes = (...what) => what.some(one => form().takes.includes(one));
const set = changes => change({ analysis: { ...state.analysis, ...changes } });
const held = box => state.analysis.values[`${state.analysis.kind}.${box.option}`] ?? box.start;
const put = (box, value) => set({ values: { ...state.analysis.values, [`${state.analysis.kind}.${box.option}`]: value } });

export function start(place, about) {
  panel = place; forms = about.forms;
  listen(keys => {
    if (!typing && ["analysis", "column", "assembly", "model", "motion", "ruin", "hazards", "table"].some(key => keys.has(key))) render();
    if (keys.has("analysisJob")) show();
    if (keys.has("tab") && state.tab === "analyses") render();
  });
  fill(panel, el("h1", {}, "Analyses"), el("p", { class: "lead" }, "What else can be asked of what stands, each with its pictures."),
    el("div", { class: "sheet left" }, el("div", { id: "analyses-asked", class: "card form", "data-errors": true }), el("div", { id: "analyses-found" })));
  render(); show();
}

function render() {
  const place = find("#analyses-asked", panel);
  const about = [takes("column") && called(), takes("model") && !form().boxes.some(one => one.option === "model") && state.model,
    takes("motion", "round") && motion.words(), takes("motions") && (state.analysis.records.length ? `${state.analysis.records.length} records` : motion.words())].filter(Boolean);
  redraw(place,
    field("Analysis", select(Object.entries(forms).map(([key, one]) => [key, one.title]), state.analysis.kind, kind => set({ kind }), { "data-field": "analysis" })),
    el("p", { class: "hint" }, form().lead), about.length > 0 && el("p", { class: "hint" }, about.join(" · ")),
    takes("ruin") && ruinFile(), takes("source") && source(), takes("hazard", "hazards") && hazards(),
    takes("motions") && records.pick(() => state.analysis.records, chosen => set({ records: chosen }), true),
    el("div", { class: "row" }, form().boxes.map(boxed)),
    el("div", { class: "row" }, el("button", { type: "button", class: "primary", onclick: () => go() }, "Compute")));
}

function boxed(box) {
  const given = { "data-field": box.option.replaceAll("-", "_") };
  if (box.many) {
    const chosen = held(box).split(",").filter(Boolean), tick = one => event => put(box, box.choices.filter(other => other === one ? event.target.checked : chosen.includes(other)).join(","));
    return el("fieldset", given, el("legend", {}, box.label), box.choices.map(one => el("label", { class: "check" }, el("input", { type: "checkbox", checked: chosen.includes(one), "data-key": `${box.option}.${one}`, onchange: tick(one) }), one)));
  }
  if (box.option === "model" && state.assembly) return field(box.label, select([[state.model, state.model]], state.model, () => {}, given));
  if (box.choices.length) return field(box.label, select(box.choices.map(one => [one, one || "as stated"]), held(box), value => put(box, value), given));
  return field(box.label, el("input", { value: held(box), placeholder: box.hint, ...given, oninput: event => { typing = true; put(box, event.target.value); typing = false; } }));
}

function ruinFile() {
  const files = opener("ruin", async ([file]) => { if (file) change({ ruin: await file.text() }); }, { accept: ".toml" });
  return [el("div", { class: "row" }, el("button", { type: "button", onclick: () => files.click() }, "Open ruin file …"), files,
    el("button", { type: "button", onclick: () => save("ruin.toml", text()) }, "Save ruin file"), el("button", { type: "button", class: "quiet", onclick: () => change({ ruin: "" }) }, "Begin anew")),
  field("Ruin file", el("textarea", { rows: 24, spellcheck: "false", "data-field": "ruin", value: text(), oninput: event => { typing = true; change({ ruin: event.target.value || "\n" }); typing = false; } }))];
}

// Runs that it rests on: a fragility of this page, or a table of runs of any other program.
function source() {
  const done = jobs.all().filter(one => (one.files || []).includes("fragility/fragility.json"));
  const files = opener("table", async ([file]) => { if (file) change({ table: await file.text() }); }, { accept: ".csv" });
  return [field("Fragility", select([["", done.length ? "choose" : "none yet: compute one, or open a table"], ...done.map(one => [one.id, one.title])], state.table === null ? state.analysis.source : "",
    id => { state.table = null; set({ source: id }); }, { "data-field": "source" })),
  el("div", { class: "row" }, el("button", { type: "button", onclick: () => files.click() }, "Open a table of runs …"), files,
    state.table === null ? el("small", { class: "hint" }, "with the columns record, im, collapsed") : [el("small", { class: "hint" }, "a table of runs is open"), el("button", { type: "button", class: "quiet", onclick: () => change({ table: null }) }, "Leave it out")])];
}

// The name of a file, told apart from that of another open file with other content.
function apart(name, text, open) {
  const end = name.lastIndexOf(".") > 0 ? name.lastIndexOf(".") : name.length;
  let called = name;
  for (let k = 2; called in open && open[called] !== text; k++) called = `${name.slice(0, end)}-${k}${name.slice(end)}`;
  return called;
}

function hazards() {
  const several = takes("hazards");
  const files = opener("hazard", async list => {
    const texts = await Promise.all(list.map(async file => [file.name, await file.text()]));
    const open = several ? { ...state.hazards } : {};
    for (const [name, text] of texts) open[apart(name, text, open)] = text;
    change({ hazards: open });
  }, { accept: ".csv,.xml", multiple: several });
  const leave = name => () => change({ hazards: Object.fromEntries(Object.entries(state.hazards).filter(([one]) => one !== name)) });
  return el("fieldset", { "data-field": "hazard" }, el("legend", {}, labels.hazard), el("div", { class: "row" }, el("button", { type: "button", onclick: () => files.click() }, several ? "Open hazard curves …" : "Open a hazard curve …"), files),
    Object.keys(state.hazards).length ? el("ul", { class: "pick" }, Object.keys(state.hazards).map(name => el("li", {}, el("span", {}, name), el("button", { type: "button", class: "quiet", "aria-label": `leave out ${name}`, onclick: leave(name) }, "Leave out"))))
      : el("p", { class: "hint" }, "A table with annual_rate and pga_g, pgv_m_s …, or a file of OpenQuake."));
}

// "kind" from a button elsewhere on the page: with what its form holds.
export async function go(kind = state.analysis.kind) {
  set({ kind });
  const asked = find("#analyses-asked", panel), options = {};
  const typed = box => box.unit ? numeral(held(box), box.option.replaceAll("-", "_"), box.label.replace(/ \[.*/, ""), { unit: /\[(.*)\]/.exec(box.label)[1], such: box.start }) : held(box);
  try {
    mark(asked, null);
    const common = run.common();
    for (const box of form().boxes) options[box.option] = box.option === "model" && state.assembly ? state.model : typed(box);
    const job = await post("/api/jobs", { kind, options, model: common.model, settings: common.settings,
      ...(takes("column") ? { column: common.column, assembly: common.assembly } : {}), ...(takes("tail") ? { tail: common.tail } : {}),
      ...(takes("motion", "motions", "round") ? { motion: motion.asked() } : {}), ...(takes("motions") ? { records: state.analysis.records } : {}),
      ...(takes("ruin") ? { ruin: text() } : {}), ...(takes("source") ? { source: state.analysis.source || null, table: state.table } : {}), ...(takes("hazard", "hazards") ? { hazards: state.hazards } : {}),
      page: { analysis: state.analysis, ...(takes("motion", "motions", "round") ? { motion: state.motion } : {}), ...(takes("ruin") ? { ruin: text() } : {}) } });
    change({ tab: "analyses", analysisJob: job.id }, { record: true });
  } catch (error) { change({ tab: "analyses" }); mark(asked, error); }
}

async function show() {
  if (!state.analysisJob) { fill(find("#analyses-found", panel), el("div", { class: "card empty" }, "Choose an analysis and compute it.")); return; }
  try { await hear(await get(`/api/jobs/${state.analysisJob}`)); } catch (error) { notice(error.error); change({ analysisJob: "" }); }
}

export async function hear(news) {
  if (news.kind === "ida" && !isOpen(news) && takes("source") && state.tab === "analyses") render();
  if (news.id !== state.analysisJob) return;
  const job = !isOpen(news) && !news.results ? await get(`/api/jobs/${news.id}`).catch(() => news) : news;
  if (job.id !== state.analysisJob) return;
  const place = find("#analyses-found", panel), told = forms[job.kind], found = (job.results || [])[0];
  let card = find(".card[data-key]", place);
  if (!card || card.dataset.job !== job.id || !isOpen(job)) { card = el("div", { class: "card", "data-key": "", "data-job": job.id }); fill(place, card); }
  const done = told && found && job.state === "done";
  tell(card, job, () => [
    el("p", { class: "hint" }, job.title), done && found.sentence && el("p", { class: "verdict" }, records.named(found.sentence)),
    done && el("div", {}, facts(Object.entries(told.facts).map(([key, label]) => [label, shown(at(found, key))]))), done && table(told, found),
    done && job.kind === "directions" && found.worst && worst(job, found.worst),
    done && job.film && el("div", { class: "row" }, el("button", { type: "button", onclick: () => change({ tab: "run", job: job.id }, { record: true }) }, "Watch it")),
    warnings([...(done ? [found.doubt, ...(found.warnings || [])] : []), ...(job.warnings || [])].filter(Boolean).map(records.named)), done && run.files(job),
  ].flat());
  if (!done) return;
  const there = Object.entries(told.pictures).filter(([name]) => (job.files || []).includes(`result/${name}.png`));
  place.append(el("div", { class: "figures" }, there.map(([name, said]) => el("div", { class: "card" }, el("h2", {}, said), el("img", { class: "figure", src: `/api/jobs/${job.id}/files/result/${name}.png`, alt: said })))));
}

// A film of the direction that does most harm.
const worst = (job, row) => el("div", { class: "row" }, el("button", { type: "button", onclick: async () => {
  const { asked } = await get(`/api/jobs/${job.id}`).catch(() => job);
  run.go(() => ({ column: asked.column, assembly: asked.assembly, tail: asked.tail, model: row.model, settings: row.model === asked.model ? asked.settings || {} : {}, motion: { ...asked.motion, azimuth: `${row.azimuth_deg}deg` } }));
} }, `Run it at ${row.azimuth_deg}°`));

const at = (row, path) => path.split(".").reduce((inner, key) => inner && inner[key], row);
const shown = value => typeof value === "number" ? number(value) : value === true ? "yes" : value === false ? "no" : typeof value === "string" ? records.named(value.replaceAll("_", " ")) : "";

// A row for each; columns of which no row has anything are left out.
function table(told, found) {
  const list = Object.entries(found[told.rows] || {}).map(([name, one]) => Array.isArray(found[told.rows]) ? one : { ...one, named: told.names[name] || name });
  const columns = [...(list.length && list[0].named ? [["named", ""]] : []), ...Object.entries(told.columns)].filter(([key]) => list.some(row => shown(at(row, key)) !== ""));
  return list.length > 0 && el("div", { class: "wide" }, el("table", {}, el("thead", {}, el("tr", {}, columns.map(([, label]) => el("th", { scope: "col" }, label)))),
    el("tbody", {}, list.map(row => el("tr", {}, columns.map(([key], k) => el(k ? "td" : "th", k ? {} : { scope: "row" }, shown(at(row, key)))))))));
}
