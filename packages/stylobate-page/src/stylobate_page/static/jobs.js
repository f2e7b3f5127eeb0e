// Jobs: what is computed, waits and is done, with its files.

import { get, remove } from "./api.js";
import { el, fill, find, notice } from "./dom.js";
import { isOpen, tell } from "./news.js";
import { files } from "./run.js";
import { change } from "./state.js";

let panel = null, analyses = new Set();
const jobs = new Map();

export function start(place, about) {
  panel = place; analyses = new Set(Object.keys(about.forms));
  fill(panel, el("h1", {}, "Jobs"), el("p", { class: "lead" }, "One at a time, in a process of its own; the others wait here. They go on when this page is closed or reloaded."),
    shown, el("div", { class: "card empty" }, "No job yet: run a column, or map its domain."));
  paint();
}

export function hear(job) { jobs.set(job.id, job); later(); }
export function gone(id) { jobs.delete(id); later(); }
export const all = () => [...jobs.values()].sort((a, b) => b.created - a.created);
export const open = () => [...jobs.values()].filter(isOpen);

let waiting = 0;
function later() { if (!waiting && panel) waiting = setTimeout(() => { waiting = 0; paint(); }, 60); }

const OPEN = { run: ["run", "job"], critical: ["run", "job"], domain: ["domain", "domainJob"], ida: ["fragility", "fragilityJob"] };

const places = new Map();

function paint() {
  const count = open().length, tab = find("[data-tab=jobs]");
  fill(tab, "Jobs", count > 0 && el("span", { class: "count" }, count));
  const list = all();
  for (const id of places.keys()) if (!jobs.has(id)) places.delete(id);
  for (const job of list) if (!places.has(job.id)) places.set(job.id, frame(job));
  for (const job of list) {
    const [item, tag, news] = places.get(job.id);
    tag.textContent = job.state; tag.className = `tag ${job.state}`;
    tell(news, job, () => !isOpen(job) ? files(job) : null);
    if (item.parentElement !== shown) shown.append(item);
  }
  const wanted = list.map(job => places.get(job.id)[0]);
  if (wanted.some((item, k) => shown.children[k] !== item) || shown.children.length !== wanted.length) fill(shown, wanted);
  find("#jobs .empty", document).hidden = list.length > 0;
}

const shown = el("ul", { class: "jobs" });

function frame(job) {
  const [tab, key] = OPEN[job.kind] || (analyses.has(job.kind) ? ["analyses", "analysisJob"] : []), tag = el("span", { class: "tag" }), news = el("div", { class: "news" });
  const act = what => async () => { try { await what(); } catch (error) { notice(error.error); } };
  const item = el("li", { "data-job": job.id }, el("div", { class: "head" }, tag, el("b", {}, job.title)), news, el("div", { class: "row" },
    tab && el("button", { type: "button", onclick: () => change({ tab, [key]: job.id }, { record: true }) }, "Show"),
    el("button", { type: "button", onclick: act(() => restore(job.id)) }, "Take its settings"),
    el("button", { type: "button", class: "quiet", "aria-label": `delete ${job.title}`, onclick: act(() => remove(`/api/jobs/${job.id}`)) }, "Delete")));
  return [item, tag, news];
}

// The page as it was when the job was asked for.
async function restore(id) {
  const { asked, kind } = await get(`/api/jobs/${id}`), stands = asked.column || asked.assembly, shown = OPEN[kind] ? "column" : "analyses";
  if (!asked.page) { notice("A report has no settings of its own."); return; }
  change({ tab: shown, ...(asked.assembly ? { assembly: asked.assembly } : stands ? { column: asked.column, assembly: "", preset: "" } : {}),
    ...(stands ? { model: asked.model || "dem2d", settings: asked.settings || {} } : {}), ...(asked.hazards ? { hazards: asked.hazards, table: asked.table || null } : {}), ...asked.page }, { record: true });
  notice("Its settings are taken.");
}
