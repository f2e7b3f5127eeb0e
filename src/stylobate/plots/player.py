"""A film as one HTML page that opens from disk: canvas, scrubber, nothing from the network."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from jinja2 import Template

from ..atomic import replacing
from ..response import Response
from .animation import SHAPE, frame_indices
from .scene import scale_bar, scene_of

#: Corners of the polygons that stand for circles.
AROUND = 24


def write_player(
    response: Response,
    path: str | Path,
    *,
    frames_per_second: float = 30.0,
    speed: float = 1.0,
    window: tuple[float, float] | None = None,
) -> Path:
    """Write the page.

    Parameters
    ----------
    response : Response
    path : str or Path
    frames_per_second : float
        Frames that the page shows in a second [1/s].
    speed : float
        At which the page shows that many: 0.5 keeps twice as many states. The viewer chooses how fast it plays.
    window : (float, float), optional
        Beginning and end of what the page shows [s]; all by default.
    """
    scene = scene_of(response)
    indices = np.unique(frame_indices(scene.time, frames_per_second, speed, window))
    view = scene.view(indices, SHAPE)
    shown = list(scene.shown)
    poses = np.concatenate((response.body_position, response.body_orientation), axis=2)[indices][:, shown]
    data = {
        "time": scene.time[indices].round(4).tolist(),
        "shapes": [response.bodies.shapes[i].mesh(AROUND).vertices.round(5).tolist() for i in shown],
        "fixed": scene.fixed,
        "poses": np.nan_to_num(poses, nan=1e6).round(5).tolist(),
        "view": [round(float(end), 4) for end in view],
        "bar": scale_bar(view[1] - view[0]),
        "level": scene.level,
        "slope": scene.slope,
        "ground": scene.ground[indices].round(5).tolist(),
        "peak": float(np.abs(scene.ground).max()),
    }
    title = f"{scene.name}, {response.provenance.get('motion', '')}"
    template = Template(Path(__file__).with_name("player.html").read_text(encoding="utf-8"), autoescape=True)
    page = template.render(title=title, sentence=scene.sentence, data=data)
    target = Path(path)
    with replacing(target) as partial:
        partial.write_text(page, encoding="utf-8")
    return target
