"""A film that plays where a notebook shows it."""

from __future__ import annotations

import html
import tempfile
from dataclasses import dataclass
from pathlib import Path

from ..response import Response
from .player import write_player
from .view import OBLIQUE, View


@dataclass(frozen=True, eq=False)
class Film:
    """The page of a film (:func:`stylobate.plots.player.write_player`), made when it is shown or saved.

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
