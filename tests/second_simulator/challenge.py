#!/usr/bin/python3
"""Hides faults of the second simulator in measurements, and asks `pirsim reconcile` what is wrong with them.

    challenge.py PIRSIM -o DIR [--faults turned,cat] [--seeds 1,2] [--scene SCENE --script SCRIPT] [--budget 0.3 ...]

Every dataset is of a room and a person of its own, a little off the model as what somebody has put up by hand is
(AsBuilt). Options that aren't the challenge's own are reconcile's. pirsim gets the rows and nothing else. Each answer is
kept in DIR, so that an interrupted challenge goes on. At the end DIR/scores.csv has a line an analysis, and standard
output a table by fault.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys

import numpy as np

import second_simulator as second
from faults import FAULTS, hung

DATA = pathlib.Path(__file__).parents[2] / "data"
COLUMNS = ("fault", "seed", "what", "truth", "expects", "score", "verdict", "effects", "data", "p", "closed")


def found_in_file(report):
    """What the look at the file tells: the kinds of its findings."""
    return [finding["kind"] for finding in report.get("data_findings", [])]


def score(truth, report, expects=()):
    """How a verdict compares with what was hidden. "in the set": one of several that can't be told apart. "nearest": told
    as what comes nearest, which isn't a name. Of the file: "told", "other fault of the file" or "file accused" (there is
    nothing wrong with it)."""
    verdict, effects = report["verdict"], report["effects"]
    if verdict == "faulty-data":
        if not expects:
            return "file accused"
        return "told" if set(expects) & set(found_in_file(report)) else "other fault of the file"
    if verdict == "no-disagreement":
        return "nothing seen"
    if verdict == "none-in-catalogue":
        return "unknown"
    if not truth:
        return {"one-of": "set", "nearest": "nearest"}.get(verdict, "misnamed")
    right = set(truth) & set(effects)
    if verdict == "nearest":
        return "nearest, right" if right else "nearest, wrong"
    if verdict == "one-of":
        return "in the set" if right else "not in the set"
    return "right" if right else "misnamed"


# What Study A says of its person.
PERSON = {"people.0.stature_m": 1.86, "people.0.mass_kg": 80.0, "people.0.actions.3.work.arm_amplitude_m": 0.1}


class AsBuilt:
    """The room and the person of one dataset, off the model by as much as reconcile's usual nuisance allows: seats by 4 cm,
    sensors by 1.5 degrees sideways and 1 up or down, the body by 3 % and the arms' swing by 10 %."""

    def __init__(self, scene, draw, path):
        off = lambda most: draw.uniform(-most, most)
        room = json.loads(pathlib.Path(scene).read_text())
        for node in room["nodes"]:
            if second.mark(node).get("type") == "seat":
                x, y, z = node["translation"]
                node["translation"] = [x + off(0.04), y, z + off(0.04)]
        path.write_text(json.dumps(room))
        self.path, self.scene = path, second.Gltf(path)
        size = 1 + off(0.03)
        factors = {"stature_m": size, "mass_kg": size**3, "arm_amplitude_m": 1 + off(0.1)}
        self.person = {key: value * factors[key.split(".")[-1]] for key, value in PERSON.items()}
        self.yaws, self.tilts = [off(1.5) for _ in self.sensors()], [off(1.0) for _ in self.sensors()]

    def sensors(self):
        return second.sorted_sensors(self.scene)

    def hang(self, number, world):
        return hung(world, self.yaws[number], self.tilts[number])


class Challenger:
    def __init__(self, options, of_reconcile):
        self.options, self.runs = options, {}
        self.of_reconcile = [*of_reconcile, *([] if "--table" in of_reconcile else ["--table", options.output / "table"])]
        options.output.mkdir(parents=True, exist_ok=True)

    def runs_with(self, seed, settings):
        """Room, runs, and their measurement with nothing wrong: the same for every fault that leaves the people as they
        are."""
        if (seed, settings) not in self.runs:
            self.runs = {key: made for key, made in self.runs.items() if key[0] == seed}
            room = AsBuilt(self.options.scene, np.random.default_rng([seed, 3]), self.options.output / f"room-{seed}.gltf")
            theirs = {setting.split("=")[0] for setting in settings}
            person = [f"{key}={value!r}" for key, value in room.person.items() if key not in theirs]
            study = second.study_of(room.path, self.options.script,
                                    ["replicates=1", f"seed={1000 + seed}", *person, *settings])
            runs = second.runs_of(self.options.pirsim, study)
            plain = second.Measurement(room.scene, DATA / "sensors", FAULTS["nothing"](None), 0, hang=room.hang)
            self.runs[seed, settings] = room, runs, plain
        return self.runs[seed, settings]

    def ask(self, name, seed):
        """A row of the scores."""
        folder = self.options.output / f"{name}-{seed}"
        fault = FAULTS[name](np.random.default_rng([seed, 0]))
        if not (folder / "report.json").exists():
            folder.mkdir(exist_ok=True)
            room, runs, plain = self.runs_with(seed, fault.settings)
            measurement = second.Measurement(room.scene, DATA / "sensors", fault, seed, plain, room.hang)
            measurement.write(folder / "measured.csv", runs)
            subprocess.run(
                [self.options.pirsim, "reconcile", "--scene", self.options.scene, "--script", self.options.script, "-q",
                 "--measured", folder / "measured.csv", "-o", folder, *self.of_reconcile], check=True,
                stdout=subprocess.DEVNULL)
        report = json.loads((folder / "report.json").read_text())
        verification = report["verification"] or {}
        return dict(zip(COLUMNS, (name, seed, fault.what, " ".join(fault.truth), " ".join(fault.expects),
                                  score(fault.truth, report, fault.expects), report["verdict"],
                                  " ".join(report["effects"]), " ".join(found_in_file(report)), report["where"]["p"],
                                  int(verification.get("closed", False)))))


def table_of(rows):
    lines = ["| hidden | the catalogue's name | answers |", "|---|---|---|"]
    for name in dict.fromkeys(row["fault"] for row in rows):
        mine = [row for row in rows if row["fault"] == name]
        answers = [row["score"] + (f" ({row['effects'].replace(' ', ', ')})" if row["effects"] else "") for row in mine]
        told = [f"{answers.count(a)} x {a}" if answers.count(a) > 1 else a for a in dict.fromkeys(answers)]
        name = mine[0]["truth"] or (f"of the file: {mine[0]['expects']}" if mine[0]["expects"] else "none")
        lines.append(f"| {mine[0]['what']} | {name.replace(' ', ', ') if mine[0]['truth'] else name} | {'; '.join(told)} |")
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
