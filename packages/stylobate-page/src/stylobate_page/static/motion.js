// Motion: a sine, a pulse, a sample, a record or a simulated one; its direction and size; what it looks like.

import { check as question, latest } from "./api.js";
import { dial } from "./dial.js";
import { choice, el, facts, field, fill, find, labels, later, mark, number, opener, redraw, select, warnings } from "./dom.js";
import { BLUE, GREY, INK, plot } from "./plot.js";
import * as records from "./records.js";
import { change, changeMotion, listen, state } from "./state.js";
import { numeral } from "./typed.js";

const kinds = () => [["harmonic", labels.harmonic], ["pulse", labels.pulse], ["sample", "Sample"], ["record", labels.motion], ["synthetic", labels.synthetic]];
const SHAPES = ["rectangular", "half-sine", "sine", "cosine", "ricker", "antisymmetric-ricker", "gabor", "mavroeidis-papageorgiou"];
export const UNITS = ["", "g", "m/s2", "cm/s2", "mm/s2", "mg", "in/s2", "ft/s2"];

let panel, samples, turner = null, shown = null, own = false;

export function start(place, about) {
  panel = place; samples = about.samples;
  listen(keys => {
    if (keys.has("motion") && !own) render();
    if (keys.has("motion") || keys.has("column")) check();
    if (keys.has("tab") && state.tab === "motion") paint();
  });
  addEventListener("resize", later(paint, 60));
  render(); check();
}

// Numbers of the form: what they are called, their unit, and one that they may be.
const NUMBERS = {
  frequency: ["Frequency", "Hz", "1"], amplitude: ["Amplitude", "g", "0.3"], duration: ["Duration", "s", "10"],
  across: ["Amplitude along y", "g", "0.15"], phase: ["Phase along y", "°", "90"],
};
const slides = (key, ...more) => slider(key, NUMBERS[key][0], NUMBERS[key][1], ...more);

// What is asked of the machine: the words of the command line. Thrown is what is wrong in a field.
export function asked(motion = state.motion) {
  const found = { kind: motion.kind, text: "" };
  const typed = key => numeral(motion[key], key === "phase" ? "across.phase" : key, NUMBERS[key][0], { unit: NUMBERS[key][1], such: NUMBERS[key][2] });
  if (motion.kind === "harmonic") {
    found.text = `${typed("frequency")}Hz,${typed("amplitude")}g,${typed("duration")}s`;
    if (motion.both) found.across = `${motion.frequency}Hz,${typed("across")}g,${typed("phase")}deg`;
  } else if (motion.kind === "pulse") found.text = `${motion.shape},${typed("frequency")}Hz,${typed("amplitude")}g`;
  else if (motion.kind === "sample") found.text = motion.sample;
  else if (motion.kind === "record") {
    found.text = motion.record;
    if (motion.unit) found.unit = motion.unit;
    if (motion.columns) found.columns = motion.columns.replace(/"/g, "");
    if (motion.dt) found.dt = `${numeral(motion.dt, "dt", labels.dt, { unit: "s", such: "0.01" })}s`;
  } else found.text = motion.region;
  if (motion.component && ["record", "sample"].includes(motion.kind)) found.component = motion.component;
  if (motion.azimuth !== "") found.azimuth = `${numeral(motion.azimuth, "azimuth", labels.azimuth, { unit: "°", such: "30" })}deg`;
  if (motion.pga !== "") found.pga = `${numeral(motion.pga, "pga", labels.pga, { unit: "g", such: "0.3" })}g`;
  if (!motion.vertical) found.vertical = "off";
  return found;
}

export function words(motion = state.motion) {
  const turn = motion.azimuth === "" ? "" : ` at ${motion.azimuth}°`, size = motion.pga === "" ? "" : `, scaled to ${motion.pga} g`;
  const what = {
    harmonic: `sine ${motion.frequency} Hz, ${motion.amplitude} g, ${motion.duration} s`, pulse: `${motion.shape} ${motion.frequency} Hz, ${motion.amplitude} g`,
    sample: motion.sample, record: motion.name || "no record yet", synthetic: motion.region,
  }[motion.kind];
  return what + turn + size;
}

function set(changes, again = false) { own = !again; changeMotion(changes); own = false; }

// A slider with a number beside it that may go beyond its ends.
function slider(key, label, unit, low, high, step, logarithmic = false) {
  const given = Number(state.motion[key]);
  const to = logarithmic ? Math.log10 : one => one, from = logarithmic ? one => 10 ** one : one => one;
  const round = one => String(+one.toPrecision(3));
  const range = el("input", { type: "range", min: to(low), max: to(high), step, value: Number.isFinite(given) && given > 0 ? to(given) : to(low), "aria-label": `${label} slider`,
    oninput: event => { box.value = round(from(+event.target.value)); set({ [key]: box.value }); } });
  const box = el("input", { value: state.motion[key], inputmode: "decimal", "data-field": key === "phase" ? "across.phase" : key, "aria-label": `${label} [${unit}]`,
    oninput: event => { const now = Number(event.target.value); if (now > 0) range.value = to(now); set({ [key]: event.target.value.trim() }); } });
  return el("div", { class: "slider" }, el("span", {}, label), range, el("span", { class: "unit" }, box, el("small", {}, unit)));
}

function controls() {
  const m = state.motion;
  const frequency = slides("frequency", 0.1, 10, 0.01, true), amplitude = slides("amplitude", 0.01, 1.5, 0.01);
  if (m.kind === "harmonic") {
    return [frequency, amplitude, slides("duration", 1, 60, 0.5),
      el("label", { class: "check" }, el("input", { type: "checkbox", checked: m.both, onchange: event => set({ both: event.target.checked }, true) }), labels.across),
      m.both && slides("across", 0.01, 1.5, 0.01), m.both && slides("phase", 0, 360, 5)];
  }
  if (m.kind === "pulse") return [field("Shape", select(SHAPES.map(one => [one, one]), m.shape, shape => set({ shape }), { "data-field": "shape" })), frequency, amplitude];
  if (m.kind === "sample") {
    return [field("Record", select(samples.map(one => [one.name, one.name]), m.sample, sample => set({ sample }, true), { "data-field": "sample" })),
      el("p", { class: "hint" }, (samples.find(one => one.name === m.sample) || { about: "" }).about), component()];
  }
  if (m.kind === "record") return record(m);
  return [field("Region, magnitude, distance, seed", el("input", { value: m.region, "data-field": "synthetic", oninput: event => set({ region: event.target.value }) })),
    el("p", { class: "hint" }, "Such as greece,6.5Mw,20km,seed=3.")];
}
const component = () => field(`${labels.component} (number, label or azimuth; as recorded if empty)`,
  el("input", { value: state.motion.component, "data-field": "component", oninput: event => set({ component: event.target.value.trim() }) }));

function record(m) {
  const files = opener("record", take, { multiple: true });
  return [
    el("div", { class: "row" }, el("button", { type: "button", onclick: () => files.click() }, "Upload a record …"), files),
    el("p", { class: "hint" }, "Any of the known strong-motion formats, up to 32 MB; the format is found. Several files at once are one record: its components, or its StationXML. Or drop files here."),
    records.all().length > 0 && field("Uploaded", select([["", "choose"], ...records.all().map(one => [one.id, one.name])], m.record, choose, { "data-field": "record" })),
    m.record && el("div", { class: "row" },
      field(`${labels.unit}, where the file states none`, select(UNITS.map(one => [one, one || "as stated"]), m.unit, unit => set({ unit }), { "data-field": "unit" })),
      field(`${labels.dt} [s], without times`, el("input", { value: m.dt, inputmode: "decimal", "data-field": "dt", oninput: event => set({ dt: event.target.value.trim() }) }))),
    m.record && field(`${labels.columns} of a text file, without a header such as time_s,ax_g`, el("input", { value: m.columns, placeholder: "such as t [s], x [g], -, z [g]", "data-field": "columns", oninput: event => set({ columns: event.target.value.trim() }) })),
    m.record && component(),
    m.record && el("button", { type: "button", class: "quiet", onclick: forget }, "Forget this record"),
  ];
}

// Files that come together are one record: its components, or what describes its station.
export async function take(files) {
  const [one] = await records.take(files, true);
  if (one) set({ kind: "record", record: one.id, name: one.name, unit: "", dt: "", columns: "", component: "" }, true);
}
function choose(id) {
  const one = records.all().find(other => other.id === id);
  set({ record: id, name: one ? one.name : "", unit: "", dt: "", columns: "", component: "" }, true);
}
async function forget() {
  await records.forget(state.motion.record);
  set({ record: "", name: "" }, true);
}

function render() {
  const m = state.motion;
  const canvas = el("canvas", {}), azimuth = el("input", { value: m.azimuth, inputmode: "decimal", "data-field": "azimuth", oninput: event => { const given = event.target.value.trim(); turner.show(given); set({ azimuth: given }); } });
  const left = el("div", { class: "card", "data-errors": true }, choice("kind", "What shakes", kinds(), m.kind, kind => set({ kind }, true)), el("fieldset", {}, controls()));
  left.ondragover = event => { event.preventDefault(); left.classList.add("drop"); };
  left.ondragleave = () => left.classList.remove("drop");
  left.ondrop = event => { event.preventDefault(); left.classList.remove("drop"); take([...event.dataTransfer.files]); };
  redraw(panel,
    el("h1", {}, "Motion"), el("p", { class: "lead" }, "What shakes the base: along x in the plane; in space along y and upward too."),
    el("div", { class: "sheet left" },
      el("div", {}, left,
        el("div", { class: "card" }, el("h2", {}, "Direction and size"),
          el("div", { class: "dial" }, canvas, el("div", {}, field(`${labels.azimuth}, from x towards y [°]`, azimuth),
            el("button", { type: "button", class: "quiet", onclick: () => { azimuth.value = ""; turner.show(""); set({ azimuth: "" }); } }, "As it is"))),
          el("div", { class: "row" },
            field(`${labels.pga} [g]`, el("input", { value: m.pga, inputmode: "decimal", placeholder: "as it is", "data-field": "pga", oninput: event => set({ pga: event.target.value.trim() }) })),
            el("label", { class: "check" }, el("input", { type: "checkbox", checked: m.vertical, onchange: event => set({ vertical: event.target.checked }) }), labels.vertical)))),
      el("div", {},
        el("div", { class: "card" }, el("h2", { id: "motion-name" }, words()), el("canvas", { class: "plot", role: "img", "aria-label": "Acceleration of the ground over time" })),
        el("div", { class: "card", id: "motion-facts", "aria-live": "polite" }),
        el("div", { class: "row" }, el("button", { type: "button", class: "primary", onclick: () => change({ tab: "run" }, { record: true }) }, "Next: run →")))));
  turner = dial(canvas, angle => { azimuth.value = String(angle); set({ azimuth: String(angle) }); });
  paint();
}

const ask = latest(async () => {
  try { return await question("/api/motion", { motion: asked(), column: state.column }); } catch (error) { return error; }
});
const check = later(async () => {
  find("#motion-name", panel).textContent = words();
  if (state.motion.kind === "record" && !state.motion.record) { shown = null; mark(panel, null); fill(find("#motion-facts", panel), el("p", { class: "empty" }, "Upload a record to see it here.")); paint(); return; }
  const found = await ask();
  if (!found) return;
  if (found instanceof Error) { shown = null; mark(panel, { error: records.named(found.error), field: found.field }); fill(find("#motion-facts", panel), el("p", { class: "hint" }, "No motion yet.")); paint(); return; }
  shown = found;
  mark(panel, null);
  fill(find("#motion-facts", panel), measures(found), warnings(found.warnings.map(records.named)));
  paint();
}, 120);

function paint() {
  const canvas = panel && find("canvas.plot", panel);
  if (!canvas || !canvas.clientWidth) return;
  turner.show(state.motion.azimuth, shown ? shown.path : null);
  const looks = { x: [INK, []], y: [BLUE, [5, 3]], z: [GREY, [2, 2]] };
  const lines = shown ? Object.entries(shown.lines) : [];
  plot(canvas, lines.reverse().map(([axis, [x, y]]) => ({ x, y, label: lines.length > 1 ? axis : "", color: looks[axis][0], dash: looks[axis][1], width: 1 })),
    { xLabel: "time [s]", yLabel: "acceleration [g]" });
}

function measures({ summary: s, relative: r }) {
  const each = (key, unit) => s.components.map(axis => `${s.components.length > 1 ? axis + " " : ""}${number(s[key][axis])}`).join(", ") + ` ${unit}`;
  return facts([
    s.format && ["format found", s.format], s.unit && ["unit", s.unit], s.station && ["station", [s.station, s.station_name].filter(Boolean).join(", ")], s.event && ["event", s.event],
    ["steps", `${s.steps} of ${number(s.dt_s)} s, ${number(s.duration_s, 4)} s`], ["peak acceleration", each("pga_g", "g")], ["peak velocity", each("pgv_m_s", "m/s")],
    ["peak displacement", each("pgd_m", "m")], ["Arias intensity", each("arias_m_s", "m/s")], ["duration 5–95 %", each("duration_5_95_s", "s")],
    s.pulse_period_s && ["strongest pulse", `${number(s.pulse_period_s)} s, ${number(s.pulse_amplitude_g)} g`],
    r && ["peak over g tan α", number(r.pga_over_g_tan_alpha)], r && r.omega_g_over_p && ["frequency over p", number(r.omega_g_over_p)],
    s.terms && ["terms", s.terms],
  ]);
}
