#!/usr/bin/python3
"""Hides faults of the second simulator in measurements, and asks `pirsim reconcile` what is wrong with them.

    challenge.py PIRSIM -o DIR [--faults turned,cat] [--seeds 1,2] [--scene SCENE --script SCRIPT] [--budget 0.3 ...]

Options that aren't its own are reconcile's. pirsim gets the rows and nothing else. Each answer is kept in DIR, so that an interrupted challenge goes on. At the end
DIR/scores.csv has a line an analysis, and standard output a table by fault.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys

import numpy as np

import second_simulator as second
from faults import FAULTS

DATA = pathlib.Path(__file__).parents[2] / "data"
COLUMNS = ("fault", "seed", "what", "truth", "score", "verdict", "effects", "p", "closed")


def score(truth, report):
    """How a verdict compares with what was hidden. "in the set": one of several that can't be told apart."""
    verdict, effects = report["verdict"], report["effects"]
    if verdict == "no-disagreement":
        return "nothing seen"
    if verdict == "none-in-catalogue":
        return "unknown"
    if not truth:
        return "set" if verdict == "one-of" else "misnamed"
    right = set(truth) & set(effects)
    if verdict == "one-of":
        return "in the set" if right else "not in the set"
    return "right" if right else "misnamed"


class Challenger:
    def __init__(self, options, of_reconcile):
        self.options, self.scene, self.runs = options, second.Gltf(options.scene), {}
        self.of_reconcile = [*of_reconcile, *([] if "--table" in of_reconcile else ["--table", options.output / "table"])]
        options.output.mkdir(parents=True, exist_ok=True)

    def runs_with(self, settings):
        """Runs, and their measurement with nothing wrong: the same for every fault that leaves the people as they are."""
        if settings not in self.runs:
            study = second.study_of(self.options.scene, self.options.script, ["replicates=1", *settings])
            runs = second.runs_of(self.options.pirsim, study)
            plain = second.Measurement(self.scene, DATA / "sensors", FAULTS["nothing"](None), 0)
            self.runs[settings] = runs, plain
        return self.runs[settings]

    def ask(self, name, seed):
        """A row of the scores."""
        folder = self.options.output / f"{name}-{seed}"
        fault = FAULTS[name](np.random.default_rng([seed, 0]))
        if not (folder / "report.json").exists():
            folder.mkdir(exist_ok=True)
            # Somebody else's people: the script's seed is that of the dataset.
            runs, plain = self.runs_with((f"seed={1000 + seed}", *fault.settings))
            measurement = second.Measurement(self.scene, DATA / "sensors", fault, seed, plain)
            measurement.write(folder / "measured.csv", runs)
            subprocess.run(
                [self.options.pirsim, "reconcile", "--scene", self.options.scene, "--script", self.options.script, "-q",
                 "--measured", folder / "measured.csv", "--out", folder, *self.of_reconcile], check=True,
                stdout=subprocess.DEVNULL)
        report = json.loads((folder / "report.json").read_text())
        verification = report["verification"] or {}
        return dict(zip(COLUMNS, (name, seed, fault.what, " ".join(fault.truth), score(fault.truth, report),
                                  report["verdict"], " ".join(report["effects"]), report["where"]["p"],
                                  int(verification.get("closed", False)))))


def table_of(rows):
    lines = ["| hidden | the catalogue's name | answers |", "|---|---|---|"]
    for name in dict.fromkeys(row["fault"] for row in rows):
        mine = [row for row in rows if row["fault"] == name]
        answers = [row["score"] + (f" ({row['effects'].replace(' ', ', ')})" if row["effects"] else "") for row in mine]
        told = [f"{answers.count(a)} x {a}" if answers.count(a) > 1 else a for a in dict.fromkeys(answers)]
        lines.append(f"| {mine[0]['what']} | {mine[0]['truth'].replace(' ', ', ') or 'none'} | {'; '.join(told)} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pirsim")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, metavar="DIR")
    parser.add_argument("--scene", default=DATA / "rooms/meeting_room.gltf")
    parser.add_argument("--script", default=DATA / "studies/studyA.yaml")
    parser.add_argument("--faults", default=",".join(FAULTS), help="default: all")
    parser.add_argument("--seeds", default="1", help="a dataset each: 1,2,3")
    options, of_reconcile = parser.parse_known_args()
    challenger, rows = Challenger(options, of_reconcile), []
    with open(options.output / "scores.csv", "w", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        out.writeheader()
        for seed in map(int, options.seeds.split(",")):
            for name in options.faults.split(","):
                rows.append(challenger.ask(name, seed))
                out.writerow(rows[-1])
                file.flush()
                print(rows[-1]["fault"], rows[-1]["score"], rows[-1]["effects"], file=sys.stderr)
    print(table_of(rows))


if __name__ == "__main__":
    sys.exit(main())
