"""Counters for the tests, made at random or so that they hardly learn from silence."""

STEP_S, T0 = 30.0, 1_772_409_600.0  # 2026-03-02, midnight


def table(draw, rows, columns):
    values = [[draw.uniform(0.05, 1) for _ in range(columns)] for _ in range(rows)]
    return [value / sum(row) for row in values for value in row]


def random_counter(draw, sensors=3, counts=3, modes=2, rooms=4):
    n = counts * modes
    return {"pirsim_counter": 2, "step_s": STEP_S, "sensors": sensors, "counts": counts, "modes": modes,
            "rooms": [{"room": r, "first": table(draw, 1, n), "moves": table(draw, n, n),
                       "versions": [{"liveliness": odds, "weight": 1 / (2 * rooms), "emissions": table(draw, n, sensors + 1)}
                                    for odds in (0.5, 1.0)]} for r in range(rooms)]}


def with_all_keys(draw):
    """Each key that pirsim calibrate may write."""
    figures = ("occupied_h", "arrival_min", "departure_min", "most", "hour_nobody", "hour_mean", "hour_most")
    return random_counter(draw, sensors=2, counts=2, modes=1, rooms=1) | {
        "sensor_names": ["hall", "desk"], "holds_s": [30.0, None], "warning": "unlike", "expected_error": [0.1, 0.5],
        "figures_off": {name: [0.1, 0.5] for name in figures}}


def doubting_counter(sensors=("hall", "desk")):
    """One who is there moves hardly more sensors than nobody: in silence P(nobody) stays near a half for hours."""
    n = len(sensors)
    quiet = [0.99] + [0.01 / n] * n
    return {"pirsim_counter": 2, "step_s": STEP_S, "sensors": n, "counts": 2, "modes": 1, "sensor_names": list(sensors),
            "rooms": [{"room": 0, "first": [0.467, 0.533], "moves": [0.999, 0.001, 0.001, 0.999],
                       "versions": [{"liveliness": 1.0, "weight": 1.0, "emissions": quiet + [0.9895] + [0.0105 / n] * n}]}]}


def quick_counter(sensors=("hall", "desk")):
    """Sure within minutes: nobody moves hardly a sensor, one person at least one."""
    n = len(sensors)
    return doubting_counter(sensors) | {
        "rooms": [{"room": 0, "first": [0.5, 0.5], "moves": [0.9, 0.1, 0.1, 0.9],
                   "versions": [{"liveliness": 1.0, "weight": 1.0,
                                 "emissions": [0.98] + [0.02 / n] * n + [0.2] + [0.8 / n] * n}]}]}
