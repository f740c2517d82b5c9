#!/usr/bin/env python3
"""Makes the datasets, trains counters on them, and writes results.csv, tables.md and learning_curve.csv.

See `run` for how it is called and docs/counting.md for what came of it.
"""
import argparse
import csv
import pathlib
import shutil
import subprocess
import sys
import time

import numpy as np
from disagreement import reconciled, table_of
from estimators import LEARNED
from readings import BadInput, first_mornings, read_dataset, read_uci864, whole
from scores import NAMES
from table import Results, equivalent, estimates_of, learning_curve, motion_by_people, real_alone, simulated, trained

ROOT = pathlib.Path(__file__).resolve().parents[2]


def like_uci864(*changes):
    """What `pirsim dataset` is told: the shipped recipe, and what is otherwise."""
    return [ROOT / "data/recipes/uci_like.yaml", *(word for change in changes for word in ("--set", change))]


ONE_ROOM = ("seed=865", "rooms.0.count=1", "days=12", "split={test_days: 0.25}")
ONE_DAY = ("days=1", "split.test_days=0")
NO_EFFECTS = "effects=[]"
EFFECTS_BY_DAY = ("effects=[{missed_triggers: {probability: [0.05, 0.2], sensor: each}, per: day}, "
                  "{false_triggers: {rate_per_s: [0.0005, 0.001], sensor: each}, per: day, chance: 0.3}]")
RECIPES = {"varied": like_uci864(), "one_room": like_uci864(*ONE_ROOM, NO_EFFECTS),
           "one_room_effects": like_uci864(*ONE_ROOM, EFFECTS_BY_DAY), "rooms_only": like_uci864(*ONE_DAY, NO_EFFECTS),
           "paper_motion": like_uci864(*ONE_DAY, "schedule.style=choreographed"),
           "zones": like_uci864(*ONE_DAY, "sensing.response=zones"),
           "zones_by_beam": like_uci864(*ONE_DAY, "sensing.response=zones", "sensing.change_per=beam")}
SMALL = like_uci864("rooms.0.count=3", "days=2", "schedule.to=09:30", "split.test_days=0.5")
REAL = "real: UCI 864"
EQUAL = 8  # mornings in each training set, so that rows of the table differ by what their names say


def options():
    parser = argparse.ArgumentParser(description="train people counters on simulated data and test them")
    parser.add_argument("--small", action="store_true", help="three rooms and two short mornings, in seconds")
    parser.add_argument("--real", type=pathlib.Path, help="UCI 864's Occupancy_Estimation.csv")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("out/count_people"))
    parser.add_argument("--pirsim", help="the program; default: of this build, or on the path")
    parser.add_argument("--draws", type=int, default=10, help="of real units, for the learning curve; default 10")
    parser.add_argument("--reconcile", type=int, default=0, metavar="ROOMS", help="with --real: ask pirsim reconcile "
                        "where so many simulated rooms and the real one disagree; minutes of two cores for each")
    parser.add_argument("--reconcile-options", default="--budget 0.05", help="default: %(default)s")
    return parser.parse_args()


def pirsim_of(given):
    built = [ROOT / "build" / preset / "pirsim" for preset in ("release", "dev")]
    found = given or next((str(p) for p in built if p.exists()), None) or shutil.which("pirsim")
    if not found:
        sys.exit("no pirsim found: build it (tools/demo), or give --pirsim")
    return found


def made(pirsim, recipe, folder):
    """The dataset of a recipe, made if it isn't there yet."""
    if not (folder / "datapackage.json").exists():
        started = time.monotonic()
        subprocess.run([pirsim, "dataset", *recipe, "-o", folder, "--resume", "--sensors", ROOT / "data/sensors", "-q"],
                       check=True)
        print(f"{folder.name}: made in {time.monotonic() - started:.0f} s", file=sys.stderr)
    return read_dataset(folder)


def spread(train, test):
    """Mean absolute error of counters that were each trained on one room: how far it depends on the room."""
    errors = {}
    for room in dict.fromkeys(p.stretch.room for p in train):
        own = [p for p in train if p.stretch.room == room]
        for name in ("boosted trees", "hidden Markov"):
            _, people, estimates = estimates_of(trained(name, own), test)
            errors.setdefault(name, []).append(np.abs(people - estimates).mean())
    lines = ["| estimator | rooms | least | median | most |", "|---|---|---|---|---|"]
    lines += [f"| {name} | {len(e)} | {min(e):.2f} | {np.median(e):.2f} | {max(e):.2f} |" for name, e in errors.items()]
    return "\n".join(lines)


def motion_table(sets):
    lines = ["| data | people | sensor that sees more | that sees less | either |", "|---|---|---|---|---|"]
    for name, stretches in sets.items():
        all_rooms = motion_by_people(stretches)
        for n in sorted({line[1] for line in all_rooms}):
            seen = np.array([line[2:] for line in all_rooms if line[1] == n and not np.isnan(line[2])])
            if len(seen) == 0:
                continue
            cells = [f"{np.median(c):.3f}" + (f" ({c.min():.3f}-{c.max():.3f})" if len(c) > 1 else "") for c in seen.T]
            lines.append(f"| {name} | {n} | {' | '.join(cells)} |")
    return "\n".join(lines)


def equivalent_table(results, lines, trainings):
    table = [f"| trained on | {' | '.join(LEARNED)} |", "|---|" + "---|" * len(LEARNED)]
    for row in trainings:
        cells = [equivalent(lines, name, results.value(row, name, REAL, "mean absolute error")) for name in LEARNED]
        table.append(f"| {row} | {' | '.join(cells)} |")
    return "\n".join(table)


def real_column(results, real, varied, trainings, arguments, sections):
    real_alone(results, real, REAL)
    units = len(set(np.concatenate([s.units for s in real])))
    shares = [max(1, round(units * share)) for share in (0.1, 0.25, 0.5)]
    lines = learning_curve(real, varied, sorted(set(shares)), arguments.draws)
    lines += learning_curve(real, [], [n for n in (1, 2, 3, 4, 6, 8, 10, 12) if n < units], arguments.draws)
    with open(arguments.output / "learning_curve.csv", "w", newline="") as file:
        out = csv.DictWriter(file, list(lines[0]))
        out.writeheader()
        out.writerows(lines)
    table = ["| trained on | estimator | mean absolute error | least and most of the draws |", "|---|---|---|---|"]
    for line in lines:
        name = f"{'varied rooms + ' if line['with simulated'] else ''}{line['real units']} of {units} real units"
        table.append(f"| {name} | {line['estimator']} | {line['error']:.2f} | {line['low']:.2f}-{line['high']:.2f} |")
    sections += ["## Real units added", "\n".join(table),
                 f"## Equivalent real units: how many of {units} train as good a counter",
                 equivalent_table(results, lines, trainings)]


def disagreement_table(pirsim, folder, real, arguments):
    """folder: of the dataset with varied rooms."""
    reports = {}
    for scene in sorted((folder / "rooms").glob("*.gltf"))[:arguments.reconcile]:
        reports[scene.stem] = reconciled(pirsim, scene, real, arguments.output / "reconcile" / scene.stem,
                                         arguments.reconcile_options.split())
    return table_of(reports)


def main():
    arguments = options()
    # What is given is read before the work, so that a fault in it costs no time.
    try:
        real = read_uci864(arguments.real) if arguments.real else []
    except BadInput as error:
        sys.exit(f"count_people: {error}")
    arguments.output.mkdir(parents=True, exist_ok=True)
    pirsim = pirsim_of(arguments.pirsim)
    recipes = {"varied": SMALL} if arguments.small else RECIPES
    started = time.monotonic()
    data = {}
    for name, recipe in recipes.items():
        data[name] = made(pirsim, recipe, arguments.output / "datasets" / ("small" if arguments.small else name))
    train = {name: whole(parts["train"]) for name, parts in data.items()}
    trainings = {"rooms and effects varied": train["varied"]}
    tests = {"new days": (whole(data["varied"]["test_days"]), False),
             "new rooms": (whole(data["varied"]["test_rooms"]), True)}
    if not arguments.small:
        rows = {"one room, no variation": "one_room", "one room, effects varied": "one_room_effects",
                "rooms varied, no effects": "rooms_only", "rooms and effects varied": "varied",
                "the same, the paper's motion": "paper_motion", "the same, hard zones": "zones",
                "the same, hard zones by beam": "zones_by_beam"}
        trainings = {row: first_mornings(train[name], EQUAL) for row, name in rows.items()}
        trainings["rooms and effects varied, twice the mornings"] = first_mornings(train["varied"], 2 * EQUAL)
        tests["new rooms, hard zones"] = (whole(data["zones"]["test_rooms"]), True)
    if real:
        tests[REAL] = (whole(real), True)
    results, sections = Results(), []
    simulated(results, trainings, tests)
    results.write(arguments.output / "results.csv")
    if len(trainings) > 1:
        sections += ["## Mean absolute error beyond that of rooms and effects varied (95 % interval over days)",
                     results.differences("rooms and effects varied", list(tests))]
    sets = {name: sum(parts.values(), []) for name, parts in data.items()}
    if real:
        real_column(results, real, train["varied"], trainings, arguments, sections)
        sets[REAL] = real
        sections += ["## Trained on one room each, tested on the real data",
                     spread(train["varied"], whole(real))]
        if arguments.reconcile:
            folder = arguments.output / "datasets" / ("small" if arguments.small else "varied")
            sections += ["## What `pirsim reconcile` says of simulated rooms and the real day",
                         disagreement_table(pirsim, folder, real, arguments)]
    sections += ["## Trained on one room each, tested on new rooms",
                 spread(train["varied"], tests["new rooms"][0]),
                 "## P(motion in 30 s | people): median of rooms (least-most)", motion_table(sets)]
    results.write(arguments.output / "results.csv")
    tables = [f"## {name.capitalize()} (95 % interval over days)\n\n{results.markdown(name)}" for name in NAMES]
    (arguments.output / "tables.md").write_text("\n\n".join([*tables, *sections]) + "\n")
    print(f"{arguments.output}/tables.md, after {time.monotonic() - started:.0f} s")


if __name__ == "__main__":
    main()
