"""A room that is counted now, by a clock that may step: what the bridge and Home Assistant's component share."""

from __future__ import annotations

import logging
import time
from typing import Any, Callable, Mapping

from .counter import LONGEST_GUESS_S, Counter, Occupancy, State

_MOST_MISSED = 720  # readings that a saved state may be old; assumed (six hours of 30 s; 1 to 24 h)
_log = logging.getLogger("pirsim_live")


class LiveRoom:
    """A counter and the occupancy. Not for several threads.

    Call update() at least once a second. All is unknown again, and the counter begins anew, when the clock steps by more
    than a reading (at least a second, at most five minutes), or nobody called for five minutes.
    """

    def __init__(self, counter: Counter, off_at: float = 0.9, *, clock: Callable[[], float] = time.time,
                 monotonic: Callable[[], float] = time.monotonic) -> None:
        """clock: seconds since 1970, which may step; monotonic never does. Raises ValueError."""
        self.counter, self.occupancy = counter, Occupancy(off_at)
        self._clock, self._monotonic = clock, monotonic
        self._tolerance_s = min(max(1.0, counter.step_s), LONGEST_GUESS_S)
        self._looked = clock(), monotonic()

    def update(self, states: Mapping[str, State] | None = None) -> bool:
        """From now on these sensors have these states. Whether there is news: a reading has ended, or somebody came."""
        now, ticks = self._clock(), self._monotonic()
        unseen_s = ticks - self._looked[1]
        stepped_s = now - self._looked[0] - unseen_s
        behind_s = self.counter.time - now
        self._looked = now, ticks
        was_on = self.occupancy.is_on
        if max(abs(stepped_s), behind_s) > self._tolerance_s or unseen_s > LONGEST_GUESS_S:
            _log.warning("the clock stepped by %.0f s, or nobody looked for %.0f s: all is unknown, and counting begins anew",
                         stepped_s, unseen_s)
            self.counter.reset()
            self.occupancy.is_on = None
        ended = self.counter.update(max(now, self.counter.time), states)
        for estimate in ended:
            self.occupancy.update(estimate)
        if any((states or {}).values()):
            self.occupancy.motion()
        return bool(ended) or self.occupancy.is_on is not was_on

    def forget(self) -> bool:
        """From now on nothing is known of any sensor until it is heard again: a connection was lost. As update()."""
        return self.update(dict.fromkeys(self.counter.sensors))

    def state(self) -> dict[str, Any]:
        """What restore() takes, as JSON can hold it."""
        return {**self.counter.state(), "occupancy": self.occupancy.is_on}

    def restore(self, state: Any) -> None:
        """Goes on where state() was taken, with the occupancy if that was at most five minutes ago. Raises ValueError for
        what isn't such a state, is ahead of the clock, or older than 720 readings; then all is unknown."""
        try:
            self.counter.restore(state)
            age_s = self._clock() - self.counter.time
            if not -self._tolerance_s <= age_s <= _MOST_MISSED * self.counter.step_s:
                raise ValueError(f"it was saved {abs(age_s):.0f} s {'ago' if age_s > 0 else 'ahead of the clock'}")
            if not isinstance(is_on := state.get("occupancy"), (bool, type(None))):
                raise ValueError("occupancy: expected true, false or null")
            self.occupancy.is_on = is_on if age_s <= LONGEST_GUESS_S else None
        except ValueError:
            self.counter.reset()
            self.occupancy.is_on = None
            raise
