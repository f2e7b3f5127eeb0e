// Lines over time and other small figures, in the style of the printed ones.

export const INK = "#1a1a1a", RED = "#b2182b", BLUE = "#2166ac", GREY = "#767676", SAND = "#efe6d2", BROWN = "#8c6d3f", BAND = "#f0d0cf";
export const CYCLE = [[INK, []], [RED, [6, 3]], [BLUE, [7, 3, 1.5, 3]], ["#b35f00", [2, 2]], ["#2f7d3b", [8, 2, 2, 2, 2, 2]], [GREY, [10, 3]]];
export const FONT = '12px system-ui, "DejaVu Sans", sans-serif';

// The context of a canvas whose points are those of the page, however fine the screen is.
export function sharp(canvas) {
  const ratio = devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
  }
  const c = canvas.getContext("2d");
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, width, height);
  c.font = FONT; c.lineJoin = "round"; c.setLineDash([]);
  return [c, width, height];
}

// Round steps that divide a span into about so many parts.
export function ticks(low, high, parts) {
  const rough = (high - low) / parts || 1, decade = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].map(one => one * decade).find(one => one >= rough * 0.999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(+(k * step).toPrecision(12));
  return found;
}

export const said = value => Math.abs(value) >= 1e5 || (value && Math.abs(value) < 1e-3) ? value.toExponential(0) : String(+value.toPrecision(6));

// Curves with axes: series of { x, y, color, dash, label, width }; with "to" a band from y to there. Returns what the canvas shows, to draw a cursor later.
export function plot(canvas, series, { xLabel = "", yLabel = "", zero = true, low = null, high = null, xRange = null } = {}) {
  const [c, width, height] = sharp(canvas);
  const drawn = series.filter(one => one.y.length);
  let [bottom, top] = [Infinity, -Infinity];
  for (const one of drawn) for (const y of one.y) if (y !== null) { if (y < bottom) bottom = y; if (y > top) top = y; }
  if (!(bottom <= top)) [bottom, top] = [0, 1];
  if (zero) { bottom = Math.min(bottom, 0); top = Math.max(top, 0); }
  if (low !== null) bottom = low;
  if (high !== null) top = high;
  if (bottom === top) { bottom -= 0.5; top += 0.5; }
  const slack = 0.06 * (top - bottom);
  if (low === null) bottom -= bottom < 0 || !zero ? slack : 0;
  if (high === null) top += slack;
  const times = drawn.length ? drawn[0].x : [0, 1];
  const [first, last] = xRange || [times[0], times[times.length - 1]];
  const marks = ticks(bottom, top, Math.max(2, height / 42)), wide = Math.max(...marks.map(one => c.measureText(said(one)).width));
  const named = drawn.filter(one => one.label), places = legend(c, named, wide + 26, width - 6), lines = places.length ? places[places.length - 1][1] + 1 : 0;
  const [l, r, t, b] = [wide + 26, width - 10, 8 + 16 * lines, height - 34];
  const across = x => l + (x - first) / (last - first || 1) * (r - l), up = y => b - (y - bottom) / (top - bottom) * (b - t);
  c.lineWidth = 0.7; c.strokeStyle = "#cfc8ba"; c.fillStyle = INK; c.textBaseline = "middle"; c.textAlign = "right";
  for (const one of marks) {
    c.beginPath(); c.moveTo(l, up(one)); c.lineTo(r, up(one)); c.strokeStyle = one === 0 ? "#8f8877" : "#e8e2d5"; c.stroke();
    c.fillText(said(one), l - 6, up(one));
  }
  c.strokeStyle = INK; c.beginPath(); c.moveTo(l, t); c.lineTo(l, b); c.lineTo(r, b); c.stroke();
  c.textBaseline = "top"; c.textAlign = "center";
  for (const one of ticks(first, last, Math.max(2, (r - l) / 90))) {
    c.beginPath(); c.moveTo(across(one), b); c.lineTo(across(one), b + 4); c.stroke();
    c.fillText(said(one), across(one), b + 6);
  }
  c.textAlign = "right"; c.fillText(xLabel, r, b + 19);
  c.save(); c.translate(11, (t + b) / 2); c.rotate(-Math.PI / 2); c.textAlign = "center"; c.textBaseline = "middle"; c.fillText(yLabel, 0, 0); c.restore();
  c.save(); c.beginPath(); c.rect(l, t - 2, r - l, b - t + 4); c.clip();
  for (const one of drawn) {
    c.strokeStyle = one.color || INK; c.lineWidth = one.width || 1.2; c.setLineDash(one.dash || []);
    if (one.dots) { one.y.forEach((y, i) => { if (y !== null) dot(c, one.dots, across(one.x[i]), up(y)); }); continue; }
    c.beginPath();
    if (one.to) {
      c.fillStyle = one.color;
      [...one.x.keys(), ...[...one.x.keys()].reverse()].forEach((i, k) => c.lineTo(across(one.x[i]), up(k < one.x.length ? one.y[i] : one.to[i])));
      c.fill();
      continue;
    }
    let open = false;
    one.y.forEach((y, i) => {
      if (y === null) { open = false; return; }
      if (open) c.lineTo(across(one.x[i]), up(y)); else c.moveTo(across(one.x[i]), up(y));
      open = true;
    });
    c.stroke();
  }
  c.restore();
  c.setLineDash([]);
  c.textAlign = "left"; c.textBaseline = "middle";
  named.forEach((one, k) => {
    const [x, y] = [places[k][0], 9 + 16 * places[k][1]];
    c.strokeStyle = one.color || INK; c.lineWidth = 1.6; c.setLineDash(one.dash || []);
    if (one.dots) dot(c, one.dots, x + 11, y); else if (one.to) { c.fillStyle = one.color; c.fillRect(x, y - 5, 22, 10); } else { c.beginPath(); c.moveTo(x, y); c.lineTo(x + 22, y); c.stroke(); }
    c.setLineDash([]);
    c.fillStyle = INK; c.fillText(one.label, x + 27, y);
  });
  return { across, left: l, right: r, top: t, bottom: b, first, last };
}

// A circle, a cross or a square.
function dot(c, kind, x, y) {
  c.beginPath(); c.fillStyle = "#fff";
  if (kind === "x") { c.moveTo(x - 4, y - 4); c.lineTo(x + 4, y + 4); c.moveTo(x - 4, y + 4); c.lineTo(x + 4, y - 4); c.stroke(); return; }
  if (kind === "o") c.arc(x, y, 3.6, 0, 7); else c.rect(x - 3.3, y - 3.3, 6.6, 6.6);
  c.fill(); c.stroke();
}

// Where the names of lines stand: from the left, and in which line of text.
function legend(c, named, left, right) {
  let [x, line] = [left, 0];
  return named.map(one => {
    const long = 42 + c.measureText(one.label).width;
    if (x + long - 14 > right && x > left) [x, line] = [left, line + 1];
    const place = [x, line];
    x += long;
    return place;
  });
}

// A figure that keeps what it has drawn, so that a cursor moves over it without drawing it anew.
export function moving(canvas, draw) {
  const kept = document.createElement("canvas");
  let shows = null;
  return {
    canvas,
    redraw() {
      if (!canvas.clientWidth) return;
      shows = draw();
      kept.width = canvas.width; kept.height = canvas.height;
      kept.getContext("2d").drawImage(canvas, 0, 0);
    },
    cursor(x) {
      if (!shows) return;
      const c = canvas.getContext("2d");
      c.setTransform(1, 0, 0, 1, 0, 0); c.clearRect(0, 0, canvas.width, canvas.height); c.drawImage(kept, 0, 0);
      const ratio = devicePixelRatio || 1;
      c.setTransform(ratio, 0, 0, ratio, 0, 0);
      c.strokeStyle = RED; c.lineWidth = 1.5; c.beginPath(); c.moveTo(shows.across(x), shows.top); c.lineTo(shows.across(x), shows.bottom); c.stroke();
    },
    at: x => shows && shows.first + (x - shows.left) / (shows.right - shows.left) * (shows.last - shows.first),
  };
}
