// Draws the column, fifteen like it and the motion of the ground. What is drawn was computed; dust alone is paint.

const STONE = ["#b9ab92", "#efe6d2", "#f7f0df", "#ded2b9", "#a89a80"], FALLEN = ["#a5705c", "#dca48d", "#e8b49d", "#c98d76", "#8f5b48"];
const DUST = 1.1; // for how long dust hangs [s]
const DROP = 0.1; // height of the steps under a column, over its own

class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  resize() {
    const ratio = Math.min(devicePixelRatio || 1, 2), { clientWidth, clientHeight } = this.canvas;
    this.canvas.width = Math.round(clientWidth * ratio);
    this.canvas.height = Math.round(clientHeight * ratio);
    this.ratio = ratio;
    if (this.last) this.draw(...this.last);
  }

  // Where each lane stands: the ground's height, the middle, and pixels to a metre.
  places(column) {
    const w = this.canvas.width, h = this.canvas.height, narrow = w < h * 1.25;
    const scale = Math.min((narrow ? 0.5 : 0.74) * h, (narrow ? 0.55 : 0.42) * w) / column.height;
    const drop = DROP * column.height; // what it stands on is so high [m]
    const ground = (narrow ? 0.66 : 0.945) * h;
    const result = [{ x: narrow ? 0.5 * w : 0.26 * w, y: ground - drop * scale, scale, drop, own: true }];
    const rows = narrow ? 1 : 3, each = 15 / rows;
    for (let k = 0; k < 15; k++) {
      const row = Math.floor(k / each), place = k % each;
      const left = narrow ? 0.03 * w : 0.53 * w, width = narrow ? 0.94 * w : 0.45 * w;
      const room = narrow ? 0.2 * h : 0.225 * h;
      result.push({
        x: left + (place + 0.5) * (width / each),
        y: narrow ? 0.962 * h : (0.34 + 0.285 * row) * h,
        scale: Math.min(room / column.height, (0.9 * width) / each / (1.1 * column.width)),
        drop: 0,
        own: false,
      });
    }
    return result;
  }

  // One moment: poses of all lanes, which of them have fallen by then, and dust.
  draw(column, poses, time, fell, dust) {
    this.last = [column, poses, time, fell, dust];
    const { pen } = this, w = this.canvas.width, h = this.canvas.height;
    if (!w || !h) return;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    const sky = pen.createLinearGradient(0, 0, 0, h);
    sky.addColorStop(0, "#7fa6bd");
    sky.addColorStop(0.55, "#c9d7d6");
    sky.addColorStop(1, "#f0e3cb");
    pen.fillStyle = sky;
    pen.fillRect(0, 0, w, h);
    const places = this.places(column);
    const far = places.slice(1);
    this.panel(far);
    for (const y of new Set(far.map((item) => item.y))) {
      const row = far.filter((item) => item.y === y);
      row.forEach((place) => this.column(column, poses, place, far.indexOf(place) + 1, fell, false));
      row.forEach((place) => this.dust(dust[far.indexOf(place) + 1], place, time));
      this.ledge(row[0].x - 0.5 * (row[1].x - row[0].x), row.at(-1).x + 0.5 * (row[1].x - row[0].x), y);
    }
    this.column(column, poses, places[0], 0, fell, true);
    this.steps(places[0], column);
    this.dust(dust[0], places[0], time);
  }

  column(column, poses, place, lane, fell, fine) {
    const { pen } = this, { drums } = column, widest = column.shapes[lane][0][0] / 2;
    const [stone, fallen] = [STONE, FALLEN].map((colours) => {
      const light = pen.createLinearGradient(-widest, 0, widest, 0);
      [0, 0.28, 0.45, 0.75, 1].forEach((at, k) => light.addColorStop(at, colours[k]));
      return light;
    });
    pen.lineJoin = "round";
    pen.save();
    pen.beginPath();
    pen.rect(0, 0, this.canvas.width, place.y + place.drop * place.scale);
    pen.clip();
    for (let i = 0; i < drums; i++) {
      const at = (lane * drums + i) * 4, [x, z, c, s] = [poses[at], poses[at + 1], poses[at + 2], poses[at + 3]];
      const [bottom, top, height, centroid] = column.shapes[lane][i];
      if (z < -place.drop - 0.6 * height || !Number.isFinite(x)) continue;
      const k = place.scale;
      pen.setTransform(k * c, -k * s, -k * s, -k * c, place.x + k * x, place.y - k * z);
      pen.beginPath();
      pen.moveTo(-bottom / 2, -centroid);
      pen.lineTo(bottom / 2, -centroid);
      pen.lineTo(top / 2, height - centroid);
      pen.lineTo(-top / 2, height - centroid);
      pen.closePath();
      pen.fillStyle = fell[lane] ? fallen : stone;
      pen.fill();
      if (fine && column.round) {
        pen.lineWidth = 0.8 / k;
        pen.strokeStyle = "rgb(96 82 60 / .33)";
        pen.beginPath();
        for (const share of [-0.86, -0.62, -0.32, 0, 0.32, 0.62, 0.86]) {
          pen.moveTo((share * bottom) / 2, -centroid);
          pen.lineTo((share * top) / 2, height - centroid);
        }
        pen.stroke();
      }
      pen.beginPath();
      pen.moveTo(-bottom / 2, -centroid);
      pen.lineTo(bottom / 2, -centroid);
      pen.moveTo(-top / 2, height - centroid);
      pen.lineTo(top / 2, height - centroid);
      pen.lineWidth = (fine ? 1.4 : 0.8) * this.ratio / k;
      pen.strokeStyle = "rgb(66 54 38 / .75)";
      pen.stroke();
    }
    pen.restore();
  }

  dust(puffs, place, time) {
    const { pen } = this;
    for (const puff of puffs) {
      const age = (time - puff.time) / DUST;
      if (age < 0 || age > 1) continue;
      const size = place.scale * puff.size * (0.5 + 1.5 * Math.sqrt(age));
      pen.fillStyle = `rgb(226 208 174 / ${0.5 * (1 - age)})`;
      pen.beginPath();
      pen.ellipse(place.x + place.scale * puff.x, place.y + place.scale * place.drop, size, 0.45 * size, 0, Math.PI, 2 * Math.PI);
      pen.fill();
    }
  }

  // Where those like it are.
  panel(far) {
    const { pen } = this, room = 0.5 * (far[1].x - far[0].x), left = far[0].x - room, right = far.at(-1).x + room;
    const size = 13 * this.ratio, low = far.at(-1).y + 12 * this.ratio;
    const high = far[0].y - far[0].scale * this.last[0].height * 1.03 - 1.7 * size;
    pen.fillStyle = "rgb(255 252 244 / .36)";
    pen.fillRect(left, high, right - left, low - high);
    pen.fillStyle = "#26313a";
    pen.font = `${size}px system-ui, sans-serif`;
    pen.textBaseline = "top";
    pen.textAlign = "left";
    pen.fillText("Fifteen columns like it", left + 0.6 * size, high + 0.3 * size);
  }

  // What those like it stand on.
  ledge(left, right, y) {
    const { pen } = this, deep = 9 * this.ratio, h = this.canvas.height;
    pen.fillStyle = "#e9dcc0";
    pen.fillRect(left, y, right - left, 3 * this.ratio);
    pen.fillStyle = "#b7a684";
    pen.fillRect(left, y + 3 * this.ratio, right - left, Math.min(deep, h - y));
  }

  // Three steps under the column, the ground before it, and somebody beside it for its size.
  steps(place, column) {
    const { pen } = this, w = this.canvas.width, h = this.canvas.height, narrow = w < h * 1.25;
    const right = narrow ? w : 0.51 * w, step = (place.drop * place.scale) / 3;
    const half = 0.8 * column.width * place.scale;
    ["#efe3c9", "#dfd0b1", "#cdbc99"].forEach((colour, k) => {
      pen.fillStyle = colour;
      const wide = half + k * 1.3 * step, y = place.y + k * step;
      pen.fillRect(place.x - wide, y, 2 * wide, step + 1);
      pen.fillStyle = "rgb(90 74 48 / .25)";
      pen.fillRect(place.x - wide, y + step - this.ratio, 2 * wide, this.ratio);
    });
    const ground = place.y + 3 * step;
    pen.fillStyle = "#a99873";
    pen.fillRect(0, ground, right, (narrow ? 0.022 : 1) * h);
    this.person(place.x + half + 3.4 * step + 0.9 * place.scale + 4 * this.ratio, ground, 1.75 * place.scale);
  }

  person(x, y, size) {
    const { pen } = this;
    pen.fillStyle = "#2c3a44";
    pen.beginPath();
    pen.arc(x, y - 0.92 * size, 0.075 * size, 0, 2 * Math.PI);
    pen.fill();
    pen.beginPath();
    pen.moveTo(x - 0.13 * size, y - 0.8 * size);
    pen.lineTo(x + 0.13 * size, y - 0.8 * size);
    pen.lineTo(x + 0.1 * size, y - 0.42 * size);
    pen.lineTo(x + 0.09 * size, y);
    pen.lineTo(x + 0.02 * size, y);
    pen.lineTo(x, y - 0.36 * size);
    pen.lineTo(x - 0.02 * size, y);
    pen.lineTo(x - 0.09 * size, y);
    pen.lineTo(x - 0.1 * size, y - 0.42 * size);
    pen.closePath();
    pen.fill();
  }
}

// The acceleration of the ground, how much of the film is computed, and where it is.
class Trace {
  constructor(canvas) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    new ResizeObserver(() => this.last && this.draw(...this.last)).observe(canvas);
  }

  draw(motion, length, computed, time, g) {
    this.last = [motion, length, computed, time, g];
    const { canvas, pen } = this, ratio = Math.min(devicePixelRatio || 1, 2);
    const w = (canvas.width = Math.round(canvas.clientWidth * ratio)), h = (canvas.height = Math.round(canvas.clientHeight * ratio));
    const most = Math.max(motion.facts.peak, 1e-9), { sample } = motion.facts, count = motion.x.length;
    pen.fillStyle = "#eef3f2";
    pen.fillRect(0, 0, (w * computed) / length, h);
    pen.strokeStyle = "#14566b";
    pen.lineWidth = 1.3 * ratio;
    pen.beginPath();
    for (let px = 0; px < w; px++) {
      const from = Math.floor(((px / w) * length) / sample), to = Math.max(from + 1, Math.floor((((px + 1) / w) * length) / sample));
      let low = Infinity, high = -Infinity;
      for (let k = from; k < Math.min(to, count); k += Math.max(1, (to - from) >> 4)) {
        low = Math.min(low, motion.x[k]);
        high = Math.max(high, motion.x[k]);
      }
      if (low > high) low = high = 0;
      const rises = motion.x[from] < motion.x[Math.min(to, count) - 1];
      for (const item of rises ? [low, high] : [high, low]) pen.lineTo(px, h / 2 - (0.42 * h * item) / most);
    }
    pen.stroke();
    pen.fillStyle = "#5d5547";
    pen.font = `${12 * ratio}px system-ui, sans-serif`;
    pen.textBaseline = "top";
    pen.textAlign = "right";
    pen.fillStyle = "rgb(255 253 248 / .8)";
    pen.fillRect(w - 142 * ratio, 2 * ratio, 140 * ratio, 18 * ratio);
    pen.fillStyle = "#5d5547";
    pen.fillText(`ground: up to ${(most / g).toFixed(2)} g`, w - 8 * ratio, 5 * ratio);
    pen.fillStyle = "#b3541e";
    pen.fillRect((w * time) / length - ratio, 0, 2 * ratio, h);
  }
}
