#!/usr/bin/env python3
"""What `pirsim reconcile` is to reach, beside what its self-test finds in both shipped rooms. For a release, by hand:

    tests/claims/run_claims.py PIRSIM [-o DIR] [--size 0.1]

Tables and datasets are kept in DIR, so that an interrupted run goes on. A size of 1 has 600 datasets without an effect
and 20 of every effect and strength, and takes a day; 0.1 an hour or two. Exit code 1: a target is surely missed, since
the whole 95 % interval of the share lies outside. tests/second_simulator/challenge.py hides what no catalogue has.
"""
import argparse
import csv
import math
import pathlib
import subprocess
import sys

DATA = pathlib.Path(__file__).parents[2] / "data"
SENSORS = "optics", "electronics"
# Room, script and options of each part; thresholds were chosen on the first one's seed.
PARTS = {"meeting-series": ("meeting_room.gltf", "studyA.yaml"),
         "meeting-again": ("meeting_room.gltf", "studyA.yaml", "--analysis-seed", 5),
         "meeting-known": ("meeting_room.gltf", "studyA.yaml", "--analysis-seed", 2, "--nuisance", "none"),
         "meeting-sums": ("meeting_room.gltf", "studyA.yaml", "--data", "sums"),
         "office-series": ("open_office.gltf", "office.yaml", "--response", "zones"),
         "office-sums": ("open_office.gltf", "office.yaml", "--response", "zones", "--data", "sums")}


def interval(hits, of):
    """Exact, of 95 %: where the tails of the binomial distribution hold 2.5 % each."""
    def at_least(p):  # so many hits or more
        logs = (math.lgamma(of + 1) - math.lgamma(k + 1) - math.lgamma(of - k + 1) + k * math.log(p)
                + (of - k) * math.log1p(-p) for k in range(hits, of + 1))
        return sum(map(math.exp, logs))

    def where(is_below):
        low, high = 1e-12, 1 - 1e-12
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if is_below(middle) else (low, middle)
        return low
    lower = 0.0 if hits == 0 else where(lambda p: at_least(p) < 0.025)
    hits += 1
    upper = 1.0 if hits > of else where(lambda p: at_least(p) < 0.975)
    return lower, upper


def shares(cases, families, is_known):
    """Of each claim: what it says, its bounds, hits and of how many. Ref for the right name: [Wilson2019], 0.90 of five
    models."""
    def of_kind(kind):
        return [case for case in cases if case["kind"] == kind]

    def is_named(case):
        return case["verdict"] == "named"

    def is_right(case):
        return is_named(case) and case["named"] == case["truth"]

    def is_seen(case):
        return case["verdict"] != "no-disagreement"
    nothing, one, left_out = of_kind("nothing"), of_kind("one"), of_kind("left_out")
    seen = [case for case in one if is_seen(case)]
    motion = [case for case in one + left_out if families[case["truth"]] == "motion"]
    told = {case["dataset"] for case in one if is_right(case)}
    told_left_out = [case for case in left_out if case["dataset"] in told and is_seen(case)]
    for what, low, high, all_cases, hit in (
            ("a disagreement although nothing is hidden", 0, 0.05, nothing, is_seen),
            ("a name although nothing is hidden", 0, 0.01, nothing, is_named),
            ("exactly the right name, given a disagreement", 0.93 if is_known else 0.82, 1, seen, is_right),
            ("the right family, given a disagreement", 0.92, 1, seen, lambda c: c["family"] == families[c["truth"]]),
            ("one wrong name", 0, 0.01, one, lambda c: is_named(c) and not is_right(c)),
            ("the truth in the set, given a disagreement", 0.95, 1, seen, lambda c: c["truth"] in c["named"].split()),
            ("an effect that the catalogue lacks and the whole one names: called none in the catalogue", 0.70, 1,
             told_left_out, lambda c: c["verdict"] == "none-in-catalogue"),
            ("an effect that the catalogue lacks: called by one name", 0, 0.12, left_out, is_named),
            ("an effect that the catalogue lacks: called by a name of another family", 0, 0.05, left_out,
             lambda c: is_named(c) and c["family"] != families[c["truth"]]),
            ("people's motion: called by a name of optics or electronics", 0, 0.03, motion,
             lambda c: is_named(c) and c["family"] in SENSORS)):
        yield what, low, high, sum(map(hit, all_cases)), len(all_cases)
    yield ("parameters within their 90 % intervals", 0.87, 0.93, sum(int(case["covered"]) for case in one),
           sum(int(case["parameters"]) for case in one))


def judged(low, high, hits, of):
    if of == 0:
        return "not tested"
    least, most = interval(hits, of)
    if low <= hits / of <= high:
        return "met" if low <= least and most <= high else "met, of too few cases to be sure"
    return "missed" if most < low or least > high else "missed, of too few cases to be sure"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pirsim")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("build/claims"))
    parser.add_argument("--size", type=float, default=0.1)
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS))
    given = parser.parse_args()
    effects = subprocess.check_output([given.pirsim, "effects", "--format", "csv"], text=True)
    families = {row["effect"]: row["family"] for row in csv.DictReader(effects.splitlines())}
    missed = False
    for part in given.parts:
        scene, script, *options = PARTS[part]
        folder = given.output / part
        numbers = ("--budget", given.size, "--nulls", round(600 * max(given.size, 0.1)), "--injected",
                   max(3, round(20 * given.size)), "--leave-out", "effects")
        if not (folder / "selftest.html").exists():  # the last to be written
            subprocess.run([given.pirsim, "reconcile", "selftest", "--scene", DATA / "rooms" / scene, "--script",
                            DATA / "studies" / script, *map(str, (*numbers, *options)), "-o", folder],
                           check=True, stdout=subprocess.DEVNULL)
        print(f"\n{part}\n\n| how often | target | share | of | |\n|---|---|---:|---:|---|")
        with open(folder / "selftest.csv", newline="") as file:
            cases = list(csv.DictReader(file))
        for what, low, high, hits, of in shares(cases, families, "none" in options):
            verdict = judged(low, high, hits, of)
            missed = missed or verdict == "missed"
            print(f"| {what} | {low:.2f} to {high:.2f} | {hits / of if of else math.nan:.3f} | {of} | {verdict} |")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
