"""The process of a command line: it listens to signals from its first moment, then loads the commands."""

from __future__ import annotations

from . import signals


def main() -> None:
    """Run the command line and end the process."""
    signals.listen()
    try:
        from .main import main as run
    except KeyboardInterrupt:
        signals.end_now(signals.INTERRUPTED)
    else:
        run()
