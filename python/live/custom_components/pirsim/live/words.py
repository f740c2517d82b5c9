"""Words for states of motion sensors. Written by tools/words/write.py from src/files/read/state_words.hpp."""

ON = frozenset({"on", "true", "yes", "motion", "motion detected", "motion_detected", "motion active", "detected motion",
    "det", "detected", "active", "occupied", "moving", "motion detector", "movement", "present", "t", "y", "ein", "ja",
    "oui", "wahr", "bewegung", "anwesend"})
OFF = frozenset({"off", "false", "no", "clear", "no motion", "no_motion", "motion inactive", "not detected", "inactive",
    "vacant", "not_detected", "unoccupied", "idle", "cleared (no motion detected)", "cleared", "no one", "no movement",
    "absent", "not present", "f", "n", "aus", "nein", "non", "falsch", "keine bewegung", "abwesend"})
UNKNOWN = frozenset({"", "unavailable", "unknown", "none", "null", "nan", "na", "n/a", "<na>", "-", "?"})
LONGEST = 32
