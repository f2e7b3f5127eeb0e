// What is said of a job while it waits, is computed, and has ended. Buttons stay where they are while numbers change.

import { post } from "./api.js";
import { capital, control, el, fill, find, mark, notice, number } from "./dom.js";
import * as records from "./records.js";

export const isOpen = job => job.state === "waiting" || job.state === "running";

export function sentence(job) {
  return { waiting: `Waits: ${job.place} before it.`, running: job.total ? `${number(job.done)} of ${number(job.total)} ${job.what}` : "It is computed …" }[job.state] || (job.sentence && capital(records.named(job.sentence)));
}

const act = (job, what) => async () => { try { await post(`/api/jobs/${job.id}/${what}`); } catch (error) { notice(error.error); } };

// What can be done about a job.
export function actions(job) {
  if (isOpen(job)) return [el("button", { type: "button", onclick: act(job, "cancel") }, "Cancel")];
  return ["cancelled", "failed"].includes(job.state) ? [el("button", { type: "button", onclick: act(job, "again") }, "Go on with it")] : [];
}

// Fills a place anew where the state of its job has changed; else only the words and the bar. "rest" makes what follows.
export function tell(place, job, rest = () => []) {
  const key = `${job.id} ${job.state} ${(job.files || []).length}`;
  if (place.dataset.key === key && isOpen(job)) {
    find(".sentence", place).textContent = sentence(job);
    const bar = find("progress", place);
    if (job.total) { bar.max = job.total; bar.value = job.done; }
    return;
  }
  place.dataset.key = key;
  const buttons = actions(job);
  fill(place, isOpen(job) || job.sentence ? el("p", { class: "verdict sentence" }, sentence(job)) : null,
    isOpen(job) && el("progress", { "aria-label": "progress", ...(job.total ? { max: job.total } : {}), ...(job.total ? { value: job.done } : {}) }),
    buttons.length > 0 && el("div", { class: "row" }, buttons), [rest()].flat(9));
  const panel = place.closest("section");
  if (job.state === "refused" && panel && control(panel, job.field)) mark(panel, { error: records.named(job.sentence), field: job.field });
}
