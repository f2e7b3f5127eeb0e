"""A film as one HTML page that opens from disk: canvas, scrubber, nothing from the network."""

from __future__ import annotations

import html
import json
from pathlib import Path

import numpy as np

from ..atomic import replacing
from ..column.as_found import geometry
from ..constants import DEGREE
from ..response import Response
from .animation import base_slope, frame_indices, outlines, view

_PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>TITLE</title>
<style>
body { font: 15px/1.4 sans-serif; margin: 1.5em auto; max-width: 60em; color: #1a1a1a; padding: 0 1em }
canvas { width: 100%; display: block; border: 1px solid #ddd }
#bar { display: flex; gap: .8em; align-items: center; margin: .6em 0 }
#place { flex: 1 }
</style>
<h1 style="font-size: 1.2em">TITLE</h1>
<p>SENTENCE</p>
<canvas id="film" width="1200" height="800"></canvas>
<div id="bar"><button id="play">Play</button>
<input id="place" type="range" min="0" max="0" value="0" aria-label="time">
<select id="speed" aria-label="speed"><option value="0.25">× ¼</option><option value="0.5">× ½</option>
<option value="1" selected>× 1</option><option value="2">× 2</option></select><output id="now"></output></div>
<canvas id="trace" width="1200" height="160"></canvas>
<script>
const data = DATA;
const film = document.getElementById("film"), trace = document.getElementById("trace");
const place = document.getElementById("place"), now = document.getElementById("now");
const play = document.getElementById("play"), speed = document.getElementById("speed");
place.max = data.time.length - 1;
const [left, right, bottom, top_] = data.view;
const scale = Math.min(film.width / (right - left), film.height / (top_ - bottom));
const across = x => (x - 0.5 * (left + right)) * scale + 0.5 * film.width;
const up = z => film.height - (z - bottom) * scale;
function draw() {
  const k = +place.value, c = film.getContext("2d");
  c.clearRect(0, 0, film.width, film.height);
  c.strokeStyle = "#1a1a1a"; c.lineWidth = 2;
  c.beginPath(); c.moveTo(across(left - 99), up((left - 99) * data.slope));
  c.lineTo(across(right + 99), up((right + 99) * data.slope)); c.stroke();
  c.fillStyle = "#efe6d2"; c.strokeStyle = "#8c6d3f"; c.lineWidth = 1.5;
  data.drums.forEach((corners, i) => {
    const [x, z, angle] = data.poses[k][i], co = Math.cos(angle), si = Math.sin(angle);
    c.beginPath();
    corners.forEach(([p, q]) => c.lineTo(across(x + co * p - si * q), up(z + si * p + co * q)));
    c.closePath(); c.fill(); c.stroke();
  });
  c.fillStyle = "#1a1a1a"; c.font = "22px sans-serif"; c.textAlign = "center";
  c.fillRect(film.width - 30 - scale, 30, scale, 4); c.fillText("1 m", film.width - 30 - scale / 2, 60);
  now.textContent = data.time[k].toFixed(2) + " s";
  const t = trace.getContext("2d"), n = data.ground.length, peak = Math.max(...data.ground.map(Math.abs), 1e-9);
  t.clearRect(0, 0, trace.width, trace.height);
  t.strokeStyle = "#767676"; t.beginPath();
  data.ground.forEach((a, i) => t.lineTo(i / (n - 1) * trace.width, (0.5 - 0.45 * a / peak) * trace.height));
  t.stroke();
  t.strokeStyle = "#b2182b"; t.lineWidth = 2; t.beginPath();
  t.moveTo(k / (n - 1) * trace.width, 0); t.lineTo(k / (n - 1) * trace.width, trace.height); t.stroke(); t.lineWidth = 1;
  t.fillStyle = "#1a1a1a"; t.font = "18px sans-serif"; t.fillText("ground, peak " + peak.toFixed(2) + " g", 8, 20);
}
let running = false, last = 0, at = 0;
function step(stamp) {
  if (!running) return;
  at += (stamp - last) / 1000 * +speed.value; last = stamp;
  let k = +place.value;
  while (k < data.time.length - 1 && data.time[k + 1] <= at) k++;
  place.value = k; draw();
  if (k === data.time.length - 1) { running = false; play.textContent = "Play"; } else requestAnimationFrame(step);
}
play.onclick = () => {
  running = !running; play.textContent = running ? "Pause" : "Play";
  if (running) {
    if (+place.value === data.time.length - 1) place.value = 0;
    at = data.time[+place.value]; last = performance.now(); requestAnimationFrame(step);
  }
};
place.oninput = () => { at = data.time[+place.value]; draw(); };
draw();
</script></html>
"""


def write_player(response: Response, path: str | Path, *, frames_per_second: float = 30.0) -> Path:
    """Write the page.

    Parameters
    ----------
    response : Response
    path : str or Path
    frames_per_second : float
        States per second that the page holds [1/s].
    """
    h, column = response.histories, response.column
    indices = frame_indices(response, frames_per_second, 1.0)
    slope = column.as_found.base_tilt * DEGREE
    start = geometry(column).centroid
    level = np.array([[np.cos(slope), np.sin(slope)], [-np.sin(slope), np.cos(slope)]])
    bodies = [
        (corners - centre).round(5).tolist()
        for corners, centre in zip(outlines(response, 0), start @ level, strict=True)
    ]
    poses = np.dstack((np.dstack((h.drum_x, h.drum_z)) @ level + start @ level, h.drum_rotation))[indices]
    data = {
        "time": h.time[indices].round(4).tolist(),
        "drums": bodies,
        "poses": poses.round(4).tolist(),
        "view": view(response, indices),
        "slope": base_slope(response),
        "ground": (h.ground_acceleration[indices] / 9.81).round(5).tolist(),
    }
    mechanism = response.provenance.get("mechanism", {})
    sentence = mechanism.get("sentence") or f"{response.outcome.sentence} {response.measures.reason}"
    page = _PAGE.replace("TITLE", html.escape(f"{column.name}, {response.provenance.get('motion', '')}"))
    page = page.replace("SENTENCE", html.escape(sentence)).replace("DATA", json.dumps(data))
    target = Path(path)
    with replacing(target) as partial:
        partial.write_text(page, encoding="utf-8")
    return target
