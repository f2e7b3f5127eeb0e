"""One command line inside this process: its exit code, and what it printed."""

from __future__ import annotations

import contextlib
import io
import json
from collections.abc import Sequence
from typing import NamedTuple

from stylobate.cli.main import call

from .target import Fault


class Ended(NamedTuple):
    """How a command ended."""

    code: int
    out: str
    err: str


def command(arguments: Sequence[str]) -> Ended:
    """Run a command line; raises :class:`Fault` where it does not end as the documentation says."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = call(list(arguments))
    ended = Ended(code, out.getvalue(), err.getvalue())
    line = " ".join(map(repr, arguments))
    if code not in (0, 2) or "Traceback" in ended.err or "fault of stylobate" in ended.err:
        raise Fault(f"exit code {code} of: {line}\n{ended.err[-3000:]}")
    if code == 2:
        sentences = [sentence for sentence in ended.err.splitlines() if not sentence.startswith("stylobate: warning: ")]
        if len(sentences) != 1 or not sentences[0].startswith("stylobate: ") or ended.out:
            raise Fault(f"not one sentence from: {line}\n{ended.err[-3000:]}{ended.out[-300:]}")
    elif "--json" in arguments and "--help" not in arguments:
        try:
            json.loads(ended.out, parse_constant=lambda constant: (_ for _ in ()).throw(ValueError(constant)))
        except ValueError as error:
            raise Fault(f"no JSON from: {line}\n{ended.out[-300:]}") from error
    return ended
