// Bodies in space: turned and zoomed by hand, shaded, the farther ones painted first.
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const unit = a => { const size = Math.hypot(...a); return a.map(x => x / size); };
// A body in a pose: its vertices, in space and in the picture [m], faces with normals, and its outline and box.
function formed(i, shape, faced, pose, [rightward, upward, toward]) {
  const at = shape.map(corner => placed(corner, pose));
  const seen = at.map(p => [dot(p, rightward), dot(p, upward)]), edge = outline(seen.map(([x, y]) => [x, 0, y]));
  const faces = faced.map(([tone, ...corners]) => {
    const [p, q, r] = corners.map(j => at[j]), normal = unit(cross(minus(q, p), minus(r, q)));
    return { tone, corners, normal, level: dot(normal, p), slope: dot(normal, toward) };
  });
  const [low, high] = [Math.min, Math.max].map(end => [0, 1].map(axis => end(...edge.map(p => p[axis]))));
  const reached = ([x, y]) => Math.min(...faces.filter(face => face.slope > 1e-9).map(({ normal, level, slope }) =>
    (level - x * dot(normal, rightward) - y * dot(normal, upward)) / slope));
  return { i, seen, edge, faces, low, high, reached, depth: dot(pose, toward) };
}
// A point inside two convex polygons; null where they do not overlap.
function commonPoint(kept, other) {
  for (let i = 0; i < other.length; i++) {
    const [x, y] = other[i], [p, q] = other[(i + 1) % other.length];
    const inside = kept.map(([a, b]) => (p - x) * (b - y) - (q - y) * (a - x));
    if (inside.every(d => d <= 0)) return null;
    kept = kept.flatMap((corner, j) => {
      const next = (j + 1) % kept.length, share = inside[j] / (inside[j] - inside[next]);
      const cut = inside[j] * inside[next] < 0 ? [[0, 1].map(k => corner[k] + share * (kept[next][k] - corner[k]))] : [];
      return inside[j] >= 0 ? [corner, ...cut] : cut;
    });
  }
  return [0, 1].map(k => kept.reduce((sum, corner) => sum + corner[k], 0) / kept.length);
}
// Convex bodies: which is nearer along one common line of sight is nearer along all of them.
function ordered(bodies) {
  const left = [...bodies].sort((a, b) => a.depth - b.depth), order = [];
  for (const body of left) body.before = new Set();
  left.forEach((a, i) => left.slice(i + 1).forEach(b => {
    if ([0, 1].some(k => a.high[k] < b.low[k] || b.high[k] < a.low[k])) return;
    const point = commonPoint(a.edge, b.edge);
    if (point) a.reached(point) > b.reached(point) ? a.before.add(b) : b.before.add(a);
  }));
  while (left.length) {
    const free = left.findIndex(body => !left.some(other => body.before.has(other)));
    order.push(...left.splice(Math.max(free, 0), 1));
  }
  return order;
}
// Seen from anywhere above the ground.
function spacePainter(data, film) {
  const space = data.space, [left, right, bottom, ceiling] = data.view;
  let [azimuth, elevation] = space.view, zoom = 1;
  return {
    drag(dx, dy) {
      azimuth -= 0.01 * dx;
      elevation = Math.min(Math.max(elevation + 0.01 * dy, 0), 0.5 * Math.PI);
    },
    zoomed(factor) { zoom = Math.min(Math.max(zoom * factor, 0.2), 20); },
    home() { [azimuth, elevation] = space.view; zoom = 1; },
    draw(k, factor) {
      const c = film.getContext("2d"), width = film.clientWidth, height = film.clientHeight;
      const [sa, ca, se, ce] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
      const rightward = [-sa, ca, 0], upward = [-ca * se, -sa * se, ce], toward = [ca * ce, sa * ce, se];
      const scale = zoom * Math.min(width / (right - left), height / (ceiling - bottom));
      const middle = 0.5 * (bottom + ceiling) / Math.cos(space.view[1]) * ce;
      const onScreen = ([x, y]) => [(x - 0.5 * (left + right)) * scale + 0.5 * width, 0.5 * height - (y - middle) * scale];
      const screen = p => onScreen([dot(p, rightward), dot(p, upward)]);
      const path = points => { c.beginPath(); points.forEach(p => c.lineTo(...p)); c.closePath(); };
      const sum = (a, b) => a.map((x, i) => x + b[i]);
      const light = unit(sum(sum(rightward.map(x => x * space.light[0]), upward.map(x => x * space.light[1])),
        toward.map(x => x * space.light[2])));
      c.clearRect(0, 0, width, height);
      c.lineJoin = "round"; c.lineWidth = 1; c.fillStyle = "#f4f4f4"; c.strokeStyle = "#767676";
      path(space.plate.map(screen)); c.fill(); c.stroke();
      c.fillStyle = c.strokeStyle = "#1a1a1a"; c.font = "13px sans-serif"; c.textAlign = "center"; c.textBaseline = "middle";
      space.directions.forEach(([start, end], i) => {
        const [from, to, beyond] = [0, 1, 1.3].map(s => screen(start.map((p, k) => p + s * (end[k] - p))));
        c.beginPath(); c.moveTo(...from); c.lineTo(...to); c.stroke(); c.fillText("xy"[i], ...beyond);
      });
      const axes = [rightward, upward, toward];
      const bodies = space.bodies.map((body, i) =>
        formed(i, data.shapes[i], space.faces[i], magnified(data.poses[k][body], data.start[body], factor), axes));
      for (const { seen, edge, faces } of ordered(bodies)) {
        const points = seen.map(onScreen);
        c.lineWidth = 2; c.strokeStyle = "#8c6d3f"; path(edge.map(onScreen)); c.stroke();
        c.lineWidth = 0.5;
        for (const { tone, corners, normal, slope } of faces) {
          if (slope <= 0) continue;
          const shade = space.diffuse + (1 - space.diffuse) * Math.max(dot(normal, light), 0);
          c.fillStyle = c.strokeStyle = `rgb(${space.colours[tone].map(x => Math.round(255 * x * shade))})`;
          path(corners.map(j => points[j])); c.fill(); c.stroke();
        }
      }
      drawLinks(c, data, k, factor, screen);
      drawBar(c, width, data.bar / (zoom > 3 ? 10 : zoom < 0.4 ? 0.1 : 1), scale);
    },
  };
}
