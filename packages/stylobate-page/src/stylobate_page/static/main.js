// The page begins: what there is to choose from, the parts, the line on which jobs are heard, and the address.

import { get } from "./api.js";
import * as analyses from "./analyses.js";
import * as column from "./column.js";
import { find, labels, notice } from "./dom.js";
import * as domain from "./domain.js";
import * as fragility from "./fragility.js";
import * as jobs from "./jobs.js";
import * as motion from "./motion.js";
import * as records from "./records.js";
import * as run from "./run.js";
import { change, followAddress, known, listen, read, SHOWN, state } from "./state.js";

const TABS = ["column", "motion", "run", "domain", "fragility", "analyses", "jobs"];

function showTab() {
  const tab = TABS.includes(state.tab) ? state.tab : "column";
  for (const one of TABS) {
    find(`#${one}`).hidden = one !== tab;
    const link = find(`[data-tab=${one}]`);
    if (one === tab) link.setAttribute("aria-current", "page"); else link.removeAttribute("aria-current");
  }
  document.title = `${tab[0].toUpperCase()}${tab.slice(1)} · stylobate`;
}

// One line for all news; the domain that is on show sends its cells on it.
let line = null, ready = false;
function follow() {
  if (line) line.close();
  line = new EventSource("/api/events" + (state.domainJob ? `?job=${encodeURIComponent(state.domainJob)}` : ""));
  const on = (name, hear) => line.addEventListener(name, event => hear(JSON.parse(event.data)));
  on("ready", now => { ready = now; status(); });
  on("job", job => { document.dispatchEvent(new CustomEvent("news", { detail: job })); jobs.hear(job); run.hear(job); domain.hear(job); fragility.hear(job); analyses.hear(job); status(); });
  on("gone", gone);
  on("cells", ({ job, cells }) => domain.add(job, cells));
  line.onerror = () => { find("#status").textContent = "not connected"; };
  line.onopen = status;
}
// A job that was deleted, here or on another page, is not shown any more.
function gone(id) {
  jobs.gone(id);
  change(Object.fromEntries(SHOWN.filter(key => state[key] === id).map(key => [key, ""])));
  status();
}
function status() {
  const open = jobs.open(), running = open.find(one => one.state === "running");
  const share = running && running.total ? ` ${Math.round(100 * running.done / running.total)} %` : "";
  find("#status").textContent = running ? `computing${share}${open.length > 1 ? `, ${open.length - 1} waiting` : ""}` : ready ? "ready" : "getting ready …";
}

async function begin() {
  if (location.search) history.replaceState(null, "", location.pathname + location.hash);  // what let the browser in is kept in its cookie
  Object.assign(state, read());
  showTab();
  const [about, kept] = await Promise.all([get("/api/about"), get("/api/records")]);
  Object.assign(labels, about.labels);
  known(about);
  if (!state.column) state.column = structuredClone(about.presets[state.preset] || Object.values(about.presets)[0]);
  listen(keys => {
    if (keys.has("tab")) { showTab(); }
    if (keys.has("domainJob")) follow();
    if (keys.has("column") && !state.column) change({ column: structuredClone(about.presets[state.preset] || Object.values(about.presets)[0]) });
  });
  records.start(about, kept.records);
  column.start(find("#column"), about);
  motion.start(find("#motion"), about);
  run.start(find("#run"), () => analyses.go("directions"));
  domain.start(find("#domain"));
  fragility.start(find("#fragility"));
  analyses.start(find("#analyses"), about);
  jobs.start(find("#jobs"), about);
  follow();
  document.documentElement.dataset.ready = "true";
}

addEventListener("hashchange", followAddress);
addEventListener("keydown", event => { if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) { event.preventDefault(); run.go(); } });
for (const link of document.querySelectorAll("#tabs a, .brand")) {
  link.addEventListener("click", event => {
    if (event.ctrlKey || event.metaKey || event.shiftKey || event.button) return;
    event.preventDefault();
    change({ tab: link.dataset.tab || "column" }, { record: true });
    scrollTo(0, 0);
  });
}
begin().catch(error => notice(error.error || String(error)));
