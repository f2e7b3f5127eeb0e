"""Films of a response: GIF, MP4 with the extra ``video``, and single frames, with the ground's motion, time and scale."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ..atomic import replacing
from ..errors import InputError, check_range
from ..response import Response
from .link_marks import draw_links
from .scene import Scene, draw_bodies, scale_bar, seen
from .solid_frame import draw_solids, paint
from .style import BLACK, BLUE, GREY, RED, plain, styled
from .view import OBLIQUE, View

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
    begin, end = (time[0], time[-1]) if window is None else seen(time, window)
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
