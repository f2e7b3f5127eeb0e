// Ruin: what is seen of columns that stand, have fallen or are out of place, and what shaking left them so.

import { get, post } from "./api.js";
import { el, field, fill, find, mark, notice, number, save } from "./dom.js";
import { isOpen, tell } from "./news.js";
import * as run from "./run.js";
import { change, listen, state } from "./state.js";

// A file to begin with: the column of the page, and what may be seen of it.
const example = () => `columns = ["${state.assembly ? "assembly.toml" : "column.toml"}"]   # what stands on the page; or presets by name
simulations = 1000
seed = 1

[[observed]]
column = "${state.assembly ? "assembly.toml" : "column.toml"}"
state = "stands"                           # or "fell", "fell before", "unknown"
no_slip_above = 0.02                       # no joint is out of place by more [m]
# offsets = [[1, 0.004, 0.002, 0.003]]     # joint, x, y, standard deviation [m]
# fell_towards = 200                       # from x towards y [degrees], of what fell

[prior]
pgv = [0.1, 1.5]                           # m/s
period = [0.3, 1.6]                        # s
`;
const text = () => state.ruin || example();
let panel;

export function start(place) {
  panel = place;
  listen(keys => {
    if (keys.has("ruin") || keys.has("assembly")) render();
    if (keys.has("ruinJob")) show();
  });
  const files = el("input", { type: "file", accept: ".toml", hidden: true, "data-upload": "ruin", onchange: async event => { if (event.target.files[0]) change({ ruin: await event.target.files[0].text() }); } });
  fill(panel, el("h1", {}, "Ruin"), el("p", { class: "lead" }, "What shaking was it? Columns that still stand, have fallen or are out of place are shaken by motions drawn from a prior; those that leave what is seen tell."),
    el("div", { class: "sheet left" },
      el("div", { class: "card", id: "ruin-asked", "data-errors": true },
        el("div", { class: "row" }, el("button", { type: "button", onclick: () => files.click() }, "Open ruin file …"), files,
          el("button", { type: "button", onclick: () => save("ruin.toml", text()) }, "Save ruin file"),
          el("button", { type: "button", class: "quiet", onclick: () => change({ ruin: "" }) }, "Begin anew")),
        field("Ruin file", el("textarea", { rows: 24, spellcheck: "false", "data-field": "ruin", oninput: event => { state.ruin = event.target.value; }, onchange: event => { const now = event.target.value; state.ruin = ""; change({ ruin: now }); } })),
        el("div", { class: "row" }, el("button", { type: "button", class: "primary", onclick: go }, "Infer"))),
      el("div", { id: "ruin-found" })));
  render(); show();
}

function render() { const box = find("textarea", panel); if (box.value !== text()) box.value = text(); }

async function go() {
  const asked = find("#ruin-asked", panel);
  try {
    mark(asked, null);
    const { column, assembly } = run.common();
    const job = await post("/api/jobs", { kind: "infer", ...(assembly ? { assembly } : { column }), ruin: text(), page: { ruin: text() } });
    change({ ruinJob: job.id }, { record: true });
  } catch (error) { mark(asked, error); }
}

async function show() {
  if (!state.ruinJob) { fill(find("#ruin-found", panel), el("div", { class: "card empty" }, "Say what is seen, and infer.")); return; }
  try { await hear(await get(`/api/jobs/${state.ruinJob}`)); } catch (error) { notice(error.error); change({ ruinJob: "" }); }
}

const CALLED = { pgv_m_s: "PGV [m/s]", pga_g: "PGA [g]", period_s: "period [s]", azimuth_deg: "azimuth [°]" };
const PICTURES = [["infer", "Posterior of the shaking; the prior is grey"], ["matches", "The ruin in plan beside draws that are nearest to it"], ["observations", "Which observation tells what"]];

export async function hear(news) {
  if (news.id !== state.ruinJob) return;
  const job = !isOpen(news) && !news.results ? await get(`/api/jobs/${news.id}`).catch(() => news) : news;
  const place = find("#ruin-found", panel), found = (job.results || [])[0];
  let card = find(".card[data-key]", place);
  if (!card || !isOpen(job)) { card = el("div", { class: "card", "data-key": "" }); fill(place, card); }
  const done = found && found.posterior && !isOpen(job);
  tell(card, job, () => [
    done && el("p", { class: "verdict" }, found.sentence), done && posterior(found.posterior),
    (job.warnings || []).map(one => el("p", { class: "warning" }, one)), done && run.files(job),
  ].flat());
  if (!done) return;
  const there = PICTURES.filter(([name]) => (job.files || []).includes(`result/${name}.png`));
  place.append(el("div", { class: "figures" }, there.map(([name, said]) => el("div", { class: "card" }, el("h2", {}, said), el("img", { class: "figure", src: `/api/jobs/${job.id}/files/result/${name}.png`, alt: said })))));
}

function posterior(told) {
  const head = ["", "median", "5 %", "95 %", "spread over the prior's"];
  return el("div", { class: "wide" }, el("table", {}, el("thead", {}, el("tr", {}, head.map(one => el("th", { scope: "col" }, one)))),
    el("tbody", {}, Object.entries(told).map(([name, one]) => el("tr", {}, el("th", { scope: "row" }, CALLED[name] || name),
      [one.median, one.low, one.high, one.spread_over_prior].map(value => el("td", {}, number(value))))))));
}
