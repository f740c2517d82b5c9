# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---

# %% [markdown]
# # From measurements to a verdict
# Do a model and measurements agree? If not, what is the model missing? Here the "measurements" are simulated with an
# effect that the analysis isn't told. Open it with jupytext, or run it:
# `python docs/notebooks/measurements_to_verdict.py`; `quick` as an argument makes it coarse and quick.

# %%
import sys
import tempfile

import pirsim

quick = "quick" in sys.argv
room = f"{pirsim.data_directory}/rooms/meeting_room.gltf"
study = pirsim.read_script(f"{pirsim.data_directory}/studies/studyA.yaml",
                           set={"replicates": 1, "trials.for_each.seat": ["S3", "S4", "S8"]})

# %% [markdown]
# ## What was measured
# A room whose sensors lose half of their triggers.

# %%
real = pirsim.read_script(f"{pirsim.data_directory}/studies/studyA.yaml",
                          set={"replicates": 1, "seed": 77, "trials.for_each.seat": ["S3", "S4", "S8"]})
real.effects = [pirsim.Effect("missed_triggers", {"probability": 0.5})]
measured = pirsim.run(pirsim.compile(room, real))

# %% [markdown]
# ## What the analysis says
# It simulates a table of datasets with each effect of the catalogue (here: some of it), and asks which of them can have
# made the data. With the whole catalogue and the usual budget this takes minutes.

# %%
with tempfile.TemporaryDirectory() as table:
    found = pirsim.reconcile(room, study, measured, table=table, budget=0.05 if quick else 0.3,
                             effects=["missed_triggers", "false_triggers", "dead_time"])
print(found.sentence)
for candidate in found.candidates:
    print(f"  {candidate.effect:16} probability {candidate.probability:.2f}  {candidate.reason}")

# %% [markdown]
# ## The better model
# `found.patched` is the script with what was found; it runs as any other.

# %%
before = pirsim.run(pirsim.compile(room, study)).motion_windows(["working"]).sum()
after = pirsim.run(pirsim.compile(room, found.patched)).motion_windows(["working"]).sum()
print(f"seconds with motion: measured {measured.motion_windows(['working']).sum()}, model {before}, better model {after}")
