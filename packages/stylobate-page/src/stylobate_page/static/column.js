// Column: presets, a file, drum by drum in a table, beside the elevation.

import * as assembly from "./assembly.js";
import { check as ask, latest, postText, upload } from "./api.js";
import { choice, el, facts, field, fill, find, later, length, mark, notice, number, opener, redraw, save, select, warnings } from "./dom.js";
import { drawElevation } from "./elevation.js";
import { change, listen, state } from "./state.js";
import { isNumeral } from "./typed.js";

const SIZES = [["height", "Height", "m"], ["bottom_width", "Bottom", "m"], ["top_width", "Top", "m"], ["density", "Density", "kg/m³"]];
const DEPTH = ["depth", "Depth", "m"];
const FOUND = [["offset", "Offset", "m"], ["offset_azimuth", "Offset to", "°"], ["tilt", "Tilt", "°"], ["tilt_azimuth", "Tilt to", "°"], ["turn", "Turn", "°"]];
const CHIPS = [["chip_left", "Left", "m"], ["chip_right", "Right", "m"]];
const ROUND_CHIPS = [["chip_azimuth", "Right is at", "°"]], SQUARE_CHIPS = [["chip_front", "Front", "m"], ["chip_back", "Back", "m"]];
const JOINT = [["friction_coefficient", "Friction", "tan φ"], ["normal_stiffness", "Normal", "N/m³"], ["shear_stiffness", "Shear", "N/m³"], ["cohesion", "Cohe\u00adsion", "Pa"], ["ring_width", "Ring", "m"]];

let panel, view = "sizes", chosen = 0, described = null, hit = () => 0, presets = {}, own = false;

export function start(place, about) {
  panel = place; presets = about.presets;
  listen(keys => {
    if ((keys.has("column") || keys.has("assembly")) && !own && !assembly.edited()) { render(); check(); }
    if (keys.has("tab") && state.tab === "column") paint();
  });
  addEventListener("resize", later(paint, 60));
  render(); check();
}
export const description = () => described;

// What an input holds: a number, a text that is none, or nothing.
const value = text => text.trim() === "" ? undefined : isNumeral(text) ? Number(text) : text.trim();

function edit(changed) {
  own = true;
  change({ column: changed, preset: "" });
  own = false;
  const chooser = find("[data-field=preset]", panel);
  if (chooser) chooser.value = "";
  check();
}
function replace(changed, preset = "") { change({ column: changed, preset, assembly: "" }); }

// One value of a list of tables that are told apart by their index, such as [[as_found.drum]].
function indexed(list, index, key, given) {
  const rows = (list || []).map(one => ({ ...one }));
  let row = rows.find(one => one.index === index);
  if (!row) { row = { index }; rows.push(row); }
  if (given === undefined) delete row[key]; else row[key] = given;
  return rows.filter(one => Object.keys(one).length > 1).sort((a, b) => a.index - b.index);
}
function put(group, drum, key, given) {
  const table = structuredClone(state.column);
  if (group === "drum") { if (given === undefined) delete table.drum[drum - 1][key]; else table.drum[drum - 1][key] = given; }
  if (group === "found") {
    const drums = indexed((table.as_found || {}).drum, drum, key, given === 0 ? undefined : given);
    table.as_found = { base_tilt: 0, ...table.as_found, drum: drums };
  }
  if (group === "override") {
    if (key === "friction_coefficient" && given === undefined) table.joint_override = indexed(table.joint_override, drum, "friction_angle", undefined);
    table.joint_override = indexed(table.joint_override, drum, key, given);
    if (!table.joint_override.length) delete table.joint_override;
  }
  if (group === "joint") {
    if (key === "friction_coefficient") delete table.joint.friction_angle;
    if (given === undefined) delete table.joint[key]; else table.joint[key] = given;
  }
  if (group === "base") table.as_found = { drum: [], ...table.as_found, [key]: given ?? 0 };
  edit(table);
}

const check = later(latestCheck(), 120);
function latestCheck() {
  const asking = latest(table => ask("/api/column", table));
  return async () => {
    if (state.assembly) return;
    const table = state.column, found = await asking(table);
    if (!found || state.assembly) return;
    if (found instanceof Error) {
      mark(panel, found);
      const faulty = /^(?:drum|found|override)\.(\d+)\./.exec(found.field || "");
      described = null;
      fill(find("#column-facts", panel));  // those of another column say nothing of this one
      paint(faulty ? +faulty[1] : 0);
    } else {
      mark(panel, null);
      described = { ...found, table };
      fill(find("#column-facts", panel), summary(found.facts), warnings(found.warnings));
      paint();
    }
    document.dispatchEvent(new CustomEvent("column", { detail: described }));
  };
}

// What is drawn is one column with what is said of that one: until the next is known, the last, paler where another one stands.
let drawn = null;
function paint(faulty = 0) {
  const canvas = find("canvas", panel);
  if (!canvas || !canvas.clientWidth) return;
  drawn = described || drawn;
  if (state.assembly) { assembly.draw(canvas); return; }
  if (drawn) hit = drawElevation(canvas, drawn, { chosen, faulty });
  canvas.classList.toggle("past", Boolean(drawn) && drawn.table !== state.column);
}

function summary(f) {
  return facts([
    ["height", length(f.height)], ["mass", f.mass >= 1e4 ? number(f.mass / 1000) + " t" : number(f.mass, 4) + " kg"], ["slenderness α", number(f.slenderness) + " rad"],
    ["frequency parameter p", number(f.frequency_parameter) + " rad/s"], ["first joint opens at", number(f.uplift_g) + " g"], ["drums", f.drums],
  ]);
}

function render() {
  const table = state.column;
  if (!table) return;
  const files = opener("column", ([file]) => open(file), { accept: ".toml,.csv,.xlsx,.xlsm" });
  if (state.assembly) { assembly.render(panel, files); return; }
  redraw(panel,
    el("h1", {}, "Column"),
    el("p", { class: "lead" }, "What stands: a preset, a file of a column or of an assembly of blocks, or drum by drum. The elevation follows as you type."),
    el("div", { class: "sheet" },
      el("div", {},
        el("div", { class: "card", "data-errors": true },
          el("div", { class: "row" },
            field("Preset", select([["", "own column"], ...Object.keys(presets).map(one => [one, one])], state.preset,
              name => name && replace(structuredClone(presets[name]), name), { "data-field": "preset" })),
            field("Name", el("input", { value: table.name || "", maxlength: 120, "data-field": "name", oninput: event => edit({ ...state.column, name: event.target.value }) }))),
          el("div", { class: "row" },
            el("button", { type: "button", onclick: () => files.click() }, "Open file …"), files,
            el("button", { type: "button", onclick: saveFile }, "Save column file"),
            el("button", { type: "button", onclick: () => change({ assembly: assembly.EXAMPLE, model: "dem2d", settings: {}, replicates: "" }) }, "Write an assembly …"),
            el("button", { type: "button", onclick: () => { change({ tab: "motion" }, { record: true }); } }, "Next: motion →")),
          choice("section", "Section", [["circular", "round"], ["rectangular", "rectangular"]], table.section || "rectangular", section)),
        el("div", { class: "card" },
          choice("view", "Drum by drum, as they stand", [["sizes", "Sizes"], ["found", "As found"], ["chips", "Chips"], ["joints", "Joints"]], view, one => { view = one; render(); check(); }),
          el("div", { class: "tall" }, drums(table)),
          el("div", { class: "row" },
            el("button", { type: "button", onclick: () => pile(1) }, "Add a drum on top"),
            el("button", { type: "button", disabled: table.drum.length < 2, onclick: () => pile(-1) }, "Remove the topmost")),
          common(table), equal(table), links(table))),
      el("div", {},
        el("div", { class: "card" }, el("canvas", { class: "elevation", role: "img", "aria-label": "Elevation of the column", onclick: pick })),
        el("div", { class: "card", id: "column-facts", "aria-live": "polite" }))));
  paint();
}

// The table of drums, the topmost first, as they stand.
function drums(table) {
  const round = (table.section || "rectangular") === "circular";
  const shown = view === "sizes" ? [...SIZES.slice(0, 3), ...(round ? [] : [DEPTH]), SIZES[3]] : { found: FOUND, chips: [...CHIPS, ...(round ? ROUND_CHIPS : SQUARE_CHIPS)], joints: JOINT }[view];
  const group = { sizes: "drum", found: "found", chips: "found", joints: "override" }[view];
  const rows = table.drum.map((drum, i) => {
    const number = i + 1, found = ((table.as_found || {}).drum || []).find(one => one.index === number) || {};
    const own = (table.joint_override || []).find(one => one.index === number) || {};
    const cells = shown.map(([key, label, unit]) => {
      const given = { drum: drum[key] ?? table[key], found: found[key], override: own[key] ?? (key === "friction_coefficient" && own.friction_angle !== undefined ? tangent(own.friction_angle) : undefined) }[group];
      const hint = group === "override" ? table.joint[key] ?? (key === "friction_coefficient" ? tangent(table.joint.friction_angle ?? 35) : "") : group === "found" ? 0 : "";
      return el("td", {}, el("input", {
        value: given === undefined ? "" : tidy(given), placeholder: String(tidy(hint)), inputmode: "decimal", "data-field": `${group}.${number}.${key}`,
        "aria-label": `${view === "chips" ? "chip, " : ""}${label.toLowerCase().replace("\u00ad", "")} of ${group === "override" ? "the joint under " : ""}drum ${number} [${unit}]`,
        oninput: event => put(group, number, key, value(event.target.value)),
      }));
    });
    return el("tr", { "data-drum": number, onfocusin: () => { mind(number); } }, el("td", { class: "number" }, number), cells);
  }).reverse();
  return el("table", { class: shown.length > 4 ? "drums many" : "drums" },
    el("thead", {}, el("tr", {}, el("th", {}, "#"), shown.map(([, label, unit]) => el("th", { scope: "col" }, round && /Bottom|Top/.test(label) ? `${label} ⌀` : label, " ", el("small", {}, unit))))),
    el("tbody", {}, rows));
}
// Shown with five digits; what is not edited keeps all of its own.
const tidy = given => typeof given !== "number" ? given : Math.abs(given) >= 1e7 ? given.toExponential().replace("e+", "e") : +given.toPrecision(5);
const tangent = angle => +Math.tan(angle * Math.PI / 180).toPrecision(6);

// What all joints have in common, and the base.
function common(table) {
  const entry = (group, key, label, unit, given) => field(`${label} [${unit}]`, el("input", {
    value: given === undefined ? "" : tidy(given), inputmode: "decimal", "data-field": group === "base" ? key : `joint.${key}`,
    oninput: event => put(group, 0, key, value(event.target.value)),
  }));
  const joint = table.joint, found = table.as_found || {};
  return el("details", { open: view !== "sizes" }, el("summary", {}, "All joints, and the base"),
    el("div", { class: "row" },
      entry("joint", "friction_coefficient", "Friction", "tan φ", joint.friction_coefficient ?? tangent(joint.friction_angle ?? 35)),
      entry("joint", "normal_stiffness", "Normal stiffness", "N/m³", joint.normal_stiffness), entry("joint", "shear_stiffness", "Shear stiffness", "N/m³", joint.shear_stiffness)),
    el("div", { class: "row" },
      entry("joint", "cohesion", "Cohesion", "Pa", joint.cohesion ?? 0), entry("joint", "ring_width", "Ring width", "m", joint.ring_width),
      entry("base", "base_tilt", "Base slopes by", "°", found.base_tilt ?? 0), entry("base", "base_azimuth", "up towards", "°", found.base_azimuth ?? 0)));
}

// Equal drums between two widths, as in a column file with [tapered].
function equal(table) {
  const first = table.drum[0], last = table.drum[table.drum.length - 1];
  const asked = { height: table.drum.reduce((sum, one) => sum + (+one.height || 0), 0), bottom: first.bottom_width, top: last.top_width, drums: table.drum.length };
  const entry = (key, label) => field(label, el("input", { value: tidy(asked[key]), inputmode: "decimal", oninput: event => { asked[key] = Number(event.target.value); } }));
  const make = () => {
    const n = asked.drums;
    if (!Number.isInteger(n) || n < 1 || n > 200 || !(asked.height > 0)) { notice("Give a height, two widths, and 1 to 200 drums."); return; }
    const exact = one => +one.toPrecision(12), width = k => exact(asked.bottom + (asked.top - asked.bottom) * k / n);
    const drum = Array.from({ length: n }, (_, k) => ({ ...first, height: exact(asked.height / n), bottom_width: width(k), top_width: width(k + 1) }));
    const rest = { ...structuredClone(state.column), drum };
    for (const key of ["joint_override", "as_found", "link"]) delete rest[key];
    replace(rest);
  };
  return el("details", {}, el("summary", {}, "Make equal drums"),
    el("div", { class: "row" }, entry("height", "Height [m]"), entry("bottom", "Bottom width [m]"), entry("top", "Top width [m]"), entry("drums", "Drums"),
      el("button", { type: "button", onclick: make }, "Make them")));
}

// Strengthening: dowels, bars, ties … as in a column file with [[link]]; what else a file says of a link is kept.
const WORDS = { joint: "Joint, or all", from_drum: "From drum", to_drum: "To drum", at: "At x, y [m]", to: "To x, y [m]", diameter: "Diameter [m]", embedment: "Embedment [m]", material: "Material", friction_coefficient: "Friction [tan φ]",
  clearance: "Slack [m]", hole: "Hole ⌀ [m]", shear_stiffness: "Shear stiffness [N/m]", shear_capacity: "Shear capacity [N]", ultimate_slip: "Lost at slip [m]", failure: "Fails",
  axial_stiffness: "Axial stiffness [N/m]", axial_capacity: "Axial capacity [N]", ultimate_elongation: "Lost at elongation [m]", pretension: "Pretension [N]",
  from_height: "From height [m]", to_height: "To height [m]", damping: "Dashpot [N s/m]",
  thickness: "Thickness [m]", normal_stiffness: "Stiffness [N/m³]", "pad.shear_stiffness": "Shear stiffness [N/m³]", friction_angle: "Friction angle [°]", shape_factor: "Shape factor [–]" };
const LINKS = {
  dowel: ["joint", "at", "diameter", "embedment", "material"], bar: ["joint", "at", "diameter", "embedment", "material"],
  tie: ["from_drum", "to_drum", "at", "to", "diameter", "material"], core: ["from_drum", "to_drum", "diameter", "material"], layer: ["joint", "friction_coefficient"],
  pad: ["joint", "thickness", "material"],
};
// What follows from material and size unless it is given.
const SHEAR = ["clearance", "hole", "shear_stiffness", "shear_capacity", "ultimate_slip", "failure"], AXIAL = ["axial_stiffness", "axial_capacity", "ultimate_elongation", "pretension"];
const MORE = { dowel: SHEAR, bar: [...SHEAR, ...AXIAL], tie: ["from_height", "to_height", ...AXIAL], core: ["at", "from_height", "to_height", ...AXIAL], layer: ["shear_stiffness", "shear_capacity", "damping", "ultimate_slip"],
  pad: ["normal_stiffness", "shear_stiffness", "friction_coefficient", "friction_angle", "shape_factor"] };
const TEXTS = ["material", "failure"];
function fresh(kind) {
  const { drum } = state.column, n = drum.length, aside = tidy(0.5 * Math.max(...drum.map(one => Math.max(one.bottom_width, one.top_width))) + 0.05);
  const whole = { joint: Math.min(2, n), from_drum: 1, to_drum: n, diameter: 0.03, embedment: 0.15, material: "titanium", friction_coefficient: 0.6 };
  const shown = Object.fromEntries(LINKS[kind].filter(key => key in whole).map(key => [key, whole[key]]));
  return { kind, ...shown, ...(kind === "tie" ? { at: [aside, 0], to: [aside, 0] } : {}), ...(kind === "pad" ? { thickness: 0.005, material: "lead" } : {}) };
}
const pair = text => text.trim() === "" ? undefined : text.split(",").map(value);

function links(table) {
  const rows = table.link || [], now = () => state.column.link || [];  // what has been typed since is in the state alone
  const set = (k, key, given) => {
    const list = structuredClone(state.column.link);
    if (key === "joint") delete list[k].joints;
    if (given === undefined) delete list[k][key]; else if (key === "joint" && given === "all") { delete list[k].joint; list[k].joints = "all"; } else list[k][key] = given;
    edit({ ...structuredClone(state.column), link: list });
  };
  const all = list => { const rest = structuredClone(state.column); if (list.length) rest.link = list; else delete rest.link; replace(rest); };
  const held = (one, key) => key === "joint" ? one.joint ?? one.joints : one[key];
  const box = (one, k, key) => field(WORDS[`${one.kind}.${key}`] || WORDS[key], el("input", {
    value: Array.isArray(held(one, key)) ? held(one, key).join(", ") : held(one, key) ?? "", "data-field": `link.${k + 1}.${key}`,
    placeholder: MORE[one.kind].includes(key) ? key === "at" ? "0, 0" : "by formula" : "",
    oninput: event => set(k, key, key === "at" || key === "to" ? pair(event.target.value) : TEXTS.includes(key) ? event.target.value.trim() || undefined : value(event.target.value)),
  }));
  return el("details", { open: rows.length > 0 }, el("summary", {}, "Strengthening"),
    rows.map((one, k) => el("div", { class: "row tight link", "data-field": `link.${k + 1}` },
      field("Kind", select(Object.keys(LINKS).map(kind => [kind, kind]), one.kind, kind => all(now().map((other, i) => i === k ? fresh(kind) : other)))),
      (LINKS[one.kind] || []).map(key => box(one, k, key)),
      el("details", { class: "more", open: (MORE[one.kind] || []).some(key => one[key] !== undefined) }, el("summary", {}, "More"), el("div", { class: "row tight" }, (MORE[one.kind] || []).map(key => box(one, k, key)))),
      el("button", { type: "button", class: "quiet", "aria-label": `remove link ${k + 1}`, onclick: () => all(now().filter((_, i) => i !== k)) }, "Remove"))),
    el("div", { class: "row" }, el("button", { type: "button", onclick: () => all([...now(), fresh("dowel")]) }, "Add a link")));
}

function section(given) {
  const table = { ...structuredClone(state.column), section: given };
  for (const drum of table.drum) { if (given === "circular") { delete drum.depth; delete drum.top_depth; } else drum.depth ??= drum.bottom_width; }
  if (given === "circular") delete table.depth;
  replace(table);
}

function pile(step) {
  const table = structuredClone(state.column), top = table.drum[table.drum.length - 1];
  if (step > 0) table.drum.push({ ...top, bottom_width: top.top_width, top_width: top.top_width });
  else {
    const gone = table.drum.length;
    table.drum.pop();
    if (table.as_found) table.as_found.drum = (table.as_found.drum || []).filter(one => one.index < gone);
    if (table.joint_override) table.joint_override = table.joint_override.filter(one => one.index < gone);
    if (table.link) table.link = table.link.filter(one => (typeof one.joint !== "number" || one.joint < gone) && (typeof one.to_drum !== "number" || one.to_drum < gone));
    for (const key of ["joint_override", "link"]) if (table[key] && !table[key].length) delete table[key];
  }
  replace(table);
}

function mind(number) {
  chosen = number;
  for (const row of panel.querySelectorAll("tr[data-drum]")) row.classList.toggle("here", +row.dataset.drum === number);
  paint();
}
function pick(event) {
  const box = event.target.getBoundingClientRect(), drum = hit([event.clientX - box.left, event.clientY - box.top]);
  if (drum) find(`tr[data-drum="${drum}"] input`, panel).focus();
}

// What a survey leaves open, its stone or what its columns hold, is asked for.
export async function open(file, stated = {}) {
  if (!file) return;
  try {
    const found = await upload("/api/column/file", file, stated);
    if (found.assembly) change({ assembly: found.assembly, model: found.model, settings: {}, replicates: "" }); else replace(found.table);
    notice(`${file.name} is open.`);
  } catch (error) {
    const header = `x-${error.field}`, open_ = ["material", "columns"].includes(error.field) && !stated[header];
    const said = open_ && window.prompt(error.error, error.field === "material" ? "marble" : (/"([^"]+)": check/.exec(error.error) || ["", ""])[1]);
    if (said) await open(file, { ...stated, [header]: encodeURIComponent(said) }); else mark(panel, error);
  }
}
async function saveFile() {
  try {
    const name = (state.column.name || "column").replace(/[^\w-]+/g, "-").replace(/^-+|-+$/g, "") || "column";
    save(`${name}.toml`, await postText("/api/column/toml", state.column));
  } catch (error) { mark(panel, error); }
}
