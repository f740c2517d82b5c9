"""Counts people live, by a counter of `pirsim calibrate`: from pirsim_live import Counter."""

from .counter import ClockSteppedBack, Counter, Estimate, Occupancy
from .room import LiveRoom

__all__ = ["ClockSteppedBack", "Counter", "Estimate", "LiveRoom", "Occupancy"]
__version__ = "0.2.0"
