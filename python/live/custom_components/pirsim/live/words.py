"""Words for states of motion sensors. Written by tools/words/write.py from src/files/read/state_words.hpp."""

ON = frozenset({"on", "true", "yes", "motion", "motion detected", "motion_detected", "det", "detected", "active",
    "occupied", "moving"})
OFF = frozenset({"off", "false", "no", "clear", "no motion", "no_motion", "not detected", "inactive", "vacant",
    "not_detected", "unoccupied", "idle"})
UNKNOWN = frozenset({"", "unavailable", "unknown", "none", "null", "nan", "na", "n/a", "<na>", "-", "?"})
