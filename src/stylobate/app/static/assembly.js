// An assembly of blocks from a file: shown as it stands, to be run; its blocks are edited in the file.

import { check as ask, latest } from "./api.js";
import { el, facts, fill, find, length, mark, number, save, warnings } from "./dom.js";
import { BLUE, BROWN, INK, SAND, sharp } from "./plot.js";
import { change, state } from "./state.js";

let described = null;
const asking = latest(text => ask("/api/assembly", { assembly: text }));

export function render(panel, files) {
  described = null;
  fill(panel,
    el("h1", {}, "Column"),
    el("p", { class: "lead" }, "An assembly of blocks stands, from its file. It is run as it is (dem2d, in the plane); domains and fragilities take columns."),
    el("div", { class: "sheet" },
      el("div", {},
        el("div", { class: "card", "data-errors": true },
          el("div", { class: "row" },
            el("button", { type: "button", onclick: () => files.click() }, "Open file …"), files,
            el("button", { type: "button", onclick: () => save("assembly.toml", state.assembly) }, "Save assembly file"),
            el("button", { type: "button", onclick: () => change({ assembly: "" }) }, "Back to the column"),
            el("button", { type: "button", onclick: () => change({ tab: "motion" }, { record: true }) }, "Next: motion →"))),
        el("div", { class: "card", id: "column-facts", "aria-live": "polite" })),
      el("div", { class: "card" }, el("canvas", { class: "elevation", role: "img", "aria-label": "Elevation of the assembly" }))));
  show(panel);
}

async function show(panel) {
  const found = await asking(state.assembly);
  if (!found || !state.assembly) return;
  if (found instanceof Error) { mark(panel, found); return; }
  described = found;
  const f = found.facts;
  fill(find("#column-facts", panel), facts([["assembly", f.name], ["blocks", f.blocks], ["held", f.fixed || ""], ["joints", f.joints], ["links", f.links || ""], ["mass", `${number(f.mass / 1000)} t`], ["height", length(f.height)]]), warnings(found.warnings));
  draw(find("canvas", panel));
}

export function draw(canvas) {
  if (!described || !canvas || !canvas.clientWidth) return;
  const [c, width, height] = sharp(canvas), points = described.outlines.xz.flat(), ground = described.ground;
  const xs = points.map(p => p[0]), zs = [...points.map(p => p[1]), ...(ground === null ? [] : [ground])];
  const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...zs), Math.max(...zs)];
  const scale = Math.min((width - 80) / (right - left), (height - 80) / (high - low || 1));
  const across = x => width / 2 + (x - 0.5 * (left + right)) * scale, up = z => height - 40 - (z - low) * scale;
  c.lineJoin = "round";
  described.outlines.xz.forEach((corners, i) => {
    c.beginPath(); corners.forEach(([x, z]) => c.lineTo(across(x), up(z))); c.closePath();
    c.fillStyle = described.held[i] ? "#dcdcdc" : SAND; c.strokeStyle = BROWN; c.lineWidth = 1.1; c.fill(); c.stroke();
  });
  c.strokeStyle = BLUE; c.lineWidth = 1.6;
  for (const ends of described.links.xz) { c.beginPath(); ends.forEach(([x, z]) => c.lineTo(across(x), up(z))); c.stroke(); }
  c.strokeStyle = c.fillStyle = INK;
  if (ground !== null) { c.beginPath(); c.moveTo(10, up(ground)); c.lineTo(width - 10, up(ground)); c.stroke(); }
  c.textAlign = "center"; c.textBaseline = "top"; c.fillText(`${number(right - left, 4)} m × ${number(high - low, 4)} m`, width / 2, height - 24);
}
