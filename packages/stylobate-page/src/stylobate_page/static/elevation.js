// The column as it stands, with its height, widths, joints and what is not as built.

import { number } from "./dom.js";
import { BLUE, BROWN, INK, RED, SAND, sharp } from "./plot.js";

// Draws the elevation; returns a function that tells which drum (from 1) lies at a point of the canvas, 0 for none.
export function drawElevation(canvas, found, { chosen = 0, faulty = 0 } = {}) {
  const [c, width, height] = sharp(canvas);
  const views = Object.entries(found.outlines), part = width / views.length, placed = [];
  views.forEach(([name, outlines], place) => {
    const points = outlines.flat(), links = (found.links || {})[name] || [], xs = [...points, ...links.flat()].map(p => p[0]), zs = points.map(p => p[1]);
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...zs, 0), Math.max(...zs)];
    const room = { left: 74, right: 96, top: 30, bottom: 58 };
    const scale = Math.min((part - room.left - room.right) / (right - left), (height - room.top - room.bottom) / (high - low));
    const x0 = place * part + room.left + (part - room.left - room.right) / 2, middle = 0.5 * (left + right);
    const across = x => x0 + (x - middle) * scale, up = z => height - room.bottom - (z - low) * scale;
    ground(c, across, up, found, left, right, scale);
    c.lineJoin = "round";
    outlines.forEach((corners, i) => {
      c.beginPath(); corners.forEach(([x, z]) => c.lineTo(across(x), up(z))); c.closePath();
      c.fillStyle = i + 1 === faulty ? "#f6d5cf" : i + 1 === chosen ? "#dcc89d" : SAND;
      c.strokeStyle = i + 1 === faulty ? RED : BROWN; c.lineWidth = i + 1 === chosen ? 2 : 1.1;
      c.fill(); c.stroke();
      placed.push([i + 1, corners.map(([x, z]) => [across(x), up(z)])]);
    });
    c.strokeStyle = BLUE; c.lineWidth = 2.2;
    for (const [[a, b], [x, z]] of links) line(c, across(a), up(b), across(x), up(z));
    dimensions(c, outlines, across, up, left, right, low, high);
    labels(c, outlines, found, place ? {} : found.table, across, up, right, (place + 1) * part - 4);
    if (views.length > 1) { c.fillStyle = INK; c.textAlign = "center"; c.textBaseline = "alphabetic"; c.fillText(`seen along ${name === "xz" ? "y" : "x"}`, x0, height - 6); }
  });
  return ([x, y]) => (placed.find(([, corners]) => inside(corners, x, y)) || [0])[0];
}

function ground(c, across, up, found, left, right, scale) {
  const from = left - 40 / scale, to = right + 40 / scale, slope = found.slope;
  c.strokeStyle = INK; c.lineWidth = 1.6; c.beginPath(); c.moveTo(across(from), up(slope * from)); c.lineTo(across(to), up(slope * to)); c.stroke();
  c.lineWidth = 0.7; c.strokeStyle = "#8f8877";
  for (let x = from; x < to; x += 8 / scale) {
    c.beginPath(); c.moveTo(across(x), up(slope * x)); c.lineTo(across(x) - 6, up(slope * x) + 7); c.stroke();
  }
}

// Height at the left, widths of the lowest and the topmost face below and above.
function dimensions(c, outlines, across, up, left, right, low, high) {
  const x = across(left) - 26;
  c.strokeStyle = c.fillStyle = INK; c.lineWidth = 0.8;
  line(c, x, up(low), x, up(high)); tick(c, x, up(low)); tick(c, x, up(high));
  c.save(); c.translate(x - 9, (up(low) + up(high)) / 2); c.rotate(-Math.PI / 2); c.textAlign = "center"; c.textBaseline = "middle";
  c.fillText(number(high - low, 4) + " m", 0, 0); c.restore();
  const ends = corners => { const xs = corners.map(p => p[0]); return [Math.min(...xs), Math.max(...xs)]; };
  const foot = ends(outlines[0]), head = outlines[outlines.length - 1], most = Math.max(...head.map(p => p[1]));
  const cap = ends(head.filter(p => p[1] > most - 0.2 * (most - Math.min(...head.map(q => q[1])))));
  c.textAlign = "center";
  for (const [[a, b], y, base] of [[foot, up(low) + 24, "top"], [cap, up(high) - 10, "bottom"]]) {
    line(c, across(a), y, across(b), y); tick(c, across(a), y); tick(c, across(b), y);
    c.textBaseline = base; c.fillText(number(b - a, 4) + " m", across(0.5 * (a + b)), y + (base === "top" ? 5 : -4));
  }
}

const CHIPS = ["chip_left", "chip_right", "chip_front", "chip_back"];

// Numbers of drums at the right, with what is found at them.
function labels(c, outlines, found, table, across, up, right, edge) {
  const about = new Map(((table.as_found || {}).drum || []).map(one => [one.index, one]));
  const laws = new Map((table.joint_override || []).map(one => [one.index, one]));
  const linked = new Map();
  const mention = (drum, link) => linked.set(drum, [...new Set([...(linked.get(drum) || []), link.kind])]);
  for (const link of table.link || []) {
    if (link.joints) for (const joint of link.joints === "all" ? outlines.map((_, i) => i + 1) : link.joints) mention(joint, link);
    else mention(typeof link.joint === "number" ? link.joint : typeof link.to_drum === "number" ? link.to_drum : outlines.length, link);
  }
  c.textAlign = "left"; c.textBaseline = "middle";
  let last = Infinity;
  outlines.forEach((corners, i) => {
    const zs = corners.map(p => p[1]), y = up(0.5 * (Math.min(...zs) + Math.max(...zs)));
    const one = about.get(i + 1) || {};
    const notes = [one.offset ? `offset ${number(1000 * one.offset)} mm` : "", one.tilt ? `tilt ${number(one.tilt)}°` : "", one.turn ? `turned ${number(one.turn)}°` : "",
      CHIPS.some(key => one[key]) ? "chipped" : "", laws.has(i + 1) ? "own joint" : "", ...(linked.get(i + 1) || [])].filter(Boolean);
    if (last - y < 13 && !notes.length) return;
    c.fillStyle = notes.length ? "#8c1c13" : "#565149";
    c.fillText(`${i + 1}${notes.length ? "  " + notes.join(", ") : ""}`, across(right) + 14, y, Math.max(edge - across(right) - 14, 20));
    last = y;
  });
}

const line = (c, a, b, x, y) => { c.beginPath(); c.moveTo(a, b); c.lineTo(x, y); c.stroke(); };
const tick = (c, x, y) => line(c, x - 4, y + 4, x + 4, y - 4);

function inside(corners, x, y) {
  let odd = false;
  corners.forEach(([a, b], i) => {
    const [p, q] = corners[(i + 1) % corners.length];
    if ((b > y) !== (q > y) && x < (p - a) * (y - b) / (q - b) + a) odd = !odd;
  });
  return odd;
}
