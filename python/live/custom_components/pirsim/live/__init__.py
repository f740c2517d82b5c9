"""Counts people live, by a counter of `pirsim calibrate`: from pirsim_live import Counter."""

from .counter import ClockSteppedBack, Counter, Estimate, Occupancy

__all__ = ["ClockSteppedBack", "Counter", "Estimate", "Occupancy"]
__version__ = "0.2.0"
