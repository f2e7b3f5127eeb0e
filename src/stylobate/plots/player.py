"""A film as one HTML page that opens from disk: canvas, scrubber, nothing from the network."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Template
from markupsafe import Markup

from ..atomic import replacing
from ..response import Response
from ..response.poses import quaternions, rotation_matrices
from .animation import SHAPE, film_of, frame_indices
from .link_marks import marks_of
from .scene import Scene, scale_bar
from .solids import COLOURS, DIFFUSE, LIGHT
from .view import OBLIQUE, View

#: The scripts that play films, of those in the plane the first alone.
SCRIPTS = ("player.js", "player_space.js")

#: Corners of the polygons that stand for circles.
AROUND = 24


def write_player(
    response: Response,
    path: str | Path,
    *,
    frames_per_second: float = 30.0,
    speed: float = 1.0,
    window: tuple[float, float] | None = None,
    seen_from: View = OBLIQUE,
) -> Path:
    """Write the page.

    Parameters
    ----------
    response : Response
    path : str or Path
    frames_per_second, speed, window, seen_from
        As in :func:`film_data`.
    """
    scene = film_of(response, seen_from)
    indices = np.unique(frame_indices(scene.time, frames_per_second, speed, window))
    title = f"{scene.name}, {response.provenance.get('motion', '')}"
    here = Path(__file__)
    template = Template(here.with_name("player.html").read_text(encoding="utf-8"), autoescape=True)
    scripts = SCRIPTS if response.dims == "xyz" else SCRIPTS[:1]
    script = Markup("".join(here.with_name(one).read_text(encoding="utf-8") for one in scripts))
    page = template.render(
        title=title, sentence=scene.sentence, data=film_data(scene, indices, seen_from), script=script
    )
    target = Path(path)
    with replacing(target) as partial:
        partial.write_text(page, encoding="utf-8")
    return target


def film_data(scene: Scene, indices: np.ndarray, seen_from: View = OBLIQUE, least: float = SHAPE) -> dict[str, Any]:
    """Scene of a page's player: bodies, poses, the ground and what is seen of them at first, as plain values.

    Parameters
    ----------
    scene : Scene
        Of :func:`stylobate.plots.animation.film_of`.
    indices : array of int
        The recorded states of the film, rising.
    seen_from : View
        From where what moved in space is seen at first; the viewer turns it.
    least : float
        Least width over height of what is seen [-].
    """
    response, shown = scene.response, list(scene.shown)
    view = scene.view(indices, least)
    poses = _upright(scene, response.body_position, response.body_orientation)[:, shown]
    data = {
        "time": scene.time[indices].round(4).tolist(),
        "shapes": [vertex.round(5).tolist() for vertex in _vertices(scene)],
        "fixed": scene.fixed,
        "poses": np.nan_to_num(poses[indices], nan=1e6).round(5).tolist(),
        "start": poses[0].round(5).tolist(),
        "view": [round(float(end), 4) for end in view],
        "bar": scale_bar(view[1] - view[0]),
        "level": scene.level,
        "slope": scene.slope,
        "ground": scene.ground[indices].round(5).tolist(),
        "peak": float(np.abs(scene.ground).max()),
        "links": _links(scene, shown),
    }
    if scene.ground_across is not None:
        data |= {
            "across": scene.ground_across[indices].round(5).tolist(),
            "peak": max(data["peak"], float(np.abs(scene.ground_across).max())),
            "space": _in_space(scene, seen_from),
        }
    return data


def _links(scene: Scene, shown: list[int]) -> list[list]:
    """Marks of links: for either end the body in the picture, or none, and a place [m]; and when it broke [s]."""

    def end(body: int | None, place: np.ndarray) -> list:
        if body is not None and body not in shown:  # a ground without ends
            body, place = None, place + scene.response.body_position[0, body]
        return [None if body is None else shown.index(body), place.round(5).tolist()]

    return [
        [*end(*one.lower), *end(*one.upper), one.broken if math.isfinite(one.broken) else None]
        for one in marks_of(scene)
    ]


def _upright(scene: Scene, position: np.ndarray, orientation: np.ndarray) -> np.ndarray:
    """Poses with z upward, as the page wants them, shape (…, 7): position [m] and quaternion."""
    if not np.array_equal(scene.upright, np.eye(3)):
        position = position @ scene.upright.T
        orientation = quaternions(scene.upright @ rotation_matrices(orientation))
    return np.concatenate((position, orientation), axis=-1)


def _vertices(scene: Scene) -> list[np.ndarray]:
    """Vertices of every body in its own axes [m], each of shape (m, 3); of what is seen in space, of every part of one."""
    if scene.seen_from is not None:
        return [surface.vertices for _, surface in scene.parts]
    return [scene.response.bodies.shapes[i].mesh(AROUND).vertices for i in scene.shown]


def _in_space(scene: Scene, view: View) -> dict:
    """Scene that the page turns: faces with tones, the ground, view and light."""
    return {
        "faces": [
            [(tone, *face) for tone, face in zip(surface.tones, surface.faces, strict=True)]
            for _, surface in scene.parts
        ],
        "bodies": [body for body, _ in scene.parts],
        "plate": scene.plate.round(4).tolist(),
        "directions": scene.directions.round(4).tolist(),
        "view": (view.azimuth, view.elevation),
        "colours": COLOURS.tolist(),
        "light": LIGHT.tolist(),
        "diffuse": DIFFUSE,
    }
