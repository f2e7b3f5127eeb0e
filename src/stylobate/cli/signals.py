"""End of a command by a signal: SIGTERM and SIGHUP as Ctrl-C, and an answer within a second.

Python hands a signal to the main thread between two of its instructions, as an exception. Two things can keep that from
stopping anything. A compiled loop is one instruction: so a thread of its own hears of each signal as well; where the main
thread has not ended in time, it writes what the ledgers have not written yet, removes the temporary files of this process,
and ends it. And Python throws an exception away that is raised while it clears away an object (``__del__``, the callback
of a weak reference): that is seen by a hook, and the same thread sends the signal again.
"""

from __future__ import annotations

import _thread
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

#: Exit code after an interrupt.
INTERRUPTED = 130

#: Time that the main thread has to end by itself [s].
PATIENCE = 0.8

#: Signals that stop a command; each where the system has it and nobody has turned it off.
STOPPING = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")

#: Stack of sentences about what the running command has kept so far; the last one is printed.
KEPT: list[str] = []

#: Whether this process has been told to stop: what goes wrong after that is no fault.
STOP_SIGNALLED = threading.Event()

_ended = threading.Event()

#: The interrupt was raised where Python throws exceptions away: it is to be raised again.
_thrown_away = threading.Event()

#: Time until the signal is sent again, in which the clearing away ends [s].
_AGAIN = 0.005


def listen(interrupted: int = INTERRUPTED) -> None:
    """Stop at every such signal, within a second; for the main thread of a process. A second call does nothing.

    Parameters
    ----------
    interrupted : int
        Exit code.
    """
    if sys.unraisablehook is _not_raised:
        return
    sys.unraisablehook = _not_raised
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
    """Sentence inside the block if the command is stopped there."""
    KEPT.append(sentence)
    try:
        yield
    finally:
        KEPT.remove(sentence)


def mark_ended() -> None:
    """Say that a person has been told how the command ended: what is left is to end."""
    _ended.set()


def sentence() -> str:
    """Sentence for an interrupt that brings no words of its own."""
    return KEPT[-1] if KEPT else "interrupted; nothing is kept."


def _stop(number: int, frame: object) -> None:
    # Once, so that a second signal does not break the clean-up of the first; and not when there is nothing left to stop.
    if _ended.is_set() or (STOP_SIGNALLED.is_set() and not _thrown_away.is_set()):
        return
    STOP_SIGNALLED.set()
    _thrown_away.clear()
    raise KeyboardInterrupt


def _not_raised(what: sys.UnraisableHookArgs) -> None:
    """In place of ``sys.unraisablehook``: told of exceptions that Python throws away."""
    if what.exc_type is KeyboardInterrupt and STOP_SIGNALLED.is_set():
        _thrown_away.set()
    elif not STOP_SIGNALLED.is_set():
        sys.__unraisablehook__(what)


def _watch(ear: socket.socket, _: socket.socket, heard: set[int], interrupted: int) -> None:
    while not (numbers := heard.intersection(ear.recv(64))):
        pass
    end = time.monotonic() + PATIENCE
    while (time_left := end - time.monotonic()) > 0.0:
        if _thrown_away.wait(time_left):
            time.sleep(_AGAIN)
            _send(min(numbers))
    end_now(interrupted)


def _send(number: int) -> None:
    """Send a signal to the main thread of this process; it wakes one that waits where the system can do that."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        _thread.interrupt_main(signal.Signals(number))


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
        if not _ended.is_set():
            shown = (
                "\r\x1b[2K\x1b[?25h" if sys.stderr.isatty() else ""
            )  # erase the progress bar and show the cursor again
            os.write(2, f"{shown}stylobate: {sentence()}\n".encode(errors="replace"))
        sys.stdout.flush()
    leave(code)
