"""Counts who passes a door, by two light barriers in it and by a VL53L1X above it, and tells how that fails.

Simulated passages of single kinds go through the gap of two_rooms.gltf. Of each kind: how many passes a person were
missed, counted once too often or counted the other way round, each with its standard error; and how far the count has
drifted after a day of 100 events, those of DAY. `count_door.py N`: of so many events a kind (default 300).
"""
import math
import random
import sys

import numpy as np
import pirsim

X, Z = 4.5, -1.95  # of the gap; the barriers are in it, the VL53L1X hangs below the ceiling 0.45 m before it
SPAN = (-0.6, 0.15)  # where somebody turns back or lingers, from X
BEAMS = {"barriers": (1, X), "VL53L1X": (5, X - 0.45)}  # ticks of 1/50 s between readings; the line between the two
DAY = {"alone": 78, "through a leaf": 0, "close behind": 8, "abreast": 4, "turns back": 5, "lingers": 5}  # assumed


def scene_with_beams(leaf):
    scene = pirsim.read_scene("two_rooms.gltf")
    scene.sensors = []
    for name in ("LIGHT-BARRIER", "VL53L1X"):
        scene.sensor_models[name] = pirsim.sensor_model(name)
    for i, side in enumerate((-1, 1)):  # the western one first
        across = pirsim.Frame((X + 0.03 * side, 1.2, Z - 0.4), (0.0, 0.0, 1.0, 0.0))
        scene.sensors.append(pirsim.Sensor(f"B{i}", "LIGHT-BARRIER", across))
    for i, side in enumerate((-1, 1)):
        tilt, r = -side * math.atan(0.0831) / 2, math.sqrt(0.5)  # half a field aside; then straight down
        down = (r * math.cos(tilt), -r * math.cos(tilt), r * math.sin(tilt), -r * math.sin(tilt))
        scene.sensors.append(pirsim.Sensor(f"V{i}", "VL53L1X", pirsim.Frame((X - 0.45, 2.45, Z), down)))
    if leaf:
        scene.doors = [pirsim.Door("leaf", pirsim.Frame((X, 0.0, Z), (math.sqrt(0.5), 0.0, -math.sqrt(0.5), 0.0)), 0.9,
                                   opens="outward", state="shut")]  # towards the VL53L1X
    return scene


def event(kind, rng):
    """What everybody does there, as a path [(second, x, z)]."""
    way, speed = rng.choice((-1, 1)), rng.uniform(0.8, 1.4)

    def path(lag, aside, stops=(), back=False):
        t, x, points = lag, -2 * way, [(lag, -2 * way)]
        for to, pause in (*stops, (-2 * way if back else 2 * way, 0.0)):
            t += max(0.02, abs(to - x) / speed)
            points += [(t, to), (t + pause, to)][:2 if pause else 1]
            t, x = t + pause, to
        return [(t, X + x, Z + aside) for t, x in points]

    aside = rng.uniform(-0.15, 0.15)
    if kind == "close behind":
        return [path(0, aside), path(rng.uniform(0.6, 1.5), rng.uniform(-0.15, 0.15))]
    if kind == "abreast":
        return [path(0, 0.22), path(rng.uniform(0, 0.3), -0.22)]
    if kind == "turns back":
        return [path(0, aside, [(rng.uniform(*SPAN), rng.uniform(0.2, 2))], back=True)]
    if kind == "lingers":
        return [path(0, aside, [(rng.uniform(*SPAN), rng.uniform(1, 10)) for _ in range(2)])]
    return [path(0, aside)]


def passes_of(path, line):
    """True ones: 1 whenever somebody's middle crosses the line eastwards, -1 westwards."""
    sides = [x > line for _, x, _ in path]
    return [1 if now else -1 for before, now in zip(sides, sides[1:]) if now != before]


def counted(outer, inner):
    """Who breaks one beam first and leaves the other one last has passed."""
    states = outer + 2 * inner.astype(int)
    passes, first, last = [], 0, 0
    for now in states:
        if now != last:
            first = now if last == 0 else first
            if now == 0 and first in (1, 2) and last == 3 - first:
                passes.append(1 if first == 1 else -1)
            last = now
    return passes


def errors(told, true):
    """Missed, told without a pass, told the other way round; drift."""
    missed = [max(0, true.count(way) - told.count(way)) for way in (1, -1)]
    extra = [max(0, told.count(way) - true.count(way)) for way in (1, -1)]
    turned = [min(missed[0], extra[1]), min(missed[1], extra[0])]
    return sum(missed) - sum(turned), sum(extra) - sum(turned), sum(turned), sum(told) - sum(true)


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    days = {name: np.zeros(2) for name in BEAMS}
    for kind, of_day in DAY.items():
        rng = random.Random(kind)
        script = pirsim.Script(name=kind, seed=1)
        script.sensing.ticks_per_window = 1
        events = [event(kind, rng) for _ in range(n)]
        for i, paths in enumerate(events):
            people = []
            for k, path in enumerate(paths):
                person = pirsim.Person(f"p{k}", stature_m=rng.uniform(1.55, 1.95), style="natural")
                person.actions = [pirsim.Follow(times_s=[t + 1 for t, _, _ in path], points=[p[1:] for p in path])]
                if kind == "through a leaf":  # which only those open who find their way themselves
                    person.actions = [pirsim.Appear(path[0][1:]), pirsim.Walk([path[1][1:]]), pirsim.Wait(5)]
                people.append(person)
            script.trials.append(pirsim.Trial(str(i), people))
        result = pirsim.run(pirsim.compile(scene_with_beams(kind == "through a leaf"), script))
        for j, (name, (ticks, line)) in enumerate(BEAMS.items()):
            bits = result.bits[:, ::ticks, 2 * j:2 * j + 2] * result.valid[:, ::ticks, None]
            true = [[way for path in paths for way in passes_of(path, line)] for paths in events]
            found = np.array([errors(counted(*one.T), passes) for one, passes in zip(bits, true)])
            per = len(events[0])
            shares, se = found[:, :3].mean(0) / per, found[:, :3].std(0) / per / n ** 0.5
            squares = found[:, 3] ** 2.0
            days[name] += of_day * squares.mean(), (of_day * squares.std()) ** 2 / n
            print(f"{kind:14} {name:9}" + "".join(f" {word} {share:.3f} +- {error:.3f}" for word, share, error in
                                                  zip(("missed", "doubled", "reversed"), shares, se)))
    for name, (variance, of_it) in days.items():
        print(f"{name}: rms drift of a day {variance ** 0.5:.2f} +- {of_it ** 0.5 / max(1e-9, 2 * variance ** 0.5):.2f}")


if __name__ == "__main__":
    main()
