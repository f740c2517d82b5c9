"""Counts people as warm blobs in the frames of a thermal array under the ceiling, in simulated rooms.

Each room of rooms.yaml is simulated with 0 to 5 people, who sit and work, or stand. Threshold and size of a blob are
chosen on half of the rooms, the error is that in the others, beside a counter that always says the same number and one
that sees the two PIR sensors of the same rooms. `count_heads.py ROOMS [MODEL [FILE...]]`: of so many rooms (default
40), with another array (AMG8833); then the same counter, as it has learned, on files of thermo-presence's frames (.h5;
github.com/PUTvision/thermo-presence, needs pandas and tables).
"""
import pathlib
import random
import sys

import numpy as np
import pirsim
from scipy import ndimage

MINUTES = 2.0
MOST = 5


def people_of(scene, n, rng):
    """n people on seats of their own; one in four stands instead, where a seat is left free."""
    seats = rng.sample([seat.id for seat in scene.seats], n)
    people = []
    for i, seat in enumerate(seats):
        person = pirsim.Person(id=f"p{i}", style="natural", stature_m=rng.uniform(1.6, 1.9))
        person.warmth.clothing_clo = rng.uniform(0.5, 1.0)
        activity = rng.choice(["typing", "reading", "meeting"])
        person.actions = [pirsim.Appear(place=seat), pirsim.Work(duration_s=60 * MINUTES + 60, activity=activity)]
        if rng.random() < 0.25:
            person.actions.append(pirsim.Rise(at_s=60 * MINUTES * rng.random()))
        people.append(person)
    return people


def simulated(scene, number):
    """Frames of the last second, less those of the empty room, and shares of seconds with motion: one a count."""
    rng = random.Random(number)
    script = pirsim.Script(name="count_heads", seed=number)
    script.sensing.tick_rate_hz = script.sensing.ticks_per_window = 10
    script.sensing.ambient_c = rng.uniform(21, 25)
    script.trials = [pirsim.Trial(id=str(n), people=people_of(scene, n, rng), duration_s=60 * MINUTES)
                     for n in range(MOST + 1)]
    result = pirsim.run(pirsim.compile(scene, script), frames=True)
    (stack,) = result.frames.values()
    last = np.nanmean(stack[:, -8:], axis=1)
    return last[1:] - last[0], result.bits.mean(axis=1)[1:], result.people[1:, -1]


def blobs(frame, threshold_k, area):
    """Every blob counts once, and once more for each further `area` pixels."""
    labels, n = ndimage.label(ndimage.gaussian_filter(np.nan_to_num(frame), 0.5) > threshold_k)
    sizes = ndimage.sum_labels(np.ones_like(frame), labels, range(1, n + 1)) if n else np.array([])
    return int(sum(max(1, round(size / area)) for size in sizes if size >= 0.25 * area))


def public_frames(file):
    """Frames less their own median, and how many people are in each; a table's rows have `data` and people's `points`."""
    import pandas
    table = pandas.read_hdf(file)
    frames = np.stack(table["data"].to_list()).astype(float)
    return frames - np.nanmedian(frames, axis=(1, 2), keepdims=True), np.array([len(each) for each in table["points"]])


def error(guess, truth):
    return float(np.mean(np.abs(np.asarray(guess, float) - truth)))


def main():
    n_rooms = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    recipe = pathlib.Path(__file__).with_name("rooms.yaml")
    parts = {True: [], False: []}
    for number in range(1, n_rooms + 1):
        scene = pirsim.room(recipe, number)
        array = scene.arrays[0]
        above = np.mean([seat.world_from_seat.origin for seat in scene.seats], axis=0)  # where somebody would hang it
        array.world_from_sensor.origin = (above[0], array.world_from_sensor.origin[1], above[2])
        if len(sys.argv) > 2:
            scene.sensor_models[sys.argv[2]] = pirsim.sensor_model(sys.argv[2])
            array.model = sys.argv[2]
        frames, motion, people = simulated(scene, number)
        parts[number % 2 == 1] += [(frame, shares, n) for frame, shares, n in zip(frames, motion, people)]
    train, test = parts[True], parts[False]
    known = np.array([n for _, _, n in train])
    truth = np.array([n for _, _, n in test])

    pixels = train[0][0].size
    tries = [(threshold, area) for threshold in np.arange(0.3, 3.1, 0.15) for area in pixels * np.array(
        [0.004, 0.007, 0.01, 0.015, 0.02, 0.027, 0.035, 0.045, 0.06])]
    best = min(tries, key=lambda one: error([blobs(frame, *one) for frame, _, _ in train], known))
    guesses = np.array([blobs(frame, *best) for frame, _, _ in test])

    by_motion = np.array([np.append(shares, 1.0) for _, shares, _ in train])
    weights = np.linalg.lstsq(by_motion, known, rcond=None)[0]
    by_pir = np.clip(np.array([np.append(shares, 1.0) for _, shares, _ in test]) @ weights, 1, MOST)
    pir = np.rint(by_pir)
    print(f"{len(train)} frames of {n_rooms - n_rooms // 2} rooms to learn from, {len(test)} of {n_rooms // 2} others")
    print(f"threshold {best[0]:.1f} K, {best[1]:.0f} pixels a person")
    lines = [("constant", np.full(len(truth), np.median(known)), truth), ("PIR", pir, truth), ("blobs", guesses, truth)]
    for file in sys.argv[3:]:
        frames, people = public_frames(file)
        lines.append((pathlib.Path(file).stem, np.array([blobs(frame, *best) for frame in frames]), people))
    for name, guess, truth in lines:
        print(f"{name:9} mean error {error(guess, truth):.2f} +- {np.std(np.abs(guess - truth)) / len(truth) ** 0.5:.2f} "
              f"people, right {np.mean(guess == truth):.0%}")


if __name__ == "__main__":
    main()
