#!/usr/bin/env python3
"""The counting example as a user runs it, on its smallest dataset. Usage: run_count_people.py PIRSIM EXAMPLE_DIR.

Needs numpy and scikit-learn; without them it returns 77.
"""
import csv
import importlib.util
import math
import pathlib
import subprocess
import sys
import tempfile


def main():
    pirsim, example = sys.argv[1:3]
    missing = [name for name in ("numpy", "sklearn") if importlib.util.find_spec(name) is None]
    if missing:
        print(f"{' and '.join(missing)} missing: pip install -r examples/count_people/requirements.txt")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def count(*options):
            subprocess.run([sys.executable, "-B", pathlib.Path(example) / "count_people.py", "--small", "--pirsim", pirsim,
                            "-o", folder, *options], check=True)
            return (folder / "tables.md").read_text()

        # A faulty file is refused by line before any dataset is made.
        faulty = folder / "faulty.csv"
        faulty.write_text("Date,Time,S6_PIR,S7_PIR,Room_Occupancy_Count\n2017/12/22,noon,0,0,1\n")
        refused = subprocess.run([sys.executable, "-B", pathlib.Path(example) / "count_people.py", "--small", "--pirsim",
                                  pirsim, "-o", folder, "--real", faulty], capture_output=True, text=True)
        assert refused.returncode == 1 and "faulty.csv:2: " in refused.stderr, refused.stderr
        assert "Traceback" not in refused.stderr and not (folder / "datasets").exists(), refused.stderr

        tables = count()
        assert "| rooms and effects varied | hidden Markov |" in tables, tables
        # What pirsim exports in the shape of UCI 864 stands for the publisher's file.
        exported = sorted((folder / "datasets/small/exports/uci864/room_0001").glob("*.csv"))[0]
        lines = exported.read_text().splitlines()
        lines[0] = lines[0].replace("PIR1_PIR", "S6_PIR").replace("PIR2_PIR", "S7_PIR")
        real = folder / "Occupancy_Estimation.csv"
        real.write_text("\n".join(lines) + "\n")
        tables = count("--real", real, "--draws", "1")
        assert "| real alone, one unit left out | logistic |" in tables and "## Equivalent real units" in tables, tables
        with open(folder / "results.csv", newline="") as file:
            results = list(csv.DictReader(file))
        assert len({line["tested_on"] for line in results}) == 3 and results, results
        assert all(math.isfinite(float(line[key])) for line in results for key in ("value", "low", "high"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
