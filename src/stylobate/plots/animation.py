"""Films of a response: GIF, MP4 with the extra ``video``, and single frames, with the ground's motion, time and scale."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ..atomic import replacing
from ..constants import DEGREE
from ..errors import InputError, check_range
from ..response import Response
from .style import BLACK, BROWN, GREY, RED, SAND, styled

#: Size [inch] and resolution of a frame.
SIZE, DOTS_PER_INCH = (6.4, 4.8), 100

#: Pixels of a frame are counted from the drawn figure; a film of more frames than this is refused.
MOST_FRAMES = 5000


def base_slope(response: Response) -> float:
    """Rise of the base to the right [-]."""
    return math.tan(response.column.as_found.base_tilt * DEGREE)


def outlines(response: Response, index: int) -> list[np.ndarray]:
    """Corners of every drum at a recorded state, counter-clockwise [m], each of shape (k, 2)."""
    return [response.outline(index, drum) for drum in range(response.column.n)]


def frame_indices(response: Response, frames_per_second: float, speed: float) -> np.ndarray:
    """Recorded states that a film shows.

    Raises
    ------
    InputError
        The film would have too many frames.
    """
    check_range("frames per second", frames_per_second, 0.0, 100.0, unit="1/s", open_low=True)
    check_range("speed", speed, 0.0, 1000.0, open_low=True)
    time = response.histories.time
    wanted = np.arange(time[0], time[-1] + 1e-9, speed / frames_per_second)
    if len(wanted) > MOST_FRAMES:
        raise InputError(
            f"the film would have {len(wanted)} frames; allowed are {MOST_FRAMES}: give fewer per second or a higher speed."
        )
    return np.unique(np.abs(np.searchsorted(time, wanted)).clip(0, len(time) - 1))


def view(response: Response, indices: np.ndarray) -> tuple[float, float, float, float]:
    """Left, right, lower and upper end of a picture that holds all states [m]."""
    corners = np.concatenate([np.concatenate(outlines(response, int(i))) for i in indices])
    corners = corners[np.isfinite(corners).all(axis=1)]
    height = response.column.height
    low, high = min(float(corners[:, 0].min()), -0.4 * height), max(float(corners[:, 0].max()), 0.4 * height)
    top = max(float(corners[:, 1].max()), height)
    margin = 0.05 * height
    return low - margin, high + margin, min(float(corners[:, 1].min()), 0.0) - margin, top + margin


@styled
def draw_frame(response: Response, index: int, limits: tuple[float, float, float, float] | None = None) -> Figure:
    """One frame: the drums in true proportion, time, a scale of one metre, and where the ground's motion is.

    Parameters
    ----------
    response : Response
    index : int
        Recorded state.
    limits : tuple, optional
        Left, right, lower and upper end of the picture [m]; by default those that hold this state.
    """
    h = response.histories
    low, high, bottom, top = view(response, np.array([0, index])) if limits is None else limits
    figure = Figure(figsize=SIZE)
    above, below = figure.subplots(2, 1, height_ratios=(4.0, 1.0))
    above.axline((0.0, 0.0), slope=base_slope(response), color=BLACK, linewidth=1.2)
    for corners in outlines(response, index):
        above.fill(corners[:, 0], corners[:, 1], facecolor=SAND, edgecolor=BROWN, linewidth=0.8)
    above.set_xlim(low, high)
    above.set_ylim(bottom, top)
    above.set_aspect("equal")
    above.set_axis_off()
    above.set_title(f"{response.column.name}: {h.time[index]:.2f} s", fontsize=9.5)
    bar = high - 0.04 * (high - low)
    above.plot([bar - 1.0, bar], [top - 0.04 * (top - bottom)] * 2, color=BLACK, linewidth=2.0)
    above.text(bar - 0.5, top - 0.05 * (top - bottom), "1 m", ha="center", va="top", fontsize=8.0)
    below.plot(h.time, h.ground_acceleration / 9.81, color=GREY, linewidth=0.7)
    below.axvline(h.time[index], color=RED, linewidth=1.2)
    below.set_xlim(h.time[0], h.time[-1])
    below.set_xlabel("time [s]")
    below.set_ylabel("ground [g]")
    return figure


def _images(response: Response, indices: np.ndarray) -> Iterator[np.ndarray]:
    """Frames as arrays of colour, shape (height, width, 3)."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    limits = view(response, indices)
    for index in indices:
        figure = draw_frame(response, int(index), limits)
        figure.set_dpi(DOTS_PER_INCH)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        yield np.asarray(canvas.buffer_rgba())[..., :3].copy()


def write_gif(response: Response, path: str | Path, *, frames_per_second: float = 20.0, speed: float = 1.0) -> Path:
    """Write a film as GIF.

    Parameters
    ----------
    response : Response
    path : str or Path
    frames_per_second : float
        [1/s]
    speed : float
        1 is as it was, 0.5 half as fast.
    """
    from PIL import Image

    indices = frame_indices(response, frames_per_second, speed)
    images: list[Any] = []
    for image in _images(response, indices):
        images.append(Image.fromarray(image).quantize(64, dither=Image.Dither.NONE))
    target = Path(path)
    with replacing(target) as partial:
        images[0].save(
            partial, format="GIF", save_all=True, append_images=images[1:], duration=1000.0 / frames_per_second, loop=0
        )
    return target


def write_mp4(response: Response, path: str | Path, *, frames_per_second: float = 25.0, speed: float = 1.0) -> Path:
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
    indices = frame_indices(response, frames_per_second, speed)
    width, height = (int(side * DOTS_PER_INCH) for side in SIZE)
    target = Path(path)
    with replacing(target) as partial:
        rate: Any = frames_per_second  # a broken number of frames per second is allowed, though declared whole
        film = imageio_ffmpeg.write_frames(str(partial), (width, height), fps=rate, macro_block_size=2)
        film.send(None)
        for image in _images(response, indices):
            film.send(np.ascontiguousarray(image))
        film.close()
    return target
