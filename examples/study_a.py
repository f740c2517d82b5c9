"""Study A of Stefansson et al. 2021: a histogram a seat and sensor of the seconds with motion in three minutes of work,
over 200 replicates, with what the paper measured. People sit down within 5 cm and 4.3 degrees of the seat, which agrees
with the measurement far better than the exact seats (docs/studyA.md). `study_a.py quick`: ten replicates."""
import csv
import sys

import matplotlib.pyplot as plt
import pirsim

data = pirsim.data_directory
changes = {"people.0.seat_scatter": {"position_sd_m": 0.05, "heading_sd_deg": 4.3}}
if "quick" in sys.argv:
    changes["replicates"] = 10
model = pirsim.compile(f"{data}/rooms/meeting_room.gltf", f"{data}/studies/studyA.yaml", set=changes)
seconds = pirsim.run(model).motion_windows(["working"]).reshape(-1, len(model.trials), len(model.sensors.names))

with open(f"{data}/measured/stefansson2021_table1.csv", newline="") as file:
    measured = {(row["seat"], row["sensor"]): float(row["real"]) for row in csv.DictReader(file)}
figure, axes = plt.subplots(*seconds.shape[1:], sharex=True, figsize=(10, 14), layout="constrained")
for (trial, sensor), ax in [((t, s), axes[t, s]) for t in range(axes.shape[0]) for s in range(axes.shape[1])]:
    ax.hist(seconds[:, trial, sensor], bins=range(0, 181, 5), color="#4477aa")
    ax.axvline(measured[model.trials[trial], model.sensors.names[sensor]], color="#cc3311")
    ax.set_yticks([])
    ax.set_title(f"{model.trials[trial]}, {model.sensors.names[sensor]}", fontsize=8)
figure.supxlabel("seconds with motion in 180 s of work (blue: simulated, seats scattered; red line: measured)")
figure.savefig("study_a.png", dpi=120)
print("study_a.png")
