"""Films of a response: GIF, MP4 with the extra ``video``, a page that plays, single frames, and strips of them."""

from __future__ import annotations

import html
import math
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Template
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..atomic import replacing
from ..errors import InputError, check_range
from ..messages import digits, say
from ..response import Response
from ..response.poses import quaternions, rotation_matrices
from ..response.recorded import ASIDE, telling_states
from ..response.words import title_of
from .scene import (
    ALONG_X,
    ALONG_Y,
    COLOURS,
    DIFFUSE,
    LIGHT,
    OBLIQUE,
    Scene,
    View,
    draw_bodies,
    draw_links,
    draw_solids,
    marks_of,
    paint,
    scale_bar,
    time_window,
)
from .style import BLACK, BLUE, GREY, RED, WIDTH, in_lines, page, plain, signed, styled

#: Size [inch] and resolution of a frame.
SIZE, DOTS_PER_INCH = (6.4, 4.8), 100

#: Width over height of what a film shows of the bodies, at least.
SHAPE = 1.6

#: A film of more frames than this is refused.
MOST_FRAMES = 5000


def frame_indices(
    time: np.ndarray, frames_per_second: float, speed: float, window: tuple[float, float] | None = None
) -> np.ndarray:
    """Recorded states that a film shows, frame by frame, of those at these times [s], or of those in a window.

    Raises
    ------
    InputError
        The film would have too many frames, or nothing is recorded in the window.
    """
    check_rate(frames_per_second)
    check_range("speed", speed, 0.0, 1000.0, open_low=True)
    begin, end = (time[0], time[-1]) if window is None else time_window(time, window)
    wanted = np.arange(begin, end + 1e-9, speed / frames_per_second)
    if len(wanted) > MOST_FRAMES:
        raise InputError(
            f"the film would have {len(wanted)} frames; allowed are {MOST_FRAMES}: give fewer per second or a higher speed."
        )
    return np.searchsorted(time, wanted).clip(0, len(time) - 1)


def check_rate(frames_per_second: float) -> float:
    """Frames per second, if they are allowed [1/s]."""
    return check_range("frames per second", frames_per_second, 0.0, 100.0, unit="1/s", open_low=True)


@styled
def draw_frame(scene: Scene, index: int, limits: tuple[float, float, float, float] | None = None) -> Figure:
    """One frame: the bodies in true proportion, time, a scale, and where the ground's motion is.

    Parameters
    ----------
    scene : Scene
    index : int
        Recorded state.
    limits : tuple, optional
        Left, right, lower and upper end of the picture [m]; by default those that hold this state.
    """
    low, high, bottom, top = scene.view(np.array([index]), SHAPE) if limits is None else limits
    figure = Figure(figsize=SIZE)
    above, below = figure.subplots(2, 1, height_ratios=(4.0, 1.0))
    if scene.seen_from is None:
        draw_bodies(above, scene, scene.outlines(index), 0.8)
    else:
        draw_solids(above, scene, index)
    draw_links(above, scene, index)
    above.set_xlim(low, high)
    above.set_ylim(bottom, top)
    above.set_title(_words(scene, index), fontsize=9.5, loc="left")
    length, right = scale_bar(high - low), high - 0.04 * (high - low)
    above.plot([right - length, right], [top - 0.04 * (top - bottom)] * 2, color=BLACK, linewidth=2.0, zorder=1000)
    middle = (right - 0.5 * length, top - 0.055 * (top - bottom))
    above.text(*middle, f"{length:g} m", ha="center", va="top", fontsize=8.0, zorder=1000)
    below.plot(scene.time, scene.ground, color=GREY, linewidth=0.7, label="x")
    if scene.ground_across is not None:
        below.plot(scene.time, scene.ground_across, color=BLUE, linewidth=0.7, linestyle=(0, (4, 1.5)), label="y")
        below.legend(loc="upper right", ncols=2, fontsize=7.5)
    below.axvline(scene.time[index], color=RED, linewidth=1.2)
    below.set_xlim(scene.time[0], scene.time[-1] or 1.0)
    below.set_xlabel("time [s]")
    below.set_ylabel("ground [g]")
    return figure


def _images(
    scene: Scene, indices: np.ndarray, progress: Callable[[int, int], None] | None = None
) -> Iterator[np.ndarray]:
    """Frames as arrays of colour, shape (height, width, 3)."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = draw_frame(scene, int(indices[0]), scene.view(indices, SHAPE))
    figure.set_dpi(DOTS_PER_INCH)
    if indices[-1] > indices[0]:  # the ground's motion for as long as the film lasts
        figure.axes[1].set_xlim(float(scene.time[indices[0]]), float(scene.time[indices[-1]]))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    figure.set_layout_engine("none")  # keep the given positions in every frame
    shown, image = -1, np.empty(0)
    for done, index in enumerate(indices, 1):
        if index != shown:
            _turn_to(figure, scene, int(index))
            canvas.draw()
            image, shown = np.asarray(canvas.buffer_rgba())[..., :3].copy(), index
        if progress:
            progress(done, len(indices))
        yield image


def _turn_to(figure: Figure, scene: Scene, index: int) -> None:
    """Move what moves in a frame to another recorded state."""
    above, below = figure.axes
    if scene.seen_from is None:
        for patch, corners in zip(above.patches, scene.outlines(index), strict=True):
            patch.set_xy(corners)  # pyright: ignore[reportAttributeAccessIssue]
    else:
        paint(above, scene, index)
    draw_links(above, scene, index)
    above.set_title(_words(scene, index), fontsize=9.5, loc="left")
    below.lines[-1].set_xdata([scene.time[index]] * 2)


def _words(scene: Scene, index: int) -> str:
    return plain(f"{scene.name}: {scene.time[index]:.2f} s")


def film_of(response: Response, seen_from: View) -> Scene:
    """Scene of a film: bodies in space from somewhere, others along y."""
    return Scene(response, seen_from if response.dims == "xyz" else None)


def write_gif(
    response: Response,
    path: str | Path,
    *,
    frames_per_second: float = 20.0,
    speed: float = 1.0,
    window: tuple[float, float] | None = None,
    progress: Callable[[int, int], None] | None = None,
    seen_from: View = OBLIQUE,
) -> Path:
    """Write a film as GIF.

    Parameters
    ----------
    response : Response
    path : str or Path
    frames_per_second : float
        [1/s]
    speed : float
        1 is as it was, 0.5 half as fast.
    window : (float, float), optional
        Beginning and end of what the film shows [s]; all by default.
    progress : callable, optional
        Called with (frames drawn, all).
    seen_from : View
        Of what moved in space; the rest is seen along y.
    """
    from PIL import Image

    scene = film_of(response, seen_from)
    # a GIF counts in hundredths of a second; viewers slow down frames of only one
    hundredths = max(2, round(100.0 / check_rate(frames_per_second)))
    indices = frame_indices(scene.time, 100.0 / hundredths, speed, window)
    images: list[Any] = []
    for image in _images(scene, indices, progress):
        images.append(Image.fromarray(image).quantize(64, dither=Image.Dither.NONE))
    target = Path(path)
    with replacing(target) as partial:
        images[0].save(partial, format="GIF", save_all=True, append_images=images[1:], duration=10 * hundredths, loop=0)
    return target


def write_mp4(
    response: Response,
    path: str | Path,
    *,
    frames_per_second: float = 25.0,
    speed: float = 1.0,
    window: tuple[float, float] | None = None,
    progress: Callable[[int, int], None] | None = None,
    seen_from: View = OBLIQUE,
) -> Path:
    """Write a film as MP4; needs the extra ``video``. Parameters as for :func:`write_gif`.

    Raises
    ------
    InputError
        The extra is not installed.
    """
    try:
        import imageio_ffmpeg
    except ImportError:
        raise InputError("an MP4 film needs the extra 'video'; install stylobate[video], or write a GIF.") from None
    scene = film_of(response, seen_from)
    indices = frame_indices(scene.time, frames_per_second, speed, window)
    width, height = (int(side * DOTS_PER_INCH) for side in SIZE)
    target = Path(path)
    with replacing(target) as partial:
        rate: Any = frames_per_second  # fractions are allowed, though the library declares an int
        film = imageio_ffmpeg.write_frames(str(partial), (width, height), fps=rate, macro_block_size=2)
        film.send(None)
        for image in _images(scene, indices, progress):
            film.send(image)
        film.close()
    return target


# -- A film as one HTML page that opens from disk ---------------------------------------------------------------------


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
    script = Markup("".join(here.with_name(script_name).read_text(encoding="utf-8") for script_name in scripts))
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
        Of :func:`stylobate.plots.film.film_of`.
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
        [*end(*mark.lower), *end(*mark.upper), mark.broken if math.isfinite(mark.broken) else None]
        for mark in marks_of(scene)
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


# -- A film that plays where a notebook shows it ----------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Film:
    """The page of a film (:func:`stylobate.plots.film.write_player`), made when it is shown or saved.

    Parameters
    ----------
    response : Response
    frames_per_second, speed, window, seen_from
        As there.
    height : int
        Of the frame in a notebook, in pixels.
    """

    response: Response
    frames_per_second: float = 30.0
    speed: float = 1.0
    window: tuple[float, float] | None = None
    seen_from: View = OBLIQUE
    height: int = 620

    def save(self, path: str | Path) -> Path:
        """Write the page."""
        return write_player(
            self.response,
            path,
            frames_per_second=self.frames_per_second,
            speed=self.speed,
            window=self.window,
            seen_from=self.seen_from,
        )

    @property
    def page(self) -> str:
        """The page, which needs nothing else."""
        with tempfile.TemporaryDirectory() as folder:
            return self.save(Path(folder) / "film.html").read_text(encoding="utf-8")

    def __repr__(self) -> str:
        return f"<Film of {self.response.structure.name}; shows itself in a notebook, film.save(path) writes its page.>"

    def _repr_html_(self) -> str:
        # a frame of its own: the page's scripts see nothing of the notebook, and its style does not reach it
        page = html.escape(self.page, quote=True)
        return (
            f'<iframe sandbox="allow-scripts" srcdoc="{page}" width="100%" height="{self.height}" '
            'style="border: 0" title="film"></iframe>'
        )


# -- A film strip -----------------------------------------------------------------------------------------------------


#: What the picture of one collapse in space is not: debris as such.
ONE_DRAW = "; where pieces lie is one draw of many"

#: Width that the words over a panel take [inch].
WORDS = 0.66

#: Most that the panels take in height, without their words [inch].
TALLEST = 6.0


@styled
def draw_filmstrip(
    response: Response,
    instants: Sequence[float] | None = None,
    *,
    magnification: float | None = None,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """States at chosen instants, with the time and how far the structure has moved.

    That is the displacement of a column's top relative to the ground, and the largest one of an assembly's blocks. What
    moved in space is drawn twice: as seen along y, with x to the right, and against x, with y to the right.

    Parameters
    ----------
    response : Response
    instants : sequence of float, optional
        [s]; the nearest recorded states are drawn. By default up to eight: at rest, at the largest
        displacement in each fifth of the clear motion of a column and before a collapse, or after equal ways of an
        assembly's blocks, and at the end.
    magnification : float, optional
        Factor on all displacements; by default 1, or a round number that makes small ones visible.
    """
    space = response.dims == "xyz"
    scenes = [Scene(response, view) for view in ((ALONG_X, ALONG_Y) if space else (None,))]
    scene = scenes[0]
    frames = telling_states(response) if instants is None else _frames_at(response.time, instants)
    factor = _magnification(scenes) if magnification is None else magnification
    outlines = [[view_scene.outlines(i, factor) for i in frames] for view_scene in scenes]
    stood = np.ptp(np.concatenate([np.concatenate(view_scene.outlines(0)) for view_scene in scenes]), axis=0)
    draw = _strip if stood[1] > TALL * stood[0] and not any(scene.fixed) else _grid
    figure, panels = draw(scenes, outlines, frames, figure)
    peak = max(float(np.nanmax(np.abs(view_scene.way[frames]))) for view_scene in scenes)
    unit, size, places = ("m", 1.0, 2) if peak >= 0.1 else ("mm", 1000.0, 1)

    shown = [(view_scene, i, shapes) for view_scene, strip in zip(scenes, outlines) for i, shapes in zip(frames, strip)]
    for axes, (panel_scene, index, shapes) in zip(panels, shown, strict=True):
        draw_bodies(axes, panel_scene, shapes)
        draw_links(axes, panel_scene, index, factor)
        way = round(size * panel_scene.way[index], places) + 0.0
        far = (signed if scene.signed else digits)(way, f".{places}f")
        along = ("x ", "y ")[scenes.index(panel_scene)] if space and scene.signed else ""
        if space and not scene.signed:
            toward = "xy"[scenes.index(panel_scene)]
            axes.text(0.01, 0.0, f"{toward} →", transform=axes.transAxes, fontsize=6.5, color=GREY, ha="left", va="top")
        words = say("{time:.2f} s\n{along}{far} {unit}", time=scene.time[index], along=along, far=far, unit=unit)
        axes.set_title(words, fontsize=8.5, loc="center")
    suffix = "" if factor == 1.0 else say(" (displacements × {factor:g})", factor=factor)
    suffix += ONE_DRAW * (response.structure.space_joints is not None and response.collapsed)
    figure.suptitle(
        title + suffix if title == " " else in_lines((title or title_of(response)) + suffix),
        x=0.01,
        ha="left",
        fontsize=10.0,
    )
    return figure


#: From this ratio of height to width on, each panel is as wide as what it shows; else all panels have the same view.
TALL = 1.5


def _strip(
    scenes: list[Scene], outlines: list[list[list[np.ndarray]]], frames: list[int], figure: Figure | SubFigure | None
) -> tuple[Figure, list[Axes]]:
    """Panels each as wide as what it shows, all in one scale, in one row if that is not much smaller than in several."""
    stood = np.concatenate([np.concatenate(scene.outlines(0)) for scene in scenes])
    aside, margin = ASIDE * scenes[0].size, 0.35 * float(np.ptp(stood[:, 0]))
    limits = float(stood[:, 0].min()) - aside, float(stood[:, 0].max()) + aside
    spans = [_span(shape, limits, margin) for strip in outlines for shape in strip]
    floor = min(0.0, *(bottom for *_, bottom in spans))
    rows, scale = _rows([high - low for low, high, _, _ in spans], [top - floor for _, _, top, _ in spans], len(frames))
    heights = [max(spans[i][2] for i in row) - floor for row in rows]
    size = (WIDTH, 1.05 * scale * sum(heights) + 0.5 * len(rows) + 0.25)
    figure = page(figure, size)
    shares = [[max(spans[i][1] - spans[i][0], WORDS / scale) for i in row] for row in rows]
    total = max(map(sum, shares))
    panels: list[Axes] = []
    lines = figure.add_gridspec(len(rows), 1, height_ratios=[1.05 * scale * height + 0.5 for height in heights])
    for k, (row, height) in enumerate(zip(rows, heights)):
        rest = max(total - sum(shares[k]), 1e-3 * total)
        cells = lines[k].subgridspec(1, len(row) + 1, width_ratios=[*shares[k], rest])
        for place, (i, share) in enumerate(zip(row, shares[k])):
            middle = 0.5 * (spans[i][0] + spans[i][1])
            axes = figure.add_subplot(cells[place])
            axes.set_xlim(middle - 0.5 * share, middle + 0.5 * share)
            axes.set_ylim(floor - 0.03 * height, floor + 1.02 * height)
            axes.set_anchor("S")
            panels.append(axes)
    return figure, panels


def _rows(widths: list[float], heights: list[float], together: int) -> tuple[list[list[int]], float]:
    """Which panels stand in which row, and the scale of all [inch/m], from their widths and heights [m].

    A strip of so many panels begins a row.
    """
    layouts: dict[int, tuple[list[list[int]], float]] = {}
    least = len(widths) // together
    scale = LARGEST / (1.05 * max(heights))
    while True:
        rows: list[list[int]] = []
        room = -1.0
        for i, width in enumerate(widths):
            taken = max(scale * width, WORDS)
            if taken > room or i % together == 0:
                rows.append([])
                room = 0.96 * WIDTH
            rows[-1].append(i)
            room -= taken
        wide = max(sum(max(scale * widths[i], WORDS) for i in row) for row in rows)
        high = scale * sum(max(heights[i] for i in row) for row in rows)
        smallest = scale * max(heights) < 0.2
        if smallest or (wide <= 0.96 * WIDTH and (len(rows) == least or high <= TALLEST)):
            layouts.setdefault(len(rows), (rows, scale))
            if len(rows) == least or smallest:
                break
        scale *= 0.98
    largest = max(scale for _, scale in layouts.values())
    return layouts[min(count for count, (_, scale) in layouts.items() if scale >= NEARLY * largest)]


#: Fewer rows are taken where the scale is at least this share of the largest.
NEARLY = 0.7

#: Height of the panels of a strip in one row [inch].
LARGEST = 3.2


def _grid(
    scenes: list[Scene], outlines: list[list[list[np.ndarray]]], frames: list[int], figure: Figure | SubFigure | None
) -> tuple[Figure, list[Axes]]:
    """Panels with the same view, in as many rows as make them largest."""
    del outlines
    ends = [scene.view(np.array(frames)) for scene in scenes]
    low, high, bottom, top = (pick(end[k] for end in ends) for k, pick in enumerate((min, max, min, max)))
    n, width, height = len(frames), high - low, top - bottom

    def scale(across: int) -> float:
        return min(0.96 * WIDTH / across / width, TALLEST / (len(scenes) * math.ceil(n / across)) / height)

    across = max(range(1, n + 1), key=scale)
    down = len(scenes) * math.ceil(n / across)
    figure = page(figure, (WIDTH, down * (scale(across) * height + 0.45) + 0.35))
    panels = list(np.ravel(figure.subplots(down, across)))
    for axes in panels:
        axes.set_xlim(low, high)
        axes.set_ylim(bottom, top)
        axes.set_axis_off()
    each = len(panels) // len(scenes)
    return figure, [axes for k in range(len(scenes)) for axes in panels[k * each :][:n]]


def _span(shape: list[np.ndarray], limits: tuple[float, float], margin: float) -> tuple[float, float, float, float]:
    """Left and right end of a panel, with a margin, the highest and the lowest point [m]."""
    corners = np.concatenate(shape)
    corners = corners[np.isfinite(corners).all(axis=1)]
    low, high = (float(np.clip(end, *limits)) for end in (corners[:, 0].min(), corners[:, 0].max()))
    return low - margin, high + margin, float(corners[:, 1].max()), float(corners[:, 1].min())


def _frames_at(recorded: np.ndarray, instants: Sequence[float]) -> list[int]:
    for instant in instants:
        if not recorded[0] <= instant <= recorded[-1]:
            raise InputError(
                f"instant {instant:g} s is not recorded; allowed is {recorded[0]:g} to {recorded[-1]:g} s."
            )
    if not len(instants):
        raise InputError("no instant is given to draw; give at least one [s].")
    return [int(np.abs(recorded - instant).argmin()) for instant in instants]


def _magnification(scenes: list[Scene]) -> float:
    scene, peak = scenes[0], max(float(np.nanmax(np.abs(view_scene.way))) for view_scene in scenes)
    if peak <= 0.0 or peak > 0.02 * scene.size:
        return 1.0
    wanted = 0.05 * scene.size / peak
    decade = 10.0 ** math.floor(math.log10(wanted))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= wanted)
