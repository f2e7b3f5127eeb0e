// The page: what is chosen goes to the workers, what they compute is shown.

const $ = (id) => document.getElementById(id);
const SHOWN = 2.5; // after a verdict [s]
const MAP_COLUMNS = 12, MAP_ROWS = 10;
const state = { film: null, id: 0, mapId: 0, playing: true, speed: 1, maps: {} };

if (!window.missing) start();

async function start() {
  const data = JSON.parse($("data").textContent);
  const packed = Uint8Array.from(atob($("blob").textContent.trim()), (item) => item.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const blob = await new Response(stream).arrayBuffer();
  const numbers = (place) => place && new Float64Array(blob, place[0], place[1] / 8);
  for (const [name, place] of Object.entries(data.images)) data.images[name] = new Uint8Array(blob, ...place);
  for (const shape of Object.values(data.shapes)) shape.samples = numbers(shape.samples);
  for (const item of data.earthquakes) [item.x, item.z] = [numbers(item.x), numbers(item.z)];
  const module = await WebAssembly.compile(new Uint8Array(blob, ...data.module));
  const source = URL.createObjectURL(new Blob([$("worker").textContent], { type: "text/javascript" }));
  Object.assign(state, { data, stage: new Stage($("stage")), trace: new Trace($("trace")), map: new Verdicts($("map"), chooseCell) });
  for (const name of ["filmer", "mapper"]) {
    state[name] = new Worker(source);
    state[name].postMessage({ module, data });
  }
  state.filmer.onmessage = ({ data: message }) => message.id === state.id && (message.kind === "failed" ? failed(message) : filmed(message));
  state.mapper.onmessage = ({ data: message }) => message.id === state.mapId && (message.kind === "failed" ? mapFailed(message) : mapped(message));
  state.map.describe = sayCell;
  form();
  state.opening = true;
  shake();
  requestAnimationFrame(tick);
  document.documentElement.dataset.ready = "";
}

// -- what is chosen -------------------------------------------------------------------------------------------------

// A frequency by the place of its slider, which is even in its logarithm; in hundredths, as commands take it.
const frequencyAt = (place) => {
  const [low, high] = state.data.frequencies;
  return Math.round(100 * low * (high / low) ** (place / 200)) / 100;
};
const placeOf = (frequency) => {
  const [low, high] = state.data.frequencies;
  return Math.round((200 * Math.log(frequency / low)) / Math.log(high / low));
};

function form() {
  const { data } = state;
  for (const column of data.columns) {
    const label = document.createElement("label"), input = document.createElement("input"), face = document.createElement("span");
    Object.assign(input, { type: "radio", name: "column", value: column.name, checked: column === data.columns[0] });
    face.innerHTML = `${picture(column)}<b></b><small></small>`;
    face.querySelector("b").textContent = column.title;
    face.querySelector("small").textContent = `${column.height.toFixed(column.height < 10 ? 1 : 0)} m, ${Math.round(column.tonnes)} t`;
    label.append(input, face);
    $("columns").append(label);
  }
  for (const item of data.earthquakes) {
    $("earthquake").append(new Option(item.title, item.name));
    const line = document.createElement("li");
    line.textContent = `${item.about}. ${item.terms[0].toUpperCase()}${item.terms.slice(1)}.`;
    $("sources").append(line);
  }
  const [low, high] = data.amplitudes;
  Object.assign($("amplitude"), { min: low, max: high, step: 0.01, value: 1 });
  Object.assign($("frequency"), { min: 0, max: 200, step: 1, value: placeOf(0.6) });
  for (let k = 0; k < LANES; k++) $("sixteen").append(document.createElement("li"));
  $("choose").addEventListener("input", () => shake());
  $("choose").addEventListener("submit", (event) => {
    event.preventDefault();
    shake();
    showStage();
  });
  $("play").addEventListener("click", () => play(!state.playing));
  $("time").addEventListener("input", () => {
    play(false);
    state.film.time = +$("time").value;
  });
  $("speed").addEventListener("change", () => (state.speed = +$("speed").value));
  $("copy").addEventListener("click", async () => {
    await navigator.clipboard?.writeText($("command").textContent);
    $("copy").textContent = "Copied";
  });
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) play(false);
}

function picture(column) {
  const scale = 60 / column.height;
  let z = 60, drawn = "";
  for (const [bottom, top, height] of column.shapes[0]) {
    const [b, t, h] = [bottom * scale, top * scale, height * scale];
    drawn += `<path d="M${-b / 2} ${z}h${b}L${t / 2} ${z - h}h${-t}z"/>`;
    z -= h;
  }
  return `<svg viewBox="-15 0 30 60" aria-hidden="true" fill="#cbbb9b" stroke="#6d5f48" stroke-width=".5">${drawn}</svg>`;
}

function choice() {
  const fields = new FormData($("choose"));
  const kind = fields.get("kind"), amplitude = Math.round(100 * +$("amplitude").value) / 100;
  const motion = kind === "earthquake" ? { kind, amplitude, name: $("earthquake").value } : { kind, amplitude, frequency: frequencyAt(+$("frequency").value) };
  return { column: state.data.columns.find((item) => item.name === fields.get("column")), motion };
}

function command({ column, motion }) {
  const a = `${motion.amplitude}g`, { shapes, strong_part } = state.data;
  const shaken = {
    sine: () => `--harmonic "${motion.frequency}Hz,${a},${shapes.sine.length}s"`,
    pulse: () => `--pulse "sine,${motion.frequency}Hz,${a},${shapes.pulse.length}s"`,
    earthquake: () => `--motion sample:${motion.name} --condition ${strong_part} --pga ${a} --whole`,
  }[motion.kind]();
  return `stylobate run ${column.name} --model dem2d ${shaken}`;
}

function shake() {
  const what = choice(), { motion, column } = what, { data } = state;
  $("frequency-row").hidden = motion.kind === "earthquake";
  $("earthquake-row").hidden = motion.kind !== "earthquake";
  $("frequency-text").textContent = motion.frequency ? pace(motion) : "";
  $("amplitude-text").textContent = strength(motion);
  for (const name of ["frequency", "amplitude"]) $(name).setAttribute("aria-valuetext", $(`${name}-text`).textContent);
  $("command").textContent = command(what);
  $("copy").textContent = "Copy";
  const full = motionOf(data, motion);
  state.film = {
    ...what, full, times: [], poses: [], verdicts: new Array(LANES).fill(null), fell: new Array(LANES).fill(Infinity),
    dust: Array.from({ length: LANES }, () => []), grounded: new Set(), over: false, began: performance.now(),
    time: 0, length: full.facts.sample * (full.x.length - 1),
  };
  state.filmer.postMessage({ kind: "film", id: ++state.id, column: column.name, request: motion, shown: SHOWN });
  [...$("sixteen").children].forEach((item) => (item.className = ""));
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
  say();
  const key = `${column.name} ${motion.kind}`;
  if (state.mapKey !== key) {
    state.mapKey = key;
    beginMap(what);
  }
  markMap(motion);
}

// What is chosen may be far below the film, on a phone.
const showStage = () => $("stage-frame").scrollIntoView({ block: "nearest" });

function strength({ amplitude, name }) {
  const record = state.data.earthquakes.find((item) => item.name === name);
  return `${amplitude.toFixed(2)} g${record ? ` (recorded: ${(record.peak / state.data.g).toFixed(2)} g)` : ""}`;
}

function pace({ kind, frequency }) {
  const period = `${(1 / frequency).toFixed(frequency < 2 ? 1 : 2)} s`, hertz = `${frequency.toFixed(2)} Hz`;
  if (kind === "pulse") return `lasting ${period} (${hertz})`;
  return frequency >= 1 ? `${frequency.toFixed(2)} times a second` : `once in ${period} (${hertz})`;
}

// -- the film -------------------------------------------------------------------------------------------------------

function filmed(message) {
  const { film } = state;
  for (const item of message.verdicts) {
    film.verdicts[item.lane] = item;
    if (item.outcome === FELL) film.fell[item.lane] = item.time;
    $("sixteen").children[item.lane].className = item.outcome === FELL ? "fell" : item.outcome === 4 ? "none" : "stood";
  }
  message.times.forEach((time, k) => {
    film.times.push(time);
    film.poses.push(message.poses[k]);
    land(film, time, message.poses[k]);
  });
  film.over = message.over;
  if (film.over) {
    film.length = film.times.at(-1);
    if (!state.mapBegun) startMap();
  }
  if (message.verdicts.length || message.over) say();
}

// Dust where a stone of a column that has fallen reaches the ground.
function land(film, time, poses) {
  const { drums, shapes, height } = film.column;
  for (let lane = 0; lane < LANES; lane++) {
    if (time < film.fell[lane]) continue;
    for (let i = 0; i < drums; i++) {
      const key = lane * drums + i, size = shapes[lane][i];
      if (poses[4 * key + 1] < 0.3 * size[2] - (lane ? 0 : DROP * height) && !film.grounded.has(key)) {
        film.grounded.add(key);
        film.dust[lane].push({ time, x: poses[4 * key], size: 0.6 * size[0] });
      }
    }
  }
}

function failed({ reason }) {
  $("verdict-text").textContent = `The computation could not go on (${reason}); this is no verdict on the column.`;
}

function say() {
  const { film } = state, { column, verdicts } = film, own = verdicts[0];
  const others = verdicts.slice(1), known = others.filter(Boolean).length, fell = others.filter((item) => item && item.outcome === FELL).length;
  const sentence = own && state.data.outcomes[own.outcome][column.drums === 1 ? 1 : 0];
  const standing = { 0: "No joint opened.", 1: "It rocked, and nothing is shifted.", 2: column.drums === 1 ? "It is shifted for good." : "Some of its drums are shifted for good." };
  let first;
  if (!own) first = "Shaking …";
  else if (own.outcome === FELL) first = `<b class="fell">${column.subject} falls after ${own.time.toFixed(1)} seconds.</b>`;
  else if (own.outcome === 4) first = `<b>${sentence}</b>`;
  else first = `<b class="stood">${column.subject} stands.</b> ${standing[own.outcome]}`;
  if (own && !own.decided && own.outcome !== 4) first += " It still rocks: this could change.";
  let rest = `Of fifteen like it, ${fell} ${fell === 1 ? "falls" : "fall"}.`;
  if (known < 15) rest = known || own ? `Of fifteen like it, ${fell} ${fell === 1 ? "has" : "have"} fallen so far.` : "";
  else if (fell === 0) rest = "None of fifteen like it falls.";
  else if (fell === 15) rest = own && own.outcome === FELL ? "So do all fifteen like it." : "All fifteen like it fall.";
  $("verdict-text").innerHTML = `${first} ${rest}`;
  $("verdict-text").dataset.over = film.over;
  $("verdict-text").dataset.own = own ? own.outcome : "";
}

function play(on) {
  state.playing = on;
  $("play").textContent = on ? "Pause" : "Play";
  if (on && state.film && state.film.over && state.film.time >= state.film.length - 1e-9) state.film.time = 0;
}

let before = 0;
function tick(now) {
  const { film } = state, passed = Math.min(0.1, (now - before) / 1000);
  before = now;
  requestAnimationFrame(tick);
  if (!film || !film.times.length) return;
  const computed = film.times.at(-1);
  if (state.opening) open(film, computed);
  else if (state.playing) {
    film.time = Math.min(computed, film.time + passed * state.speed);
    if (film.over && film.time >= computed) play(false);
  }
  let index = Math.min(film.times.length - 1, Math.max(0, Math.floor((film.time / computed) * (film.times.length - 1)) || 0));
  while (index + 1 < film.times.length && film.times[index + 1] <= film.time) index++;
  while (index > 0 && film.times[index] > film.time) index--;
  state.stage.draw(film.column, film.poses[index], film.times[index], film.fell.map((time) => film.times[index] >= time), film.dust);
  const length = film.over ? film.length : Math.max(film.length, computed);
  state.trace.draw(film.full, length, computed, film.time, state.data.g);
  $("clock").textContent = `${film.time.toFixed(1)} s`;
  if (document.activeElement !== $("time") || state.playing) Object.assign($("time"), { max: length, value: film.time });
  $("time").setAttribute("aria-valuetext", `${film.time.toFixed(1)} s`);
}

// The first film is joined just before the first column falls, as soon as that is known.
function open(film, computed) {
  const first = Math.min(...film.fell);
  if (first < Infinity) film.time = Math.max(0, first - 0.5);
  else if (!film.over && performance.now() - film.began < 1500) return;
  state.opening = computed < film.time;
}

// -- the map --------------------------------------------------------------------------------------------------------

function beginMap({ motion }) {
  const { data, map } = state, [low, high] = data.amplitudes;
  const up = Array.from({ length: MAP_ROWS }, (_, j) => Math.round((100 * high * (j + 1)) / MAP_ROWS) / 100).filter((item) => item >= low);
  let across, labels;
  if (motion.kind === "earthquake") {
    across = data.earthquakes.map((item) => item.name);
    labels = { ticks: data.earthquakes.map((item) => item.title.match(/\d+/)[0]), title: "the earthquakes, by year" };
  } else {
    across = Array.from({ length: MAP_COLUMNS }, (_, i) => frequencyAt((200 * i) / (MAP_COLUMNS - 1)));
    labels = { ticks: across.map((item, i) => (i % 3 === 0 || i === MAP_COLUMNS - 1 ? `${+item.toFixed(item < 1 ? 2 : 1)}` : "")), title: "how fast: times a second (Hz)" };
  }
  map.begin(across, up, labels, state.maps[state.mapKey]); // what is known of it stays known
  state.maps[state.mapKey] = map.cells;
  state.mapKind = motion.kind;
  // from coarse to fine, so that the picture is there before all of it is
  const order = (k, bits) => [...Array(bits).keys()].reduce((sum, bit) => sum + (((k >> bit) & 1) << (bits - 1 - bit)), 0);
  const cells = [];
  for (let j = 0; j < up.length; j++) for (let i = 0; i < across.length; i++) if (map.of(i, j) === null) cells.push({ i, j });
  cells.sort((a, b) => order(a.i, 4) + order(a.j, 4) - order(b.i, 4) - order(b.j, 4) || order(a.i, 4) - order(b.i, 4));
  state.mapCells = cells.map(({ i, j }) => ({ i, j, ...cellMotion(i, j) }));
  state.mapBegun = false;
  state.mapper.postMessage({ id: ++state.mapId });
  sayMap();
}

function cellMotion(i, j) {
  const { map, mapKind: kind } = state, amplitude = map.up[j];
  return kind === "earthquake" ? { kind, amplitude, name: map.across[i] } : { kind, amplitude, frequency: map.across[i] };
}

// The film goes first; then the map is filled.
function startMap() {
  state.mapBegun = true;
  state.mapper.postMessage({ kind: "map", id: ++state.mapId, column: state.film.column.name, cells: state.mapCells });
}

function mapped(message) {
  const { map } = state;
  if (message.kind === "cell") {
    const { i, j } = state.mapCells[message.cell];
    map.set(i, j, message.outcome);
  }
  sayMap();
}

function sayMap() {
  const { map } = state;
  const { length } = map.cells, known = map.cells.filter((item) => item !== null).length;
  const waits = state.mapBegun ? `${known} of ${length} computed …` : "These are computed next.";
  $("map-text").textContent = known < length ? waits : summary();
  $("map").dataset.over = known === length;
}

function mapFailed({ reason }) {
  $("map-text").textContent = `The computation could not go on (${reason}).`;
}

// Cells are stored row by row, the weakest first, and in each the slowest first.
function summary() {
  const { map } = state, fell = map.cells.filter((item) => item === FELL).length, weakest = map.cells.indexOf(FELL);
  if (!fell) return "None of these brings it down.";
  const records = new Map(state.data.earthquakes.map((item) => [item.name, item.peak / state.data.g]));
  const stronger = map.cells.every((item, k) => item !== FELL || map.up[Math.floor(k / map.across.length)] > records.get(map.across[k % map.across.length]));
  return `${fell} of ${map.cells.length} bring it down; the weakest: ${cellName(weakest % map.across.length, Math.floor(weakest / map.across.length))}.${stronger ? " All of these are stronger than what was recorded." : ""} Choose a square to see it happen.`;
}

function cellName(i, j) {
  const motion = cellMotion(i, j);
  return `${motion.amplitude} g, ${motion.name ? state.data.earthquakes[i].title : pace(motion)}`;
}

function markMap(motion) {
  const { map } = state, near = (list, value) => list.reduce((best, item, k) => (Math.abs(item - value) < Math.abs(list[best] - value) ? k : best), 0);
  const i = motion.kind === "earthquake" ? map.across.indexOf(motion.name) : near(map.across.map(Math.log), Math.log(motion.frequency));
  map.mark = map.at = [i, near(map.up, motion.amplitude)];
  map.draw();
}

function sayCell(i, j) {
  const outcome = state.map.of(i, j);
  $("map-text").textContent = `${cellName(i, j)}: ${outcome === null ? "not yet computed" : outcome === FELL ? "falls" : outcome === 4 ? "no verdict" : "stands"}`;
}

function chooseCell(i, j) {
  const { amplitude, name, frequency } = cellMotion(i, j);
  $("amplitude").value = amplitude;
  if (name) $("earthquake").value = name;
  else $("frequency").value = placeOf(frequency);
  shake();
  showStage();
}
