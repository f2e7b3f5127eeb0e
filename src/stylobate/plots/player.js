// Plays a film on a canvas: bodies from their shapes and poses, with the ground's motion and a slider.

// A vertex of a body in space: turned by the unit quaternion w, i, j, k, then moved to x, y, z.
function placed([a, b, c], [x, y, z, w, i, j, k]) {
  const p = 2 * (j * c - k * b), q = 2 * (k * a - i * c), r = 2 * (i * b - j * a);
  return [x + a + w * p + j * r - k * q, y + b + w * q + k * p - i * r, z + c + w * r + i * q - j * p];
}
// What is seen of a convex body along y: the hull of its vertices in x and z, counter-clockwise.
function outline(vertices) {
  const points = vertices.map(([x, , z]) => [x, z]).sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = list => {
    const chain = [];
    for (const p of list) {
      while (chain.length > 1) {
        const [a, b] = chain.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return half(points).concat(half(points.reverse()));
}
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
// Canvases have the pixels of the screen; everything is drawn in its lengths.
function sharpen(canvas) {
  canvas.width = Math.round(canvas.clientWidth * devicePixelRatio);
  canvas.height = Math.round(canvas.clientHeight * devicePixelRatio);
  canvas.getContext("2d").setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
}
// The bar that tells lengths, at the right of the upper edge.
function drawBar(c, width, length, scale) {
  c.fillStyle = "#1a1a1a"; c.font = "13px sans-serif"; c.textAlign = "center"; c.textBaseline = "top";
  c.fillRect(width - 12 - length * scale, 12, length * scale, 3);
  c.fillText(+length.toPrecision(3) + " m", width - 12 - Math.max(length * scale / 2, 16), 19);
}
// Links, over the bodies: whole ones in blue, broken ones in red and dotted; "screen" says where a place in space is drawn.
function drawLinks(c, data, k, factor, screen) {
  for (const [below, low, above, high, broken] of data.links) {
    const ends = [[below, low], [above, high]].map(([i, place]) =>
      screen(i === null ? place : placed(place, magnified(data.poses[k][i], data.start[i], factor))));
    const gone = broken !== null && data.time[k] >= broken;
    c.strokeStyle = gone ? "#b2182b" : "#2166ac"; c.lineWidth = 2; c.setLineDash(gone ? [2, 3] : []);
    c.beginPath(); ends.forEach(end => c.lineTo(...end)); c.stroke();
  }
  c.setLineDash([]);
}
// Seen along y: moved and zoomed by hand.
function planePainter(data, film) {
  const [left, right, bottom, ceiling] = data.view;
  let zoom = 1, [x0, z0] = [0.5 * (left + right), 0.5 * (bottom + ceiling)];
  const least = () => Math.min(film.clientWidth / (right - left), film.clientHeight / (ceiling - bottom));
  return {
    drag(dx, dy) { x0 -= dx / (zoom * least()); z0 += dy / (zoom * least()); },
    zoomed(factor) { zoom = Math.min(Math.max(zoom * factor, 0.2), 20); },
    home() { zoom = 1; [x0, z0] = [0.5 * (left + right), 0.5 * (bottom + ceiling)]; },
    draw(k, factor) {
      const c = film.getContext("2d"), width = film.clientWidth, height = film.clientHeight, scale = zoom * least();
      const across = x => (x - x0) * scale + 0.5 * width, up = z => 0.5 * height - (z - z0) * scale;
      c.clearRect(0, 0, width, height);
      c.strokeStyle = "#1a1a1a"; c.lineWidth = 1.5;
      if (data.level !== null) {
        c.beginPath();
        for (const p of [-0.5 * width, 1.5 * width]) c.lineTo(p, up(data.level + data.slope * ((p - 0.5 * width) / scale + x0)));
        c.stroke();
      }
      c.lineWidth = 1; c.lineJoin = "round";
      data.shapes.forEach((vertices, i) => {
        const pose = magnified(data.poses[k][i], data.start[i], factor);
        c.fillStyle = data.fixed[i] ? "#dcdcdc" : "#efe6d2"; c.strokeStyle = data.fixed[i] ? "#767676" : "#8c6d3f";
        c.beginPath();
        outline(vertices.map(corner => placed(corner, pose))).forEach(([x, z]) => c.lineTo(across(x), up(z)));
        c.closePath(); c.fill(); c.stroke();
      });
      drawLinks(c, data, k, factor, ([x, , z]) => [across(x), up(z)]);
      drawBar(c, width, data.bar / (zoom > 3 ? 10 : zoom < 0.4 ? 0.1 : 1), scale);
    },
  };
}
// One finger, the mouse or the arrows drag, two fingers, the wheel, + and − zoom; a double click or 0 returns.
function followHands(film, painter, draw) {
  const fingers = new Map();
  const zoomed = factor => { painter.zoomed(factor); draw(); }, dragged = (x, y) => { painter.drag(x, y); draw(); };
  const spread = () => { const [a, b] = fingers.values(); return Math.hypot(a.x - b.x, a.y - b.y) || 1; };
  film.style.touchAction = "none"; film.style.cursor = "grab"; film.tabIndex = 0;
  film.onpointerdown = event => { film.setPointerCapture(event.pointerId); fingers.set(event.pointerId, event); };
  film.onpointerup = film.onpointercancel = event => fingers.delete(event.pointerId);
  film.onpointermove = event => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const apart = fingers.size === 2 ? spread() : 0;
    fingers.set(event.pointerId, event);
    if (apart) zoomed(spread() / apart); else dragged(event.clientX - before.clientX, event.clientY - before.clientY);
  };
  film.onwheel = event => { event.preventDefault(); zoomed(Math.exp(-0.0015 * event.deltaY)); };
  film.ondblclick = () => { painter.home(); draw(); };
  const keys = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] };
  film.onkeydown = event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key in keys) dragged(...keys[event.key]);
    else if (event.key === "+" || event.key === "-") zoomed(event.key === "+" ? 1.25 : 0.8);
    else if (event.key === "0") film.ondblclick();
    else return;
    event.preventDefault();
  };
}
// The film of what plots/player.py makes, in these elements: film and trace are canvases, place a slider, now an output, play
// a button, speed and larger selections. "painter" draws the bodies; "shown", where given, hears of every state on show.
function filmPlayer(data, { film, trace, place, now, play, speed, larger, painter, shown }) {
  const [left, right, bottom, ceiling] = data.view, end = data.time.length - 1;
  const begin = data.time[0], span = data.time[end] - begin || 1, peak = Math.max(data.peak, 1e-9);
  const over = new AbortController();
  place.max = end; place.value = 0;

  function fit() {
    film.style.height = Math.min(film.clientWidth * (ceiling - bottom) / (right - left), Math.max(0.7 * innerHeight, 240)) + "px";
    for (const canvas of [film, trace]) sharpen(canvas);
    draw();
  }
  function drawTrace(k) {
    const c = trace.getContext("2d"), width = trace.clientWidth, height = trace.clientHeight;
    c.clearRect(0, 0, width, height);
    c.lineWidth = 1;
    for (const [values, color] of [[data.across || [], "#2166ac"], [data.ground, "#767676"]]) {
      c.strokeStyle = color; c.beginPath();
      values.forEach((a, i) => c.lineTo((data.time[i] - begin) / span * width, (0.6 - 0.33 * a / peak) * height));
      c.stroke();
    }
    const x = (data.time[k] - begin) / span * width;
    c.strokeStyle = "#b2182b"; c.lineWidth = 2; c.beginPath(); c.moveTo(x, 0); c.lineTo(x, height); c.stroke();
    c.font = "13px sans-serif"; c.textAlign = "left"; c.textBaseline = "top"; c.fillStyle = "#1a1a1a";
    c.fillText("ground" + (data.across ? ", x grey, y blue" : "") + ", peak " + peak.toFixed(2) + " g", 7, 4);
  }
  function draw() {
    const k = +place.value;
    painter.draw(k, +larger.value); drawTrace(k);
    now.textContent = data.time[k].toFixed(2) + " s";
    if (shown) shown(k);
  }
  function seek(time) {
    const k = data.time.findIndex(t => t >= time);
    place.value = k < 0 ? end : k; at = time; draw();
  }
  let running = false, last = 0, at = begin;
  function step(stamp) {
    if (!running) return;
    at += (stamp - last) / 1000 * +speed.value; last = stamp;
    let k = +place.value;
    while (k < end && data.time[k + 1] <= at) k++;
    if (k !== +place.value) { place.value = k; draw(); }
    if (k < end) requestAnimationFrame(step); else toggle();
  }
  function toggle() {
    running = !running; play.textContent = running ? "Pause" : "Play";
    if (!running) return;
    if (+place.value === end) seek(begin);
    at = data.time[+place.value]; last = performance.now(); requestAnimationFrame(step);
  }
  play.textContent = "Play"; play.onclick = toggle;
  place.oninput = () => seek(data.time[+place.value]);
  const point = event => seek(begin + event.offsetX / trace.clientWidth * span);
  trace.onpointerdown = event => { trace.setPointerCapture(event.pointerId); point(event); };
  trace.onpointermove = event => { if (event.buttons) point(event); };
  larger.onchange = draw;
  followHands(film, painter, draw);
  film.addEventListener("keydown", event => { if (event.key === " ") { event.preventDefault(); toggle(); } }, { signal: over.signal });
  addEventListener("resize", fit, { signal: over.signal });
  fit();
  return { seek, toggle, fit, time: () => data.time[+place.value], end: () => { running = false; over.abort(); } };
}
