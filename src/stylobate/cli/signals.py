"""What a command does when it is told to stop: SIGTERM and SIGHUP as Ctrl-C, and an answer within a second.

Python hands a signal to the main thread between two of its instructions, and a compiled loop is one. So a thread of its
own hears of each signal as well; where the main thread has not ended in time, it writes what the ledgers have not written
yet, removes the temporary files of this process, and ends it.
"""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

#: Time that the main thread has to end by itself [s].
PATIENCE = 0.8

#: Signals that stop a command; each where the system has it and nobody has turned it off.
STOPPING = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")

#: Stack of sentences about what the running command has kept so far; the last one is printed.
KEPT: list[str] = []

#: Whether this process has been told to stop: what goes wrong after that is no fault.
TOLD = threading.Event()

_said = threading.Event()


def listen(interrupted: int) -> None:
    """Stop at every such signal, within a second; for the main thread of a process.

    Parameters
    ----------
    interrupted : int
        Exit code after an interrupt.
    """
    heard = set()
    for number in (getattr(signal, name) for name in STOPPING if hasattr(signal, name)):
        if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):  # not below nohup: ignored there
            signal.signal(number, _stop)
            heard.add(int(number))
    ear, mouth = socket.socketpair()
    mouth.setblocking(False)
    signal.set_wakeup_fd(mouth.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=_watch, args=(ear, mouth, heard, interrupted), name="signals", daemon=True).start()


@contextmanager
def keeping(sentence: str) -> Iterator[None]:
    """What is said inside the block if the command is stopped there."""
    KEPT.append(sentence)
    try:
        yield
    finally:
        KEPT.remove(sentence)


def said() -> None:
    """Say that a person has been told how the command ended: what is left is to end."""
    _said.set()


def sentence() -> str:
    """What is said of an interrupt that brings no words of its own."""
    return KEPT[-1] if KEPT else "interrupted; nothing is kept."


def _stop(number: int, frame: object) -> None:
    TOLD.set()
    raise KeyboardInterrupt


def _watch(ear: socket.socket, _: socket.socket, heard: set[int], interrupted: int) -> None:
    while heard.isdisjoint(ear.recv(64)):
        pass
    time.sleep(PATIENCE)
    end_now(interrupted)


def end_now(code: int, leave: Callable[[int], object] = os._exit) -> None:
    """End the process without its main thread; what is finished is on disk, what is half-written is removed."""
    ledgers, atomic = sys.modules.get("stylobate.campaign.ledger"), sys.modules.get("stylobate.atomic")
    for book in list(ledgers.OPEN) if ledgers else ():
        # With a time limit: a disk that does not answer must not keep the process alive.
        writing = threading.Thread(target=book.flush, daemon=True)
        writing.start()
        writing.join(PATIENCE)
    for partial in list(atomic.PARTIAL) if atomic else ():
        with suppress(OSError):
            partial.unlink(missing_ok=True)
    with suppress(Exception):
        if not _said.is_set():
            shown = (
                "\r\x1b[2K\x1b[?25h" if sys.stderr.isatty() else ""
            )  # erase the progress bar and show the cursor again
            os.write(2, f"{shown}stylobate: {sentence()}\n".encode(errors="replace"))
        sys.stdout.flush()
    leave(code)
