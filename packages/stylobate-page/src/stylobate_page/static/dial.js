// A dial for an azimuth: dragged, or turned by the arrow keys; the path of the motion in plan lies on it.

import { BLUE, GREY, INK, RED, sharp } from "./plot.js";

export function dial(canvas, turned) {
  let angle = 0, path = null, on = false;
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "slider"); canvas.setAttribute("aria-label", "azimuth");
  canvas.setAttribute("aria-valuemin", "0"); canvas.setAttribute("aria-valuemax", "359");
  const set = given => { on = true; angle = ((Math.round(given) % 360) + 360) % 360; draw(); turned(angle); };
  const point = event => {
    const box = canvas.getBoundingClientRect();
    set(Math.atan2(box.top + box.height / 2 - event.clientY, event.clientX - box.left - box.width / 2) * 180 / Math.PI);
  };
  canvas.onpointerdown = event => { canvas.setPointerCapture(event.pointerId); point(event); };
  canvas.onpointermove = event => { if (event.buttons) point(event); };
  canvas.onkeydown = event => {
    const step = { ArrowLeft: 5, ArrowUp: 5, ArrowRight: -5, ArrowDown: -5, PageUp: 45, PageDown: -45, Home: -angle }[event.key];
    if (step === undefined) return;
    event.preventDefault(); set(angle + step);
  };
  function draw() {
    if (!canvas.clientWidth) return;
    const [c, width, height] = sharp(canvas), x = width / 2, y = height / 2, r = Math.min(x, y) - 16;
    canvas.setAttribute("aria-valuenow", angle); canvas.setAttribute("aria-valuetext", on ? `${angle} degrees from x towards y` : "as it is");
    c.strokeStyle = "#c9bfa9"; c.lineWidth = 1; c.beginPath(); c.arc(x, y, r, 0, 7); c.stroke();
    c.beginPath(); c.moveTo(x - r, y); c.lineTo(x + r, y); c.moveTo(x, y - r); c.lineTo(x, y + r); c.strokeStyle = "#e6dfd0"; c.stroke();
    c.fillStyle = INK; c.textAlign = "center"; c.textBaseline = "middle"; c.fillText("x", x + r + 8, y); c.fillText("y", x, y - r - 8);
    for (let k = 0; k < 24; k++) {
      const [a, s, inner] = [Math.cos(k * Math.PI / 12), Math.sin(k * Math.PI / 12), k % 3 ? 4 : 8];
      c.strokeStyle = GREY; c.beginPath(); c.moveTo(x + r * a, y + r * s); c.lineTo(x + (r - inner) * a, y + (r - inner) * s); c.stroke();
    }
    if (path) {
      const most = Math.max(1e-9, ...path[0].map((one, i) => Math.hypot(one, path[1][i])));
      c.strokeStyle = BLUE; c.lineWidth = 0.8; c.beginPath();
      path[0].forEach((one, i) => c.lineTo(x + 0.82 * r * one / most, y - 0.82 * r * path[1][i] / most));
      c.stroke();
    }
    if (!on) return;
    const [a, s] = [Math.cos(angle * Math.PI / 180), -Math.sin(angle * Math.PI / 180)];
    c.strokeStyle = c.fillStyle = RED; c.lineWidth = 2; c.beginPath(); c.moveTo(x, y); c.lineTo(x + r * a, y + r * s); c.stroke();
    c.beginPath(); c.arc(x + r * a, y + r * s, 5, 0, 7); c.fill();
  }
  return {
    show(given, plan) { on = given !== ""; angle = on && Number.isFinite(Number(given)) ? Math.round(Number(given)) : 0; if (plan !== undefined) path = plan; draw(); },
  };
}
