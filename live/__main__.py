"""``make live``: the page, one file that needs no server and no network."""

from __future__ import annotations

import base64
import json
import re
import sys
import tempfile
import zlib
from pathlib import Path

from .data import data_of
from .link import heap_of
from .module import built

PAGE = Path(__file__).parent / "page"


def write(out: Path, module: bytes) -> Path:
    """Write the page with the engine's module into a folder."""
    data, blob = data_of(module, heap_of(module))
    parts = {path.stem: path.read_text(encoding="utf-8") for path in PAGE.iterdir() if path.suffix in (".js", ".css")}
    parts["data"] = json.dumps(data, ensure_ascii=False).replace("</", "<\\/")
    parts["blob"] = base64.b64encode(zlib.compress(blob, 9)).decode()
    text = re.sub(r"{{(\w+)}}", lambda result: parts[result[1]], (PAGE / "index.html").read_text(encoding="utf-8"))
    out.mkdir(parents=True, exist_ok=True)
    place = out / "column.html"
    place.write_text(text, encoding="utf-8")
    return place


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        made = write(Path(sys.argv[1]), built(Path(folder) / "plane.wasm"))
    print(f"The page is {made} ({made.stat().st_size / 1e6:.1f} MB): open it in a browser.")
