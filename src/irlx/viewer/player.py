"""The clock of the viewer: goes through the rows of a stream in time, stops and begins again."""

from __future__ import annotations

import threading
from collections.abc import Callable
from time import monotonic

_PER_SECOND = 30
"""Pictures a second at most."""


class Player:
    """Time of the run that is shown, s, from 0 to `duration`; `moved` is called with each new one.

    A thread of its own plays; all methods may be called from any thread.
    """

    def __init__(self, duration: float, moved: Callable[[float], None], changed: Callable[[], None]) -> None:
        self.duration, self.speed, self.loops = duration, 1.0, False
        self._moved, self._changed = moved, changed
        self._time = 0.0
        self._begun: tuple[float, float] | None = None
        self._lock = threading.RLock()
        self._wake, self._end = threading.Event(), False
        self._thread = threading.Thread(target=self._run, name="irlx view: player", daemon=True)
        self._thread.start()

    @property
    def time(self) -> float:
        """Time that is shown, s."""
        return self._time

    @property
    def plays(self) -> bool:
        """Whether it is playing."""
        return self._begun is not None

    def seek(self, time: float) -> None:
        """Go to a time, s; goes on playing from there."""
        with self._lock:
            self._time = min(max(time, 0.0), self.duration)
            if self._begun is not None:
                self._begun = monotonic(), self._time
        self._moved(self._time)

    def play(self) -> None:
        """Play on; from the beginning where it stands at the end."""
        with self._lock:
            if self._time >= self.duration:
                self._time = 0.0
            self._begun = monotonic(), self._time
        self._wake.set()
        self._changed()

    def pause(self) -> None:
        """Stop where it is."""
        with self._lock:
            self._begun = None
            self._wake.clear()
        self._changed()

    def set_speed(self, speed: float) -> None:
        """Play so many times as fast as the run, from where it is."""
        with self._lock:
            self.speed = speed
            if self._begun is not None:
                self._begun = monotonic(), self._time

    def restart(self, duration: float) -> None:
        """Show another run: stand at its beginning."""
        with self._lock:
            self.duration, self._time, self._begun = duration, 0.0, None
            self._wake.clear()
        self._changed()
        self._moved(0.0)

    def stop(self) -> None:
        """End the thread."""
        self._end = True
        self._wake.set()
        self._thread.join(timeout=2.0)

    def _run(self) -> None:
        tick = threading.Event()
        while True:
            self._wake.wait()
            if self._end:
                return
            self._step()
            tick.wait(1.0 / _PER_SECOND)

    def _step(self) -> None:
        ended = False
        with self._lock:
            if self._begun is None:
                return
            since, at = self._begun
            time = at + (monotonic() - since) * self.speed
            if time >= self.duration and self.loops and self.duration > 0.0:
                time = 0.0
                self._begun = monotonic(), 0.0
            elif time >= self.duration:
                time, ended = self.duration, True
                self._begun = None
                self._wake.clear()
            self._time = time
        self._moved(time)
        if ended:
            self._changed()
