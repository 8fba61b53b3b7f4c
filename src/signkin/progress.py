"""The line that tells how far a run is: what is running, done and left, and the time so far.

On a terminal one line that is drawn again each second; elsewhere (a file, a CI job) a line at the
start, one at most each minute while steps end, and one at the end.
"""

from __future__ import annotations

import os
import shutil
import threading
import time
from collections.abc import Callable, Mapping
from typing import TextIO

QUIET_S = 60.0  # between two lines where nobody watches
REDRAWN_S = 1.0
WIPED = "\r\x1b[K"


def watched(stream: TextIO, environment: Mapping[str, str] = os.environ) -> bool:
    """Return whether somebody looks at a stream: a terminal that can go back, not a CI job's."""
    if environment.get("CI") or environment.get("TERM") == "dumb":
        return False
    return stream.isatty()


def clock_words(seconds: float) -> str:
    """Return a length of time as a clock has it: `0:07`, `12:30`, `1:02:03`."""
    minutes, second = divmod(int(seconds), 60)
    hours, minute = divmod(minutes, 60)
    return f"{hours}:{minute:02d}:{second:02d}" if hours else f"{minute}:{second:02d}"


class Progress:
    """How far a run is, told on a stream.

    live: whether the line is drawn in place. now: seconds of a clock that only goes on.
    """

    def __init__(
        self, stream: TextIO, *, live: bool, now: Callable[[], float] = time.monotonic
    ) -> None:
        """Begin to count the time; nothing is written yet."""
        self.stream, self.live, self.now = stream, live, now
        self.began = now()
        self.told_at = self.began
        self.done = self.total = 0
        self.running: dict[int, tuple[str, float]] = {}  # job -> what, since when
        self._drawn = self._ended = False
        self._lock = threading.RLock()

    def plan(self) -> None:
        """Say, to who watches, that it is being found out what there is to do."""
        if self.live:
            with self._lock:
                self._write("Finding out what is to be done ...")
                self._drawn = True

    def planned(self, total: int) -> None:
        """Take the number of steps of the run, and say it."""
        with self._lock:
            self.total = total
            if not self.live:
                self._write(f"{total} step{'s' if total != 1 else ''} to do.\n")
        if self.live:
            threading.Thread(target=self._redraw, daemon=True).start()

    def start(self, job: int, what: str) -> None:
        """A step runs now."""
        with self._lock:
            self.running[job] = (what, self.now())
            self.tell()

    def end(self, job: int) -> str:
        """A step does not run any more; returns what it was, '' if it is not known."""
        with self._lock:
            return self.running.pop(job, ("", 0.0))[0]

    def count(self, done: int, total: int) -> None:
        """So many steps are done."""
        with self._lock:
            self.done, self.total = done, total
            self.tell()

    def say(self, text: str) -> None:
        """Write a message of its own above the line."""
        with self._lock:
            self._write(text.rstrip("\n") + "\n")
            self.tell()

    def tell(self) -> None:
        """Draw the line; where nobody watches, only once in a while."""
        with self._lock:
            if self._ended or not self.total:
                return
            if self.live:
                width = shutil.get_terminal_size().columns - 1
                line = self.line()
                line = line if len(line) <= width else line[: width - 1] + "…"
                self.stream.write(WIPED + line)
                self.stream.flush()
                self._drawn = True
            elif self.done < self.total and self.now() - self.told_at >= QUIET_S:
                self.told_at = self.now()
                self._write(self.line() + "\n")

    def line(self) -> str:
        """Return the line: done and left, time so far, what runs and, past a while, how long."""
        left = self.total - self.done
        out = f"{self.done} of {self.total} steps done, {left} left, {self._elapsed()}"
        names = []
        for what, since in sorted(self.running.values(), key=lambda one: one[1]):
            lasts = self.now() - since
            names.append(f"{what} {clock_words(lasts)}" if lasts >= 10 else what)
        return f"{out}; now {', '.join(names)}" if names else out

    def close(self) -> None:
        """End: the line goes, and what was done in which time stays."""
        with self._lock:
            if self._ended:
                return
            if self.total:
                self._write(f"{self.done} of {self.total} steps done in {self._elapsed()}.\n")
            self._ended = True

    def _elapsed(self) -> str:
        return clock_words(self.now() - self.began)

    def _write(self, text: str) -> None:
        self.stream.write((WIPED if self._drawn else "") + text)
        self.stream.flush()
        self._drawn = False

    def _redraw(self) -> None:
        while not self._ended:
            time.sleep(REDRAWN_S)
            self.tell()
