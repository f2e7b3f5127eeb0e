// Runs the module of the page outside a browser: what it leaves in memory, the motions and verdicts, into the folder of the page.
import fs from "node:fs";
import vm from "node:vm";
import zlib from "node:zlib";

const folder = process.argv[2];
const page = fs.readFileSync(`${folder}/column.html`, "utf8");
const part = (id) => page.match(new RegExp(`<script type="[^"]*" id="${id}">([^]*?)</script>`))[1];
const data = JSON.parse(part("data"));
const packed = zlib.inflateSync(Buffer.from(part("blob"), "base64"));
const blob = packed.buffer.slice(packed.byteOffset, packed.byteOffset + packed.length);
const numbers = (place) => place && new Float64Array(blob, place[0], place[1] / 8);
for (const [name, place] of Object.entries(data.images)) data.images[name] = new Uint8Array(blob, ...place);
for (const shape of Object.values(data.shapes)) shape.samples = numbers(shape.samples);
for (const item of data.earthquakes) [item.x, item.z] = [numbers(item.x), numbers(item.z)];
const module = new WebAssembly.Module(new Uint8Array(blob, ...data.module));
const { Engine, motionOf } = vm.runInThisContext(`(() => { ${part("worker").replace("onmessage =", "const heard =")}; return { Engine, motionOf } })()`);

const engine = new Engine(module, data), results = [];
JSON.parse(fs.readFileSync(`${folder}/cases.json`)).forEach((item, number) => {
  engine.load(item.column);
  const motion = motionOf(data, item.request), placed = engine.place(motion);
  for (let lane = 0; lane < 16; lane++) engine.begin(lane, placed, item.shown);
  engine.advance(item.chunks);
  const { feed, striped } = engine.layout;
  for (const field of ["x", "z"]) engine.words.fill(0n, feed[field] >> 3, (feed[field] >> 3) + 16);
  fs.writeFileSync(`${folder}/${number}.wasm`, Buffer.concat(striped.map(([at, rows]) => Buffer.from(engine.bytes.slice(at, at + rows * 128)))));
  results.push({ verdicts: [...Array(16).keys()].map((lane) => engine.verdict(lane)), facts: motion.facts, count: motion.x.length });
});
// the first column in all lanes, item of them begun anew: all of them end alike
engine.load("paper-monolithic");
const placed = engine.place(motionOf(data, { kind: "pulse", frequency: 1, amplitude: 0.8 }), 3, 16);
for (let lane = 0; lane < 16; lane++) {
  engine.refill(lane);
  engine.begin(lane, placed, 0);
}
engine.advance(40);
engine.refill(5);
engine.begin(5, placed, 0);
while (engine.running()) engine.advance(64);
const refilled = [...Array(16).keys()].map((lane) => engine.verdict(lane));
const motions = [];
for (const request of JSON.parse(process.argv[3])) {
  const { x, z, facts } = motionOf(data, request);
  motions.push({ x: [...x], z: z && [...z], facts });
}
fs.writeFileSync(`${folder}/node.json`, JSON.stringify({ results, refilled, motions }));
