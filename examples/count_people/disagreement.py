"""What `pirsim reconcile` says where the readings of a real room and a model of it disagree.

Nobody scripted the day of UCI 864, but its counts are known: stretches in which the count stays are runs, and so many
people sit at their desks in the model. Where they sit and where the sensors hang isn't known, so several rooms are tried.
"""
import csv
import json
import subprocess

import numpy as np

SECONDS = 30
RUN, RUNS = 20, 2  # readings of a run: 10 min; and runs of each count
SETTLING = 4       # readings after a change of the count and before the next one that are left out: 2 min
NAMES = {1: "one", 2: "two", 3: "three"}


def script_of(door, seats):
    """Trials with one, two and three people at these seats. Everybody has sat down when what counts begins."""
    work = f"{{work: {{duration_s: {RUN * SECONDS}}}, at_s: {SETTLING * SECONDS}}}"
    lines = ["pirsim_script: 1", f"sensing: {{tick_rate_hz: 10, window_s: {SECONDS}, response: zones}}", "summary: {phases: [working]}",
             f"replicates: {RUNS}", "trials:"]
    for n, name in NAMES.items():
        lines += [f"  - id: {name}", "    people:"]
        lines += [f"      - {{id: {who}, style: natural, actions: [{{enter: {door}}}, {{sit: {seat}}}, {work}]}}"
                  for who, seat in zip("abc"[:n], seats)]
    return "\n".join(lines) + "\n"


def steady_runs(stretches):
    """Of each count, the first runs [reading, sensor] without a change of the count: the day as it came."""
    runs = {n: [] for n in NAMES}
    for stretch in stretches:
        cuts = np.flatnonzero(np.diff(stretch.people)) + 1
        for own in np.split(np.arange(len(stretch.people)), cuts):
            steady, n = own[SETTLING:len(own) - SETTLING], stretch.people[own[0]]
            for k in range(len(steady) // RUN if n in runs else 0):
                runs[n].append(stretch.motion[steady[k * RUN:(k + 1) * RUN]])
    return {n: own[:RUNS] for n, own in runs.items()}


def write_measured(path, runs):
    with open(path, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["replicate", "trial", "time_s", "PIR1", "PIR2"])
        for n, own in runs.items():
            for replicate, motion in enumerate(own, 1):
                out.writerows([replicate, NAMES[n], SECONDS * (i + 1), *bits.astype(int)]
                              for i, bits in enumerate(motion))


def reconciled(pirsim, scene, stretches, folder, options=()):
    """The report of `pirsim reconcile` on this scene; made if it isn't there yet."""
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "report.json").exists():
        write_measured(folder / "measured.csv", steady_runs(stretches))
        (folder / "steady.yaml").write_text(script_of("door", ("S1", "S2", "S3")))
        subprocess.run([pirsim, "reconcile", "--scene", scene, "--script", folder / "steady.yaml", "--measured",
                        folder / "measured.csv", "-o", folder, *options], check=True, stdout=subprocess.DEVNULL)
    return json.loads((folder / "report.json").read_text())


def table_of(reports):
    """Lines of a table. Where the model agrees with the data no effect is looked for."""
    lines = ["| room | verdict | p of the model as it is | not ruled out, with probability "
             "| readings with motion, measured (expected) |", "|---|---|---|---|---|"]
    for room, report in reports.items():
        kept = sorted((c for c in report["candidates"] if c["kept"]), key=lambda c: -c["probability"])
        names = ", ".join(f"`{c['effect']}` {c['probability']:.2f}" for c in kept) or "-"
        cells = ", ".join(f"{c['trial']} {c['sensor']}: {c['measured_s'] / (RUN * SECONDS):.2f} "
                          f"({c['expected_s'] / (RUN * SECONDS):.2f})" for c in report["where"]["cells"])
        lines.append(f"| {room} | `{report['verdict']}` | {report['where']['p']:.3f} | {names} | {cells} |")
    return "\n".join(lines)
