// An assembly of blocks: the text of its file, which is edited here, beside how it stands.

import { check as ask, latest } from "./api.js";
import { el, facts, field, fill, find, later, length, mark, number, save, warnings } from "./dom.js";
import { BLUE, BROWN, INK, sharp } from "./plot.js";
import { change, state } from "./state.js";

// Two posts and a beam, to begin with.
export const EXAMPLE = `name = "two posts and a beam"
density = 2500.0                # kg/m³

[joint]
normal_stiffness = 5.0e9        # N/m³
shear_stiffness = 2.5e9
friction_angle = 35.0           # degrees

[[block]]
name = "left post"
vertices = [[0, 0], [1, 0], [1, 3], [0, 3]]      # x, z [m]; in space box = [x, y, z] and at = [x, y, z]

[[block]]
name = "right post"
vertices = [[4, 0], [5, 0], [5, 3], [4, 3]]

[[block]]
name = "beam"
vertices = [[0, 3], [5, 3], [5, 4], [0, 4]]
`;

let described = null, typing = false;
const asking = latest(text => ask("/api/assembly", { assembly: text }));
export const edited = () => typing;

export function render(panel, files) {
  described = null;
  const edit = event => { typing = true; change({ assembly: event.target.value || "\n" }); typing = false; check(panel); };
  fill(panel,
    el("h1", {}, "Column"),
    el("p", { class: "lead" }, "An assembly of blocks stands: run it, find what amplitude brings it down, or its fragility. Domains are of columns. What is drawn follows as you type."),
    el("div", { class: "sheet" },
      el("div", {},
        el("div", { class: "card", "data-errors": true },
          el("div", { class: "row" },
            el("button", { type: "button", onclick: () => files.click() }, "Open file …"), files,
            el("button", { type: "button", onclick: () => save("assembly.toml", state.assembly) }, "Save assembly file"),
            el("button", { type: "button", onclick: () => change({ assembly: "", model: "dem2d", settings: {} }) }, "Back to the column"),
            el("button", { type: "button", onclick: () => change({ tab: "motion" }, { record: true }) }, "Next: motion →")),
          el("div", { class: "row" }, field("Assembly file", el("textarea", { rows: 26, spellcheck: "false", "data-field": "assembly", value: state.assembly, oninput: edit }))))),
      el("div", {}, el("div", { class: "card" }, el("canvas", { class: "elevation", role: "img", "aria-label": "The assembly as it stands" })),
        el("div", { class: "card", id: "column-facts", "aria-live": "polite" }))));
  show(panel);
}

const check = later(panel => show(panel), 150);
async function show(panel) {
  const asked = state.assembly, found = await asking(asked);
  if (!found || !state.assembly) return;
  if (found instanceof Error) {
    mark(panel, found);
    fill(find("#column-facts", panel));  // those of another one say nothing of this text
    draw(find("canvas", panel));
    return;
  }
  mark(panel, null);
  described = { ...found, text: asked };
  if (found.model !== state.model) change({ model: found.model, settings: {} });
  const f = found.facts;
  fill(find("#column-facts", panel), facts([["assembly", f.name], ["blocks", f.blocks], ["held", f.fixed || ""], ["joints", f.joints], ["links", f.links || ""], ["mass", `${number(f.mass / 1000)} t`], ["height", length(f.height)]]), warnings(found.warnings));
  draw(find("canvas", panel));
}

// Elevations, plan and a view from above a corner, all in one scale; of an assembly in the plane its one elevation.
// What is drawn is one assembly with its own sizes: paler where the text is another one already.
export function draw(canvas) {
  if (!described || !canvas || !canvas.clientWidth) return;
  canvas.classList.toggle("past", described.text !== state.assembly);
  const [c, width, height] = sharp(canvas), views = described.views.map(boxed), across = views.length > 1 ? 2 : 1, down = Math.ceil(views.length / across);
  const [wide, high] = [width / across, height / down];
  const scale = Math.min(...views.map(one => Math.min((wide - 50) / one.wide, (high - 70) / (one.high || 1))));
  views.forEach((one, k) => paint(c, one, scale, (k % across + 0.5) * wide, (Math.floor(k / across) + 1) * high - 42, wide));
}

function boxed(view) {
  const points = view.polygons.flat(), xs = points.map(p => p[0]), ys = points.map(p => p[1]), [left, right] = [Math.min(...xs), Math.max(...xs)];
  const [bottom, top] = [Math.min(...ys), Math.max(...ys)], low = view.ground === null ? bottom : Math.min(bottom, Math.max(view.ground, bottom - 5));
  return { ...view, middle: 0.5 * (left + right), wide: right - left, low, high: top - low };
}

function paint(c, view, scale, x0, y0, room) {
  const point = ([x, y]) => [x0 + (x - view.middle) * scale, y0 - (y - view.low) * scale];
  if (view.ground !== null) { const y = point([0, view.ground])[1]; if (y < y0 + 20) { c.strokeStyle = INK; c.lineWidth = 1.2; c.beginPath(); c.moveTo(x0 - 0.48 * room, y); c.lineTo(x0 + 0.48 * room, y); c.stroke(); } }
  c.lineJoin = "round";
  view.polygons.forEach((corners, i) => {
    c.beginPath(); for (const corner of corners) c.lineTo(...point(corner)); c.closePath();
    c.fillStyle = view.colours[i]; c.strokeStyle = view.outlines[i] ? BROWN : view.colours[i]; c.lineWidth = view.outlines[i] ? 1.6 : 0.4; c.fill(); c.stroke();
  });
  c.strokeStyle = BLUE; c.lineWidth = 1.6;
  for (const [from, to] of view.links) { c.beginPath(); c.moveTo(...point(from)); c.lineTo(...point(to)); c.stroke(); }
  c.fillStyle = INK; c.textAlign = "center"; c.textBaseline = "top";
  c.fillText(`${number(view.wide, 4)} m × ${number(view.high, 4)} m`, x0, y0 + 8); c.fillText(view.said, x0, y0 + 24);
}
