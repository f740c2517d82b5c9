"""Pictures, pages, exports, checks and placements in a notebook are those of the command line."""

import struct

import pytest

import pirsim


@pytest.fixture(scope="module")
def model(room, study_a):
    return pirsim.compile(room, study_a, set={"replicates": 1})


def test_a_preview_is_the_command_lines_picture(model, room, study_a, command, tmp_path):
    command("preview", "--scene", room, "--script", study_a, "--trial", "S3", "--time", "12", "--width", "320",
            "--height", "200", "--beams", "PIR2", "-q", "-o", tmp_path / "told.png")
    picture = pirsim.preview(model, model.runs_of("S3")[0], time_s=12, width=320, height=200, beams="PIR2")
    assert picture.png == (tmp_path / "told.png").read_bytes()
    assert picture._repr_png_() == picture.png and struct.unpack(">II", picture.png[16:24]) == (320, 200)
    assert picture.time_s == pytest.approx(12) and picture.trial == "S3" and len(repr(picture)) < 200
    picture.save(tmp_path / "saved.png")
    assert (tmp_path / "saved.png").read_bytes() == picture.png


def test_what_a_preview_can_not_show_is_refused(model):
    for arguments, error, message in (
            ({"run": 10}, IndexError, "run 10: the study has runs 0 to 9"),
            ({"run": 1.5}, TypeError, "run: expected a whole number"),
            ({"time_s": 1e6}, pirsim.UsageError, "isn.t in the run"),
            ({"beams": "PIR9"}, pirsim.UsageError, "sensor 'PIR9' is not in the scene"),
            ({"marks": "seat"}, pirsim.UsageError, "did you mean 'seats'"),
            ({"width": 10**9}, ValueError, "width: expected a whole number from 16 up to 7680"),
            ({"field_of_view_deg": 180.0}, pirsim.UsageError, "field_of_view_deg: expected a finite number"),
            ({"camera": (0.0, 1.0)}, TypeError, "camera")):
        with pytest.raises(error, match=message):
            pirsim.preview(model, **arguments)


def test_a_view_is_the_command_lines_page(model, room, study_a, command, tmp_path):
    command("view", "--scene", room, "--script", study_a, "--set", "replicates=1", "--from", "5", "--to", "9", "-q",
            "-o", tmp_path / "told.html")
    page = pirsim.view(model, from_s=5, to_s=9)
    told = (tmp_path / "told.html").read_text(encoding="utf-8")
    assert page.html.replace(model.script.name, "") == told.replace("studyA.yaml", "").replace(model.script.name, "")
    assert (page.from_s, page.to_s) == (5, 9) and page.run_s > 180
    shown = page._repr_html_()
    assert shown.startswith("<iframe") and shown.count("<") == 2  # nothing of the page leaks out of the frame
    page.save(tmp_path / "saved.html")
    assert (tmp_path / "saved.html").read_text(encoding="utf-8") == page.html
    assert len(repr(page)) < 300
    with pytest.raises(pirsim.UsageError, match="the run lasts from 0"):
        pirsim.view(model, from_s=1e6)


def test_an_export_is_the_command_lines_film(model, room, study_a, command, tmp_path):
    command("export", "--scene", room, "--script", study_a, "--set", "replicates=1", "--keys-per-s", "0.5", "--beams",
            "none", "-q", "-o", tmp_path / "told.glb")
    seconds = pirsim.export(model, tmp_path / "made.glb", beams="none", keys_per_s=0.5)
    assert (tmp_path / "made.glb").read_bytes() == (tmp_path / "told.glb").read_bytes() and seconds > 180
    with pytest.raises(ValueError, match="NUL"):
        pirsim.export(model, "run\0.glb")


def test_a_check_is_the_command_lines(room, study_a, command):
    found = pirsim.check(room, study_a)
    assert found and not found.errors
    assert found.text == command("check", "--scene", room, "--script", study_a)
    assert found.text.rstrip() in str(found) and repr(found) == str(found)
    assert [sight.sensor for sight in found.sensors] == [f"PIR{i}" for i in range(1, 6)]
    assert all(0 < sight.places <= found.places and sight.longest_m > 1 for sight in found.sensors)


def test_a_check_finds_what_compile_refuses(room, study_a, tmp_path):
    found = pirsim.check(room, study_a, set={"people.0.stature_m": 17})
    assert not found and "stature_m" in str(found) and found.errors[0].line == 0 and not found.sensors
    scene = pirsim.read_scene(room)
    scene.seats[2].id = "../x"
    found = pirsim.check(scene, study_a)
    assert not found and "scene.seats[2].id" in str(found)
    with pytest.raises(TypeError):
        pirsim.check(3, study_a)


def test_placements_are_the_command_lines(room, data, command):
    script = data / "studies" / "placements.yaml"
    few = "search.evaluations=4", "spacing_m=1"
    told = command("placements", "--scene", room, "--script", script, "--set", few[0], "--set", few[1], "-q")
    steps = []
    found = pirsim.placements(room, script, set=few, progress=lambda *done: steps.append(done))
    assert str(found) == told.rstrip() == repr(found) and steps
    areas = [score.seen_area_m2 for score in found.ranked]
    assert areas == sorted(areas, reverse=True) and areas[0] > 0 and found.evaluations > 0
    assert all(isinstance(sensor, pirsim.Sensor) for sensor in found.ranked[0].sensors)
    seats = sorted(pirsim.read_scene(room).seats, key=lambda seat: seat.id)
    for score in found.ranked:
        assert sorted(score.noticed_seats + score.deaf_seats + score.unseen_seats) == [seat.id for seat in seats]
        assert set(score.surely_seats) <= set(score.noticed_seats) and score.light is None


def test_placements_by_false_offs_tell_of_light(room, data, tmp_path):
    (tmp_path / "people.yaml").write_text("""
pirsim_script: 1
sensing: {tick_rate_hz: 10}
people: [{id: one, style: natural, actions: [{enter: door}, {sit: S2}, {work: {duration_s: 300}}, {leave: door}]}]
""")
    (tmp_path / "light.yaml").write_text("""
pirsim_placements: 1
by: false_off
light: {script: people.yaml, delay_min: 0.5}
spacing_m: 1
duration_s: 2
target: {x_shapes: {}}
sets:
  - id: as built
  - {id: nobody, sensors: [{model: EKMC1601111, position_m: [0.5, 2.6, -0.5], yaw_deg: 0, tilt_deg: -80}]}
""")
    with pytest.warns(pirsim.InputWarning, match="sees the target nowhere"):
        found = pirsim.placements(room, tmp_path / "light.yaml")
    best, blind = found.ranked
    assert best.set == "as built" and blind.set == "nobody"
    assert best.light.false_offs < blind.light.false_offs
    assert best.light.occupied_h == blind.light.occupied_h > 300 / 3600
    assert 0 <= best.light.dark_h < blind.light.dark_h < blind.light.occupied_h
