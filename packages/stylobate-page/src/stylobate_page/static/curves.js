// Curves of analyses: intensity over response, probability over intensity, and what each amplitude did.

import { get, latest as last } from "./api.js";
import { el, fill, later } from "./dom.js";
import { BAND, BLUE, GREY, INK, plot, RED } from "./plot.js";

const LOOKS = { 16: [INK, [2, 3]], 50: [RED, []], 84: [INK, [7, 4]] };
const DOTS = { stands: ["o", INK], collapsed: ["x", RED], undecided: ["s", GREY], failed: ["s", BLUE] };
let shown = [];

addEventListener("resize", later(() => redraw(), 60));
export function redraw() { shown = shown.filter(one => one.canvas.isConnected); for (const one of shown) if (one.canvas.clientWidth) one.draw(); }

const latest = last(job => get(`/api/jobs/${job}/curves`));

// Fills a place with the figures of a job.
export async function show(place, job) {
  const found = await latest(job);
  if (!found) return;
  const parts = [["fragility", "Fragility curve with its band", fragility], ["growing", "Shares of the records so far", fragility], ["ida", "Incremental dynamic analysis: intensity over response", ida], ["critical", "What each amplitude did", critical]]
    .filter(([name]) => found[name]).map(([name, label, draw]) => {
      const canvas = el("canvas", { class: "plot curves", role: "img", "aria-label": label, "data-curves": name });
      shown.push({ canvas, draw: () => draw(canvas, found[name]) });
      return el("div", { class: "card" }, el("h2", {}, label), canvas);
    });
  fill(place, parts);
  redraw();
}

function ida(canvas, { records, shares, right, moves, words }) {
  plot(canvas, [
    ...records.map((one, k) => ({ x: one.x, y: one.y, color: "#9a9a9a", width: 0.8, label: k ? "" : "one record" })),
    ...Object.entries(shares).map(([share, one]) => ({ ...one, color: LOOKS[share][0], dash: LOOKS[share][1], width: 1.9, label: `${share} % of the records` })),
  ], { xLabel: `${moves}, collapse →`, yLabel: words, xRange: [0, right] });
}

function fragility(canvas, { curve, points, median, state, words }) {
  const [low, high] = median, { im = [], probability = [] } = curve;
  plot(canvas, [
    ...(im.length ? [{ x: im, y: curve.low, to: curve.high, color: BAND, label: "95 % band" }] : []),
    ...points.map(([at, , from, to]) => ({ x: [at, at], y: [from, to], color: "#9a9a9a", width: 1 })),
    { x: im, y: probability, color: RED, width: 1.9, label: "lognormal" },
    { x: points.map(one => one[0]), y: points.map(one => one[1]), color: INK, dots: "o", label: "records, 95 %" },
    ...(low !== null && high !== null ? [{ x: [low, high], y: [0.5, 0.5], color: BLUE, width: 2.5, label: "median, 95 %" }] : []),
  ], { xLabel: words, yLabel: `probability of ${state}`, xRange: [0, im.length ? im[im.length - 1] : 1.1 * Math.max(...points.map(one => one[0]), 1e-9)], low: -0.03, high: 1.05 });
}

function critical(canvas, rows) {
  const most = Math.max(...rows.filter(one => one[2] === "stands" || one[2] === "undecided").map(one => Math.abs(one[1] || 0)), 1e-3), top = 1.25 * most;
  const series = Object.entries(DOTS).map(([verdict, [dots, color]]) => {
    const found = rows.filter(one => one[2] === verdict);
    return { x: found.map(one => one[0]), y: found.map(one => verdict === "collapsed" ? top : Math.abs(one[1] || 0)), color, dots, label: `${verdict} (${found.length})` };
  }).filter(one => one.x.length);
  const ends = rows.map(one => one[0]), room = 0.04 * (Math.max(...ends) - Math.min(...ends) || 0.1);
  plot(canvas, series, { xLabel: "amplitude [g]", yLabel: "peak displacement [m], collapse on top", xRange: [Math.min(...ends) - room, Math.max(...ends) + room], high: 1.1 * top });
}
