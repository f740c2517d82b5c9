"""Study B of Stefansson et al. 2021: a map a sensor of how often it sees a turning target. `coverage_map.py quick`:
squares of 30 cm instead of 5 cm."""
import sys

import matplotlib.pyplot as plt
import pirsim

data = pirsim.data_directory
coverage = pirsim.coverage(f"{data}/rooms/meeting_room.gltf", f"{data}/studies/studyB.yaml",
                           set={"spacing_m": 0.3 if "quick" in sys.argv else 0.05})
figure, axes = plt.subplots(1, len(coverage.sensors), figsize=(16, 5), layout="constrained")
for i, ax in enumerate(axes):
    image = ax.imshow(coverage.share[:, :, i], extent=coverage.extent, vmin=0, vmax=1)
    ax.set(title=coverage.sensors[i], xlabel="x, m", ylabel="z, m")
figure.colorbar(image, label="share of seconds with motion")
figure.savefig("coverage_map.png", dpi=120)
print("coverage_map.png")
