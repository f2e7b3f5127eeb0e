// Jobs: what is computed, waits and is done, with its files.

import { get, post, remove } from "./api.js";
import { el, fill, find, notice } from "./dom.js";
import { files, sentence } from "./run.js";
import { change } from "./state.js";

let panel;
const jobs = new Map();

export function start(place) { panel = place; paint(); }

export function hear(job) { jobs.set(job.id, job); later(); }
export function gone(id) { jobs.delete(id); later(); }
export const open = () => [...jobs.values()].filter(one => ["waiting", "running"].includes(one.state));

let waiting = 0;
function later() { if (!waiting) waiting = setTimeout(() => { waiting = 0; paint(); }, 60); }

const OPEN = { run: ["run", "job"], domain: ["domain", "domainJob"], ida: ["fragility", "fragilityJob"] };

function paint() {
  const count = open().length, tab = find("[data-tab=jobs]");
  fill(tab, "Jobs", count > 0 && el("span", { class: "count" }, count));
  const list = [...jobs.values()].sort((a, b) => b.created - a.created);
  fill(panel, el("h1", {}, "Jobs"), el("p", { class: "lead" }, "One at a time, in a process of its own; the others wait here. They go on when this page is closed or reloaded."),
    list.length ? el("ul", { class: "jobs" }, list.map(shown)) : el("div", { class: "card empty" }, "No job yet: run a column, or map its domain."));
}

function shown(job) {
  const isOpen = ["waiting", "running"].includes(job.state), [tab, key] = OPEN[job.kind] || [];
  const act = what => async () => { try { await what(); } catch (error) { notice(error.error); } };
  return el("li", { "data-job": job.id }, el("div", { class: "head" }, el("span", { class: `tag ${job.state}` }, job.state), el("b", {}, job.title)),
    isOpen || job.sentence ? el("p", { class: "hint" }, sentence(job)) : null,
    isOpen && job.total > 0 && el("progress", { max: job.total, value: job.done, "aria-label": `progress of ${job.title}` }),
    el("div", { class: "row" },
      tab && el("button", { type: "button", onclick: () => change({ tab, [key]: job.id }, { record: true }) }, "Show"),
      isOpen && el("button", { type: "button", onclick: act(() => post(`/api/jobs/${job.id}/cancel`)) }, "Cancel"),
      ["cancelled", "failed"].includes(job.state) && el("button", { type: "button", onclick: act(() => post(`/api/jobs/${job.id}/again`)) }, "Go on with it"),
      el("button", { type: "button", onclick: act(() => restore(job.id)) }, "Take its settings"),
      el("button", { type: "button", class: "quiet", "aria-label": `delete ${job.title}`, onclick: act(() => remove(`/api/jobs/${job.id}`)) }, "Delete")),
    !isOpen && files(job));
}

async function restore(id) {
  const { asked } = await get(`/api/jobs/${id}`);
  change({ tab: "column", column: asked.column, preset: "", model: asked.model || "dem2d", settings: asked.settings || {} }, { record: true });
  notice("Its column and its model are taken.");
}
