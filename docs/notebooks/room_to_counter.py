# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---

# %% [markdown]
# # From a room to a counter
# A room made in Python, people who come and go, and a first model that counts them from the sensors' bits alone.
# Open it with jupytext, or run it: `python docs/notebooks/room_to_counter.py`.

# %%
import numpy as np
import pirsim

# %% [markdown]
# ## The room
# Six by four metres, a desk for each of three people, a door in the corner, two sensors in the far corners.

# %%
eye = pirsim.sensor_model("EKMC1604111")
desks = [(1.5, 1.0), (3.0, 1.0), (4.5, 1.0)]
scene = pirsim.Scene(
    name="small office",
    floor=pirsim.Floor.rectangle(0, 0, 6, 4),
    meshes=[pirsim.Mesh.box(f"desk{i}", (x - 0.6, 0.70, z - 0.9), (x + 0.6, 0.74, z - 0.3)) for i, (x, z) in enumerate(desks)],
    seats=[pirsim.Seat(f"S{i}", pirsim.facing((x, 0.53, z))) for i, (x, z) in enumerate(desks)],
    entrances=[pirsim.Entrance("door", pirsim.facing((5.4, 0, 4)))],
    sensors=[pirsim.Sensor("left", eye.id, pirsim.facing((0.1, 2.2, 0.1), heading_deg=-135, tilt_deg=20)),
             pirsim.Sensor("right", eye.id, pirsim.facing((5.9, 2.2, 0.1), heading_deg=135, tilt_deg=20))],
    sensor_models={eye.id: eye})

# %% [markdown]
# ## The people
# Each trial has another number of people; they work for ten minutes, as naturally as the model can, then leave.


# %%
def visitor(i):
    return pirsim.Person(f"p{i}", stature_m=1.65 + 0.1 * i, style="natural", actions=[
        pirsim.Wait(duration_s=20.0 * i), pirsim.Enter(entrance="door"), pirsim.Sit(seat=f"S{i}"),
        pirsim.Work(duration_s=600.0), pirsim.Leave(entrance="door")])


script = pirsim.Script("comings and goings", replicates=8, trials=[
    pirsim.Trial(f"{n} people", [visitor(i) for i in range(n)]) for n in (1, 2, 3)])
result = pirsim.run(pirsim.compile(scene, script))
print(f"{result.valid.sum() / 3600:.1f} hours, up to {result.people.max()} people")

# %% [markdown]
# ## The counter
# What a window of a minute tells: how often each sensor saw motion, and both together. A linear fit on the first six
# replicates counts the last two, which it hasn't seen; beside it, always the mean.

# %%
window = 60
seconds = result.bits.shape[1] // window * window


def by_window(array):
    return array[:, :seconds].reshape(array.shape[0], -1, window, *array.shape[2:])


bits = by_window(result.bits)
features = np.concatenate([bits.mean(axis=2), bits.all(axis=3).mean(axis=2)[..., np.newaxis],
                           np.ones((*bits.shape[:2], 1))], axis=2)
people = by_window(result.people).mean(axis=2)
whole = by_window(result.valid).all(axis=2)
train = whole & (result.replicate <= 6)[:, np.newaxis]
test = whole & (result.replicate > 6)[:, np.newaxis]
weights, *_ = np.linalg.lstsq(features[train], people[train], rcond=None)
error = np.abs(features[test] @ weights - people[test]).mean()
mean_error = np.abs(people[train].mean() - people[test]).mean()
print(f"mean absolute error: {error:.2f} people; always the mean: {mean_error:.2f}")
