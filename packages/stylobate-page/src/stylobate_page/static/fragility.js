// Fragility: every record scaled until the column falls, and the curve that comes of it.

import { get, post } from "./api.js";
import * as curves from "./curves.js";
import { choice, el, facts, field, fill, find, labels, mark, notice, number, redraw, select, warnings } from "./dom.js";
import { isOpen, tell } from "./news.js";
import * as motion from "./motion.js";
import * as records from "./records.js";
import * as run from "./run.js";
import { called, change, listen, state } from "./state.js";
import { numeral } from "./typed.js";

const MEASURES = [["pgv", "peak velocity"], ["pga", "peak acceleration"], ["sa:1.0s", "spectral acceleration at 1 s"], ["avgsa", "average spectral acceleration"]];
const STATES = [["collapse", "collapse"], ["top:0.35d", "top moves 0.35 d"], ["drums:0.01d", "drums shift 0.01 d"]];
let panel, typing = false;  // what is typed stays in its field, and a click after it finds its button

export function start(place) {
  panel = place;
  listen(keys => {
    if ((keys.has("fragility") && !typing) || keys.has("column") || keys.has("assembly") || keys.has("model")) render();
    if (keys.has("fragilityJob")) show();
    if (keys.has("tab") && state.tab === "fragility") { render(); curves.redraw(); }
  });
  fill(panel, el("h1", {}, "Fragility"), el("p", { class: "lead" }, "Each record is scaled up until what stands falls; from all of them comes the curve: how likely it falls at which intensity."),
    el("div", { class: "sheet left" }, el("div", { id: "fragility-asked", class: "card", "data-errors": true }), el("div", { id: "fragility-found" })));
  render(); show();
}
// An assembly has no top and no drums of one width: of it collapse alone is asked for.
const limits = () => state.assembly ? STATES.slice(0, 1) : STATES;
const wanted = () => state.assembly ? "collapse" : state.fragility.state;
const set = changes => change({ fragility: { ...state.fragility, ...changes } });

function render() {
  const s = state.fragility, place = find("#fragility-asked", panel);
  redraw(place, el("p", { class: "hint" }, `${called()} · ${state.model}`),
    records.pick(() => state.fragility.records, chosen => set({ records: chosen })),
    el("div", { class: "row" }, field(labels.im, select(MEASURES, s.im, im => set({ im }), { "data-field": "im" })),
      field(labels.runs, el("input", { value: s.runs, inputmode: "numeric", "data-field": "runs", oninput: event => { typing = true; set({ runs: event.target.value.trim() }); typing = false; } })),
      field(`${labels.unit}, where a file states none`, select(motion.UNITS.map(one => [one, one || "as stated"]), s.unit, unit => set({ unit }), { "data-field": "unit" }))),
    field(`${labels.columns} of text files without a header such as time_s,ax_g`, el("input", { value: s.columns, placeholder: "such as t [s], x [g], -, z [g]", "data-field": "columns", oninput: event => { typing = true; set({ columns: event.target.value.trim() }); typing = false; } })),
    choice("state", labels.state, limits(), wanted(), one => set({ state: one })),
    el("div", { class: "row" }, el("button", { type: "button", class: "primary", onclick: go }, "Compute"), el("small", { class: "hint" }, `${s.records.length} records${s.records.length < 10 ? "; a fragility takes ten" : ""}`)));
}

async function go() {
  const s = state.fragility, asked = find("#fragility-asked", panel);
  try {
    mark(asked, null);
    const job = await post("/api/jobs", { kind: "ida", ...run.common(), records: s.records, im: s.im, runs: numeral(s.runs, "runs", labels.runs, { such: "8", whole: true }), state: wanted(), page: { fragility: s }, ...(s.unit ? { unit: s.unit } : {}), ...(s.columns ? { columns: s.columns.replace(/"/g, "") } : {}) });
    change({ fragilityJob: job.id });
  } catch (error) { mark(asked, error); }
}

async function show() {
  if (!state.fragilityJob) { fill(find("#fragility-found", panel), el("div", { class: "card empty" }, "Choose records and compute.")); return; }
  try { await hear(await get(`/api/jobs/${state.fragilityJob}`)); } catch (error) { notice(error.error); change({ fragilityJob: "" }); }
}

export async function hear(news) {
  if (news.id !== state.fragilityJob) return;
  const job = !isOpen(news) && !news.results ? await get(`/api/jobs/${news.id}`).catch(() => news) : news;
  const [analysis, curve] = job.results || [], place = find("#fragility-found", panel);
  let card = find(".card[data-key]", place);
  if (!card || !isOpen(job)) card = el("div", { class: "card", "data-key": "" });
  tell(card, job, () => [
    el("p", { class: "hint" }, job.title),
    curve && el("p", { class: "verdict" }, records.named(curve.sentence)),
    curve && facts([["median", `${known(curve)} ${curve.unit} (95 %: ${number(curve.median_low)} to ${number(curve.median_high)})`], ["dispersion β", `${number(curve.beta)} (95 %: ${number(curve.beta_low)} to ${number(curve.beta_high)})`],
      ["from", `${curve.runs} runs of ${curve.records} records`], ["undecided", curve.undecided || ""], ["failed", curve.failed || ""]]),
    warnings([...Object.entries((analysis || {}).refused || {}).map(([name, why]) => `${name} was left out: ${why}`), ...(job.warnings || [])].map(records.named)), analysis && !isOpen(job) && run.files(job),
  ].flat());
  let figures = find(".figures", place);
  if (!card.isConnected || !figures) fill(place, card, figures = el("div", { class: "figures" }));
  const key = `${job.id} ${job.state} ${job.grown}`;
  if (figures.dataset.key === key || job.state === "waiting") return;
  figures.dataset.key = key;  // the last points of a job, and whether it goes on
  curves.show(figures, job.id).catch(error => notice(error.error || String(error)));
}
// Beyond the levels that were run only their bound is known of a median.
const known = ({ median, outside, levels: [low, high] }) => !outside ? number(median) : median > high ? `> ${number(high)}` : `≤ ${number(low)}`;
