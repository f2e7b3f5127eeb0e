// Bodies in space: turned and zoomed by hand, shaded, the farther ones painted first.
const space = data.space, larger = document.getElementById("larger");
let [azimuth, elevation] = space.view, zoom = 1;
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const unit = a => { const size = Math.hypot(...a); return a.map(x => x / size); };

// Two turns after one another as unit quaternions, the right one first.
function after([a, b, c, d], [w, x, y, z]) {
  return [a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x,
    a * z + b * y - c * x + d * w];
}
// A pose with displacement and turn from the start made larger.
function magnified(pose, start, factor) {
  if (factor === 1) return pose;
  const place = [0, 1, 2].map(i => start[i] + factor * (pose[i] - start[i])), [w, x, y, z] = start.slice(3);
  let turn = after(pose.slice(3), [w, -x, -y, -z]);
  if (turn[0] < 0) turn = turn.map(x => -x);
  const size = Math.hypot(...turn.slice(1)), half = factor * Math.atan2(size, turn[0]);
  const axis = turn.slice(1).map(x => x / (size || 1) * Math.sin(half));
  return [...place, ...after([Math.cos(half), ...axis], [w, x, y, z])];
}
// Which of two convex bodies hides the other: a plane parts them, and one is on the viewer's side of it.
function hides(front, back, toward) {
  const parting = (one, other) => one.faces.reduce((best, face) => {
    const gap = Math.min(...other.at.map(p => dot(face.normal, p))) - face.level;
    return gap > best.gap ? { gap, side: dot(face.normal, toward) } : best;
  }, { gap: -Infinity });
  const own = parting(front, back), others = parting(back, front);
  return own.gap > others.gap ? own.side < 0 : others.side > 0;
}
function ordered(bodies, toward) {
  const left = [...bodies].sort((a, b) => a.depth - b.depth), order = [];
  for (const body of left) body.before = new Set();
  left.forEach((a, i) => left.slice(i + 1).forEach(b => {
    if ([0, 1].some(k => a.high[k] < b.low[k] || b.high[k] < a.low[k])) return;
    hides(a, b, toward) ? a.before.add(b) : b.before.add(a);
  }));
  while (left.length) {
    const free = left.findIndex(body => !left.some(other => body.before.has(other)));
    order.push(...left.splice(Math.max(free, 0), 1));
  }
  return order;
}
function drawSpace(k) {
  const c = film.getContext("2d"), width = film.clientWidth, height = film.clientHeight;
  const [sa, ca, se, ce] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
  const rightward = [-sa, ca, 0], upward = [-ca * se, -sa * se, ce], toward = [ca * ce, sa * ce, se];
  const scale = zoom * Math.min(width / (right - left), height / (ceiling - bottom));
  const middle = 0.5 * (bottom + ceiling) / Math.cos(space.view[1]) * ce;
  const screen = p => [(dot(p, rightward) - 0.5 * (left + right)) * scale + 0.5 * width,
    0.5 * height - (dot(p, upward) - middle) * scale];
  const path = points => { c.beginPath(); points.forEach(p => c.lineTo(...p)); c.closePath(); };
  const sum = (a, b) => a.map((x, i) => x + b[i]);
  const light = unit(sum(sum(rightward.map(x => x * space.light[0]), upward.map(x => x * space.light[1])),
    toward.map(x => x * space.light[2])));
  c.clearRect(0, 0, width, height);
  c.lineJoin = "round"; c.lineWidth = 1; c.fillStyle = "#f4f4f4"; c.strokeStyle = "#767676";
  path(space.plate.map(screen)); c.fill(); c.stroke();
  c.fillStyle = c.strokeStyle = "#1a1a1a"; c.font = "13px sans-serif"; c.textAlign = "center"; c.textBaseline = "middle";
  const [reach, , level] = space.plate[0];
  for (const [name, x, y] of [["x", 1, 0], ["y", 0, 1]]) {
    const [from, to, beyond] = [0.72, 1, 1.08].map(s => screen([s * reach * x, s * reach * y, level]));
    c.beginPath(); c.moveTo(...from); c.lineTo(...to); c.stroke(); c.fillText(name, ...beyond);
  }
  const bodies = data.shapes.map((vertices, i) => {
    const pose = magnified(data.poses[k][i], space.start[i], +larger.value);
    const at = vertices.map(corner => placed(corner, pose)), points = at.map(screen);
    const faces = space.faces[i].map(([tone, ...corners]) => {
      const [p, q, r] = corners.map(j => at[j]), normal = unit(cross(minus(q, p), minus(r, q)));
      return { tone, corners, normal, level: dot(normal, p) };
    });
    const [low, high] = [Math.min, Math.max].map(end => [0, 1].map(axis => end(...points.map(p => p[axis]))));
    return { at, points, faces, low, high, depth: dot(pose, toward) };
  });
  for (const { points, faces } of ordered(bodies, toward)) {
    c.lineWidth = 2; c.strokeStyle = "#8c6d3f";
    path(outline(points.map(([x, y]) => [x, 0, y])).map(([x, y]) => [x, y])); c.stroke();
    c.lineWidth = 0.5;
    for (const { tone, corners, normal } of faces) {
      if (dot(normal, toward) <= 0) continue;
      const shade = space.diffuse + (1 - space.diffuse) * Math.max(dot(normal, light), 0);
      c.fillStyle = c.strokeStyle = `rgb(${space.colours[tone].map(x => Math.round(255 * x * shade))})`;
      path(corners.map(j => points[j])); c.fill(); c.stroke();
    }
  }
  const bar = data.bar / (zoom > 3 ? 10 : zoom < 0.4 ? 0.1 : 1);
  c.fillStyle = "#1a1a1a"; c.textBaseline = "top";
  c.fillRect(width - 12 - bar * scale, 12, bar * scale, 3);
  c.fillText(+bar.toPrecision(3) + " m", width - 12 - Math.max(bar * scale / 2, 16), 19);
}
// One finger or the mouse turns, two fingers or the wheel zoom.
const fingers = new Map();
const zoomed = factor => { zoom = Math.min(Math.max(zoom * factor, 0.2), 20); draw(); };
const spread = () => { const [a, b] = fingers.values(); return Math.hypot(a.x - b.x, a.y - b.y) || 1; };
film.style.touchAction = "none"; film.style.cursor = "grab";
film.onpointerdown = event => { film.setPointerCapture(event.pointerId); fingers.set(event.pointerId, event); };
film.onpointerup = film.onpointercancel = event => fingers.delete(event.pointerId);
film.onpointermove = event => {
  const before = fingers.get(event.pointerId);
  if (!before) return;
  const apart = fingers.size === 2 ? spread() : 0;
  fingers.set(event.pointerId, event);
  if (apart) return zoomed(spread() / apart);
  azimuth -= 0.01 * (event.clientX - before.clientX);
  elevation = Math.min(Math.max(elevation + 0.01 * (event.clientY - before.clientY), 0), 0.5 * Math.PI);
  draw();
};
film.addEventListener("wheel", event => { event.preventDefault(); zoomed(Math.exp(-0.0015 * event.deltaY)); },
  { passive: false });
film.ondblclick = () => { [azimuth, elevation] = space.view; zoom = 1; draw(); };
larger.onchange = draw;
