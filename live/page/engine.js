// The module with the columns in its memory: copies what was packed, starts the functions, reads what they leave behind.
// Nothing of the mechanics is here. Used by the worker of the page, and by the tests.
"use strict";

const LANES = 16, RUNNING = 0, FELL = 3;

class Engine {
  constructor(module, data) {
    const { sin, cos, tan, atan, hypot } = Math;
    this.calls = new WebAssembly.Instance(module, { env: { sin, cos, tan, atan, hypot } }).exports;
    this.data = data;
    this.start = data.start;
  }

  // Put a column into the memory as it was packed: it in the first lane, those like it in the others.
  load(name) {
    this.column = this.data.columns.find((item) => item.name === name);
    this.layout = this.column.layout;
    const { memory } = this.calls, image = this.data.images[name];
    this.samples = Math.ceil((this.start + image.length) / 64) * 64;
    this._grow(this.samples);
    new Uint8Array(memory.buffer).set(image, this.start);
    this._views();
  }

  // Copy what stands in the first lane into another one: as packed, at rest.
  refill(lane) {
    const image = this.data.images[this.column.name];
    const words = new BigInt64Array(image.buffer, image.byteOffset, image.length >> 3);
    for (const [at, rows] of this.layout.striped)
      for (let row = 0, place = at >> 3; row < rows; row++, place += LANES) this.words[place + lane] = words[place];
    for (const [at, size] of this.layout.rows)
      this.bytes.set(image.subarray(at, at + size), at + lane * size);
  }

  // Write the samples of a motion behind the columns, into a slot of its own; gives what `begin` wants.
  place(motion, slot = 0, slots = 1) {
    const room = this.data.slot * 8, count = motion.x.length;
    const at = this.samples + slot * room * (slots > 1 ? 1 : 0);
    this._grow(slots > 1 ? this.samples + slots * room : at + 16 * count);
    const { buffer } = this.calls.memory;
    new Float64Array(buffer, at, count).set(motion.x);
    if (motion.z) new Float64Array(buffer, at + 8 * count, count).set(motion.z);
    return { x: at, z: motion.z ? at + 8 * count : 0, last: count - 1, ...motion.facts };
  }

  // Begin a run in a lane; it is shown for some time after its verdict [s].
  begin(lane, placed, shown) {
    this.numbers[(this.layout.kept.shown >> 3) + lane] = shown;
    const end = this.layout.lane >> 3;
    [lane, placed.x, placed.z, placed.last].forEach((item, k) => (this.words[end + k] = BigInt(item)));
    [placed.sample, placed.peak, placed.vertical].forEach((item, k) => (this.numbers[end + 4 + k] = item));
    this._call("begin");
  }

  // Let all lanes go on by some chunks of steps, whichever runs end on the way.
  advance(chunks) {
    const goal = this.now() + chunks * this.data.chunk;
    let rest = chunks;
    while (rest > 0) {
      this.words[this.layout.chunks >> 3] = BigInt(rest);
      this._call("advance");
      this._call("judge");
      if (!this.running()) break;
      rest = Math.round((goal - this.now()) / this.data.chunk);
    }
  }

  // Furthest step of the lanes whose runs go on.
  now() {
    let step = 0;
    for (let lane = 0; lane < LANES; lane++)
      if (this.read("watch", "status", lane) === RUNNING) step = Math.max(step, this.read("feed", "step", lane));
    return step;
  }

  running() {
    for (let lane = 0; lane < LANES; lane++) if (this.read("watch", "status", lane) === RUNNING) return true;
    return false;
  }

  // A whole number of a lane.
  read(record, field, lane) {
    return Number(this.words[(this.layout[record][field] >> 3) + lane]);
  }

  // A number of a lane.
  real(record, field, lane) {
    return this.numbers[(this.layout[record][field] >> 3) + lane];
  }

  // Verdict of a lane, null while there is none; the time at which its fall was certain [s].
  verdict(lane) {
    const outcome = this.read("kept", "outcome", lane);
    if (outcome < 0) return null;
    const when = this.read("watch", "when", lane);
    return {
      outcome,
      decided: this.read("kept", "decided", lane) === 1,
      time: outcome === FELL ? when * this.real("kept", "dt", lane) : null,
      joint: this.read("watch", "which", lane),
      side: this.read("watch", "side", lane),
    };
  }

  // Where all drums of all lanes are: x, z, cosine and sine of each, lane by lane.
  poses() {
    const { body } = this.layout, { drums } = this.column, result = new Float32Array(LANES * drums * 4);
    const fields = [body.x, body.z, body.c, body.s];
    for (let i = 0; i < drums; i++) {
      const row = (i + 1) * this.layout.size;
      for (let k = 0; k < 4; k++) {
        const place = (fields[k] + row) >> 3;
        for (let lane = 0; lane < LANES; lane++) result[(lane * drums + i) * 4 + k] = this.numbers[place + lane];
      }
    }
    return result;
  }

  _call(name) {
    const status = this.calls[name](this.start + this.layout.calls[name]);
    if (status !== 0) throw new Error(`${name} ended with ${status}`);
  }

  _grow(bytes) {
    const { memory } = this.calls, missing = bytes - memory.buffer.byteLength;
    if (missing > 0) {
      memory.grow(Math.ceil(missing / 65536));
      if (this.layout) this._views();
    }
  }

  _views() {
    const { buffer } = this.calls.memory, size = this.data.images[this.column.name].length;
    this.bytes = new Uint8Array(buffer, this.start, size);
    this.words = new BigInt64Array(buffer, this.start, size >> 3);
    this.numbers = new Float64Array(buffer, this.start, size >> 3);
  }
}

// Samples of what the page asks for: the shapes and earthquakes that were packed, as long and as strong as asked for.
function motionOf(data, request) {
  const level = request.amplitude * data.g;
  let unit, count, sample;
  if (request.kind === "earthquake") {
    unit = data.earthquakes.find((item) => item.name === request.name);
    ({ count, sample } = unit);
  } else {
    // in the order in which the package divides, to the last bit
    const shape = data.shapes[request.kind], steps = Math.round(shape.length * request.frequency * shape.cycle);
    unit = { x: shape.samples, repeats: shape.repeats };
    count = steps + 1;
    sample = shape.repeats ? shape.length / steps : 1 / request.frequency / shape.cycle;
  }
  const times = level / (unit.peak ?? 1);
  const x = scaled(unit.x, count, times, unit.repeats), z = unit.z ? scaled(unit.z, count, times) : null;
  return { x, z, facts: { sample, peak: peak(x), vertical: z ? peak(z) : 0 } };
}

function scaled(unit, count, times, repeats = false) {
  const result = new Float64Array(count);
  for (let k = 0; k < count; k++) {
    const place = repeats ? k % unit.length : k;
    if (place < unit.length) result[k] = times * unit[place];
  }
  return result;
}

function peak(samples) {
  let most = 0;
  for (const item of samples) most = Math.max(most, Math.abs(item));
  return most;
}
