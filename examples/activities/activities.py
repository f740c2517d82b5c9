#!/usr/bin/env python3
"""Makes homes, trains a recogniser of activities on some, and tests it on the others. See README.md."""
import argparse
import pathlib
import shutil
import subprocess
import sys

import numpy as np
from events import BadInput, features, here, read_homes, time_of_day
from sklearn.dummy import DummyClassifier
from sklearn.ensemble import RandomForestClassifier
from sklearn.metrics import confusion_matrix, precision_recall_fscore_support
from sklearn.model_selection import GroupKFold

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SMALL = ["--set", "rooms.0.count=6", "--set", "rooms.1.count=1", "--set", "days=1", "--response", "zones", "--set",
         "sensing.tick_rate_hz=10"]
FOLDS = 4
# What each recogniser knows. All but the first are the same forest, so that rows differ by what their names say.
KNOWS = {"nothing: the most frequent activity": lambda s: np.zeros((len(s.seconds), 1)),
         "the time of day": time_of_day,
         "the kind of room": here,
         "the kind of room and the time of day": lambda s: np.hstack([here(s), time_of_day(s)]),
         "the last events as well": features}
NOTHING, *_, SIMPLE, ALL = KNOWS


def options():
    parser = argparse.ArgumentParser(description="recognise activities in simulated homes that nobody trained on")
    parser.add_argument("--small", action="store_true", help="seven homes and one day, in seconds: to try the program")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("out/activities"))
    parser.add_argument("--data", type=pathlib.Path, help="a dataset of homes that is there, instead of making one")
    parser.add_argument("--pirsim", help="the program; default: of this build, or on the path")
    return parser.parse_args()


def pirsim_of(given):
    built = [ROOT / "build" / preset / "pirsim" for preset in ("release", "dev")]
    found = given or next((str(p) for p in built if p.exists()), None) or shutil.which("pirsim")
    if not found:
        sys.exit("no pirsim found: build it (tools/demo), or give --pirsim")
    return found


def made(arguments):
    """The folder of the dataset, made if it isn't there yet."""
    folder = arguments.data or arguments.output / ("small" if arguments.small else "homes")
    if not arguments.data and not (folder / "datapackage.json").exists():
        subprocess.run([pirsim_of(arguments.pirsim), "dataset", HERE / "homes.yaml", "-o", folder, "--resume",
                        "--sensors", ROOT / "data/sensors", *(SMALL if arguments.small else [])], check=True)
    return folder


def labels(home):
    """What its only resident does at each event."""
    return np.array([activity for stretch in home.stretches for done in stretch.done for activity in done])


def recognised(knows, train, test):
    """By test home, what happens at each event, by a recogniser that learned from homes with one resident."""
    known = KNOWS[knows]
    # Leaves of 20 events: chosen, as the features, on other homes (seed 7) than those of the tables.
    forest = RandomForestClassifier(100, min_samples_leaf=20, class_weight="balanced", random_state=1)
    model = DummyClassifier() if knows == NOTHING else forest
    model.fit(np.vstack([known(s) for home in train for s in home.stretches]), np.hstack([labels(h) for h in train]))
    return {home.name: model.predict(np.vstack([known(s) for s in home.stretches])) for home in test}


def recognised_unseen(knows, homes):
    """The same for each of the homes, trained on the other folds' homes: never on one that it is tested on."""
    names = np.array([home.name for home in homes])
    found = {}
    for train, test in GroupKFold(min(FOLDS, len(homes))).split(homes, groups=names):
        found |= recognised(knows, [homes[i] for i in train], [homes[i] for i in test])
    return found


def scores(homes, found):
    """float [home, 2]: share of events that are right, and its mean over the activities that the home has."""
    lines = []
    for home in homes:
        truth = labels(home)
        right = truth == found[home.name]
        lines.append([right.mean(), np.mean([right[truth == activity].mean() for activity in np.unique(truth)])])
    return np.array(lines)


def right_of_any(homes, found):
    """float [home]: share of events at which anybody does what was recognised."""
    return np.array([np.mean([what in done for what, done in
                              zip(found[home.name], [d for s in home.stretches for d in s.done])]) for home in homes])


def mean(values):
    """With its standard error over homes."""
    text = f"{np.mean(values):.2f}"
    return text if len(values) < 2 else f"{text} ± {np.std(values, ddof=1) / np.sqrt(len(values)):.2f}"


def main_table(alone, together, found):
    lines = ["| a recogniser that knows | accuracy | balanced accuracy | two residents: accuracy |", "|---|---|---|---|"]
    for knows in KNOWS:
        accuracy, balanced = scores(alone, found[knows]).T
        cells = [mean(accuracy), mean(balanced)]
        cells.append(mean(right_of_any(together, recognised(knows, alone, together))) if together else "")
        lines.append(f"| {knows} | {' | '.join(cells)} |")
    gain = scores(alone, found[ALL]) - scores(alone, found[SIMPLE])
    lines.append(f"| *the last row less the one before* | {mean(gain[:, 0])} | {mean(gain[:, 1])} | |")
    return lines


def activity_tables(alone, found):
    truth = np.hstack([labels(home) for home in alone])
    names = np.unique(truth)
    guess = {knows: np.hstack([found[knows][home.name] for home in alone]) for knows in (SIMPLE, ALL)}
    of = {knows: precision_recall_fscore_support(truth, guessed, labels=names, zero_division=0)
          for knows, guessed in guess.items()}
    lines = ["| activity | events | precision | recall | F1 | F1 by room and time |", "|---|---:|---:|---:|---:|---:|"]
    for i, name in enumerate(names):
        precision, recall, f1, events = (of[ALL][k][i] for k in range(4))
        lines.append(f"| {name} | {events} | {precision:.2f} | {recall:.2f} | {f1:.2f} | {of[SIMPLE][2][i]:.2f} |")
    lines.append(f"| mean | | | | {of[ALL][2].mean():.2f} | {of[SIMPLE][2].mean():.2f} |")
    shares = 100 * confusion_matrix(truth, guess[ALL], labels=names, normalize="true")
    lines += ["", "Of 100 events of a row, so many were recognised as:", "```text",
              " " * 11 + "".join(f"{name[:8]:>9}" for name in names)]
    lines += [f"{name:<11}" + "".join(f"{share:9.0f}" for share in row) for name, row in zip(names, shares)]
    return [*lines, "```"]


def main():
    arguments = options()
    folder = made(arguments)
    try:
        homes = read_homes(folder)
    except (BadInput, OSError) as error:
        sys.exit(f"activities: {error}")
    alone = [home for home in homes if home.is_of_one()]
    together = [home for home in homes if not home.is_of_one()]
    if len(alone) < 2:
        sys.exit(f"activities: {folder} has {len(alone)} homes of one person; 2 are needed, one to train on")
    found = {knows: recognised_unseen(knows, alone) for knows in KNOWS}
    text = "\n".join([*main_table(alone, together, found), "", *activity_tables(alone, found)])
    arguments.output.mkdir(parents=True, exist_ok=True)
    (arguments.output / "tables.md").write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    main()
