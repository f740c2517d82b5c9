"""Frames of thermal arrays in Python and in files."""

import base64
import gzip
import json
import math
import re

import numpy as np
import pytest

import pirsim

DOWN = pirsim.Frame(rotation=(math.sqrt(0.5), -math.sqrt(0.5), 0.0, 0.0))


def hang(scene, model, x=3.5, z=-2.0):
    scene.sensor_models[model] = pirsim.sensor_model(model)
    scene.arrays.append(pirsim.Sensor("A" + str(len(scene.arrays) + 1), model,
                                      pirsim.Frame((x, 2.6, z), DOWN.rotation)))
    return scene


@pytest.fixture(scope="module")
def scene(room):
    return hang(hang(pirsim.read_scene(room), "AMG8833"), "MLX90640-BAB")


@pytest.fixture(scope="module")
def script():
    script = pirsim.Script(name="two walks", replicates=2)
    script.sensing.response = "zones"
    for trial, end in (("1", 2.5), ("2", 5.5)):
        script.trials.append(pirsim.Trial(trial, [pirsim.Person("p", [pirsim.Appear((1.0, -0.6)),
                                                                     pirsim.Walk([(2.2, -3.6), (end, -3.6)])])]))
    return script


def test_frames_are_arrays_of_temperatures(scene, script):
    model = pirsim.compile(scene, script)
    result = pirsim.run(model, frames=True)
    assert list(result.frames) == ["A1", "A2"]
    grid_eye, melexis = result.frames["A1"], result.frames["A2"]
    assert grid_eye.shape[0] == melexis.shape[0] == 4
    assert grid_eye.shape[2:] == (8, 8) and melexis.shape[2:] == (24, 32)
    assert np.allclose(np.diff(result.frame_time["A1"]), 0.1) and np.allclose(np.diff(result.frame_time["A2"]), 0.25, atol=0.011)
    last = result.valid[0].sum() * 10
    assert np.isfinite(grid_eye[0, :last]).all() and np.isnan(grid_eye[0, last:]).all()  # the first trial ends sooner
    assert np.array_equal(grid_eye[0, :last] * 4, np.round(grid_eye[0, :last] * 4))  # in steps of 0.25 K
    assert not np.array_equal(grid_eye[0, :last], grid_eye[2, :last])  # noise of each run
    assert "frames of A1 [4, " in repr(result)
    assert pirsim.run(model).frames == {}
    again = pirsim.run(model, [3, 1], threads=1, frames=True)
    assert np.array_equal(again.frames["A2"][0], melexis[3], equal_nan=True)
    assert np.array_equal(again.bits, result.bits[[3, 1], :again.bits.shape[1]])


def test_dead_pixels_read_nothing_and_the_rate_is_the_scripts(room, script):
    scene = hang(pirsim.read_scene(room), "AMG8833")
    scene.sensor_models["AMG8833"].array.dead_pixels = 1
    scene.sensor_models["AMG8833"].array.netd_k = 0.0
    model = pirsim.compile(scene, script)
    frames = pirsim.run(model, 0, frames=True).frames["A1"]
    assert np.isnan(frames).sum(axis=(0, 2, 3)).tolist() == [1] * frames.shape[1]
    script = model.script
    script.sensing.frame_rate_hz = 2.0
    result = pirsim.run(pirsim.compile(scene, script), 0, frames=True)
    assert np.allclose(result.frame_time["A1"][:4], [0.5, 1.0, 1.5, 2.0])


def test_files_have_the_same_frames(command, data, tmp_path):
    recipe = tmp_path / "r.yaml"
    recipe.write_text("""pirsim_recipe: 1
name: arrays
rooms:
  - count: 1
    kind: meeting
    width_m: 5
    depth_m: 5
    seats: 6
    sensors: [{mount: ceiling, count: 1, model: MLX90640-BAA}, {mount: corner, count: 1}]
days: 1
frames: true
sensing: {frame_rate_hz: 0.1, tick_rate_hz: 10, window_s: 10}
schedule: {first_day: "2026-03-02", from: "09:00", to: "10:00", meetings: {}}
""")
    pirsim.dataset(recipe, tmp_path / "set")
    frames = np.load(tmp_path / "set/frames/room_0001/day_01_ARRAY1.npy")
    assert frames.shape == (360, 24, 32) and frames.dtype == np.dtype("<f4")
    assert (tmp_path / "set/rows/room_0001/day_01.csv.gz").exists()
    room, study = tmp_path / "set/rooms/room_0001.gltf", tmp_path / "set/scripts/room_0001/day_01.yaml"
    command("run", "--scene", room, "--script", study, "-o", tmp_path / "rows.csv", "--frames", tmp_path / "frames",
            "--frame", 1800, "-q")
    stack, = (tmp_path / "frames").glob("ARRAY1_*_1.npy")
    assert np.array_equal(np.load(stack), frames)
    assert np.allclose(np.loadtxt(stack.with_suffix(".frame.csv"), delimiter=","), frames[179], atol=0.005)
    result = pirsim.run(pirsim.compile(room, study), frames=True)
    assert np.array_equal(result.frames["ARRAY1"][0], frames)
    assert "ARRAY1: 32 x 24 pixels, noise 0.02 K" in command("check", "--scene", room, "--script", study)
    page = tmp_path / "run.html"
    command("view", "--scene", room, "--script", study, "--to", "09:01", "-o", page, "-q")
    packed = re.search(r'id="data">([^<]*)<', page.read_text())[1]
    array, = json.loads(gzip.decompress(base64.b64decode(packed)))["arrays"]
    assert (array["id"], array["rows"], array["columns"]) == ("ARRAY1", 24, 32)
    pixels = np.frombuffer(base64.b64decode(array["bytes"]), np.uint8).reshape(-1, 24, 32)
    shown = array["lowest_c"] + (pixels[array["at_key"][-1]] - 1.0) * array["step_k"]
    assert np.allclose(shown, frames[5], atol=array["step_k"])  # at second 60


def test_what_cannot_take_an_array_says_so(scene, script, data, tmp_path):
    with pytest.raises(pirsim.InputError, match="placements works on rows of motion.*'A1'"):
        pirsim.placements(scene, data / "studies" / "placements.yaml")
    bad = pirsim.read_scene(data / "rooms" / "meeting_room.gltf")
    bad.sensor_models["AMG8833"] = pirsim.sensor_model("AMG8833")
    bad.sensors[0].model = "AMG8833"
    with pytest.raises(pirsim.InputError, match="'AMG8833' is an array: it belongs into scene.arrays"):
        pirsim.compile(bad, script)


def test_coverage_has_a_column_an_array(scene, data):
    coverage = pirsim.coverage(scene, data / "studies" / "studyB.yaml", set={"spacing_m": 0.5})
    seen = coverage.share[:, :, coverage.sensors.index("A1")]
    assert np.nanmax(seen) == 1.0 and np.nanmin(seen) == 0.0  # 60 degrees don't reach the corners
