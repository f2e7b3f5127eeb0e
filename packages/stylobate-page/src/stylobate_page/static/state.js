// What the page holds, and the address that holds it too: #tab=run&job=…&s=…, the rest of it as base64.

const START = {
  tab: "column", column: null, assembly: "", preset: "paper-12-drums", job: "", domainJob: "", fragilityJob: "", analysisJob: "", ruin: "",
  motion: {
    kind: "harmonic", frequency: "1", amplitude: "0.3", duration: "10", both: false, across: "0.15", phase: "90",
    shape: "ricker", region: "greece,6.5Mw,20km,seed=1", sample: "el-centro-1940", record: "", name: "",
    unit: "", dt: "", columns: "", component: "", azimuth: "", pga: "", vertical: true,
  },
  model: "dem2d", replicates: "", tail: "", settings: {},
  domain: { f0: "0.33", f1: "4", fn: "12", a0: "0.05", a1: "0.6", an: "16", duration: "10" },
  fragility: { records: [], unit: "", columns: "", im: "pgv", runs: "8", state: "collapse" },
  analysis: { kind: "directions", values: {}, records: [], source: "" },
  critical: { first: "0.05", last: "1", step: "0.05" },
};
// Jobs that parts of the page show; and all that the address names.
export const SHOWN = ["job", "domainJob", "fragilityJob", "analysisJob"];
const ADDRESSED = ["tab", ...SHOWN];

// Texts of files stay out of the address: hazard curves by name, and a table of runs.
export const state = { ...structuredClone(START), hazards: {}, table: null };
// What stands, in words: a preset that was changed is told from what it was.
let presets = {};
// Measures that are shown of a run: key in its results, label and unit.
export let declared = [];
export const known = about => { ({ presets, measures: declared } = about); };
export function called() {
  const { name = "column" } = state.column || {};
  return state.assembly ? "the assembly" : `${name}${presets[name] && JSON.stringify(presets[name]) !== JSON.stringify(state.column) ? ", changed" : ""}`;
}

const listeners = [];
export const listen = hear => { listeners.push(hear); };

// Change some of it; every listener hears which keys.
export function change(changes, { record = false } = {}) {
  const keys = Object.keys(changes).filter(key => changes[key] !== state[key]);
  if (!keys.length) return;
  Object.assign(state, changes);
  write(record);
  for (const hear of listeners) hear(new Set(keys));
}
export const changeMotion = changes => change({ motion: { ...state.motion, ...changes } });

const encode = text => btoa(String.fromCharCode(...new TextEncoder().encode(text))).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
const decode = text => new TextDecoder().decode(Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), c => c.charCodeAt(0)));

function address() {
  const rest = {};
  for (const key of Object.keys(START)) {
    if (ADDRESSED.includes(key) || (key === "column" && state.preset)) continue;
    if (JSON.stringify(state[key]) !== JSON.stringify(START[key])) rest[key] = state[key];
  }
  const parts = ADDRESSED.filter(key => state[key]).map(key => `${key}=${encodeURIComponent(state[key])}`);
  if (Object.keys(rest).length) parts.push("s=" + encode(JSON.stringify(rest)));
  return "#" + parts.join("&");
}

let timer = 0;
function write(record) {
  clearTimeout(timer);
  if (record) { history.pushState(null, "", address()); return; }
  timer = setTimeout(() => { if (location.hash !== address()) history.replaceState(null, "", address()); }, 150);
}

// Read the address; what it does not hold stays as it is at the start.
export function read() {
  const given = new URLSearchParams(location.hash.slice(1));
  const found = structuredClone(START);
  for (const key of ADDRESSED) if (given.has(key)) found[key] = given.get(key);
  try {
    const rest = given.has("s") ? JSON.parse(decode(given.get("s"))) : {};
    for (const key of Object.keys(START)) {
      if (!(key in rest) || ADDRESSED.includes(key)) continue;
      const plain = START[key] !== null && typeof START[key] === "object" && !Array.isArray(START[key]);
      found[key] = plain && key !== "settings" ? { ...START[key], ...rest[key] } : rest[key];
    }
  } catch { /* an address that was cut off: the start */ }
  const { column } = found;
  if (column !== null && !(Array.isArray(column.drum) && column.joint)) Object.assign(found, { column: null, preset: START.preset });  // no column
  return found;
}

// A link to another part keeps everything else: only the tab of the address is taken.
export function followAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  if (given.has("tab") && !given.has("s") && [...given.keys()].length === 1) {
    change({ tab: given.get("tab") });
    history.replaceState(null, "", address());
    return;
  }
  const found = read();
  change(found.preset ? { ...found, column: null } : found);
}
