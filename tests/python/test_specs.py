"""Scenes and scripts as plain objects: the same as the library's specs, the same study as from files."""

import dataclasses

import numpy as np
import pytest

import pirsim
from pirsim import _core, specs

ACTIONS = {"Wait", "Appear", "Enter", "Walk", "Sit", "Work", "Rise", "Leave", "Turn", "Follow", "Lie", "Stand"}
OF_ACTIONS = {"at_s", "phase", "where"}


def test_every_class_has_the_specs_fields_and_defaults():
    defaults = _core.defaults()
    assert len(defaults) > 30 and ACTIONS < set(defaults)
    for name, fields in defaults.items():
        made = getattr(specs, name)()
        mine = {field.name: getattr(made, field.name) for field in dataclasses.fields(made)}
        if name in ACTIONS:
            assert {key: mine.pop(key) for key in OF_ACTIONS} == {"at_s": None, "phase": "", "where": specs.Where()}
        if name == "Zone":
            mine["corners"] = tuple(mine["corners"])
        assert mine == fields, name


@pytest.mark.parametrize("study, room", [("studyA", "meeting_room"), ("office", "open_office"),
                                         ("density", "open_hall")])
def test_a_study_read_into_objects_is_the_same_study(study, room, data):
    scene, script = data / "rooms" / f"{room}.gltf", data / "studies" / f"{study}.yaml"
    model = pirsim.compile(scene, script)
    objects = pirsim.compile(pirsim.read_scene(scene), pirsim.read_script(script))
    assert objects.scene == model.scene == pirsim.read_scene(scene)
    assert objects.script == model.script == pirsim.read_script(script)
    runs = range(min(model.n_runs, 12))
    a, b = pirsim.run(model, runs), pirsim.run(objects, runs)
    assert np.array_equal(a.bits, b.bits) and np.array_equal(a.people, b.people) and a.bits.any()
    assert np.array_equal(a.phase, b.phase)


def test_changing_an_object_is_as_changing_the_file(room, study_a):
    script = pirsim.read_script(study_a)
    script.replicates = 1
    script.effects.append(pirsim.Effect("missed_triggers", {"probability": 0.4}, {"sensor": "PIR2"}))
    for trial in script.trials:
        trial.people[0].stature_m = 1.6
    changed = pirsim.run(pirsim.compile(room, script))
    told = pirsim.run(pirsim.compile(room, study_a, set={
        "replicates": 1, "people.0.stature_m": 1.6,
        "effects": [{"missed_triggers": {"probability": 0.4, "sensor": "PIR2"}}]}))
    plain = pirsim.run(pirsim.compile(room, study_a, set={"replicates": 1}))
    assert np.array_equal(changed.bits, told.bits)
    assert not np.array_equal(changed.bits, plain.bits)


def test_a_script_written_to_a_file_is_the_same(room, study_a, tmp_path):
    script = pirsim.read_script(study_a, set={"replicates": 1})
    pirsim.write_script(script, tmp_path / "written.yaml")
    assert np.array_equal(pirsim.run(pirsim.compile(room, tmp_path / "written.yaml")).bits,
                          pirsim.run(pirsim.compile(room, script)).bits)


def own_room():
    """Five metres by four; a sensor in the middle of a long wall looks across it."""
    return pirsim.Scene(
        name="own room", floor=pirsim.Floor.rectangle(0, 0, 5, 4),
        meshes=[pirsim.Mesh.box("wall", (0, 0, -0.2), (5, 2.5, 0))],
        sensors=[pirsim.Sensor("PIR", "EKMC1604111", pirsim.facing((2.5, 1.2, 3.9)))],
        sensor_models={"EKMC1604111": pirsim.sensor_model("EKMC1604111")})


def own_script():
    walker = pirsim.Person("walker", [pirsim.Appear(point=(0.5, 2.0), heading_deg=-90),
                                      pirsim.Walk(points=[(4.5, 2.0), (0.5, 2.0)], phase="to and fro")])
    return pirsim.Script("own script", [pirsim.Trial("walk", [walker])])


def test_a_room_and_a_person_made_in_python():
    result = pirsim.run(pirsim.compile(own_room(), own_script()))
    runs, seconds, sensors = result.bits.shape
    assert (runs, sensors) == (1, 1)
    assert 8 <= seconds <= 16  # 8 m at 1 m/s, and turns
    assert 3 < result.bits.sum() <= seconds
    assert (result.phase[0] == "to and fro").sum() >= 8 and (result.people == 1).all()
    # Behind a box as wide as the room nobody is seen.
    hidden = own_room()
    hidden.meshes.append(pirsim.Mesh.box("screen", (0, 0, 2.9), (5, 2.5, 3.0)))
    assert not pirsim.run(pirsim.compile(hidden, own_script())).bits.any()


def test_a_script_with_a_clock_of_its_own(tmp_path):
    script = own_script()
    assert pirsim.run(pirsim.compile(own_room(), script)).clock is None
    script.begin = "2026-03-02T06:00"
    script.trials[0].people[0].actions[1].at_s = 60.0
    result = pirsim.run(pirsim.compile(own_room(), script))
    assert result.clock[0, 0] == np.datetime64("2026-03-02T06:00:01")
    # A row tells how its second ended: the first one that is walked in ends a second after the walk began.
    walks = result.clock[0, result.phase[0] == "to and fro"]
    assert walks[0] == np.datetime64("2026-03-02T06:01:01")
    pirsim.write_script(script, tmp_path / "written.yaml")
    assert "at: 06:01" in (tmp_path / "written.yaml").read_text()
    read = pirsim.read_script(tmp_path / "written.yaml")
    assert (read.begin, read.trials[0].people[0].actions[1].at_s) == (script.begin, 60.0)
    later = pirsim.read_script(tmp_path / "written.yaml", set={"begin": "2026-03-02T06:00:30"})
    assert later.trials[0].people[0].actions[1].at_s == 30.0


def test_what_a_reader_would_refuse_is_refused():
    def scene(change):
        room = own_room()
        change(room)
        return lambda: pirsim.compile(room, own_script())

    def script(change):
        study = own_script()
        change(study)
        return lambda: pirsim.compile(own_room(), study)

    nan = float("nan")
    for call, message in (
            (scene(lambda s: s.meshes.append(pirsim.Mesh("m", [(0, 0, nan)] * 3, [(0, 1, 2)]))), "isn't finite"),
            (scene(lambda s: s.meshes.append(pirsim.Mesh("m", [(0, 0, 0)] * 3, [(0, 1, 3)]))), "doesn't exist"),
            (scene(lambda s: s.sensors.append(s.sensors[0])), "a second sensor 'PIR'"),
            (scene(lambda s: s.sensor_models.clear()), "no sensor model 'EKMC1604111'"),
            (scene(lambda s: setattr(s, "floor", pirsim.Floor())), "no floor"),
            (scene(lambda s: setattr(s.sensors[0].world_from_sensor, "rotation", (2, 0, 0, 0))), "rotation"),
            (script(lambda s: setattr(s.sensing, "tick_rate_hz", 0)), "tick_rate_hz"),
            (script(lambda s: setattr(s.trials[0].people[0], "stature_m", nan)), "stature_m"),
            (script(lambda s: setattr(s, "replicates", -1)), "replicates"),
            (script(lambda s: setattr(s, "begin", "soon")), "begin: expected the date and time"),
            (script(lambda s: s.trials.append(s.trials[0])), "a second trial 'walk'"),
            (script(lambda s: s.effects.append(pirsim.Effect("dead_tyme"))), "did you mean 'dead_time'"),
            (script(lambda s: s.trials[0].people[0].actions.append(pirsim.Sit(seat="S1"))), "seat 'S1'")):
        with pytest.raises(pirsim.InputError, match=message):
            call()


def test_objects_are_checked_as_files_are():
    """Each was accepted, or cut off in silence, by compile(); the same in a file is refused."""
    def scene(change):
        room = own_room()
        change(room)
        return room, own_script()

    def script(change):
        study = own_script()
        change(study)
        return own_room(), study

    seat = pirsim.Seat("S1", pirsim.facing((1.0, 0.5, 1.0)))
    box = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    model = "scene.sensor_models['EKMC1604111']"
    for objects, error, message in (
            (scene(lambda s: setattr(s.sensors[0], "id", "../x,=cmd()")), pirsim.InputError, "scene.sensors[0].id"),
            (scene(lambda s: setattr(s.sensors[0], "id", "a\nb")), pirsim.InputError, "scene.sensors[0].id"),
            (scene(lambda s: setattr(s.sensors[0], "id", "a\0b")), pirsim.InputError, "scene.sensors[0].id"),
            (scene(lambda s: setattr(s.sensors[0], "id", "people")), pirsim.InputError, "scene.sensors[0].id"),
            (scene(lambda s: s.seats.extend([seat, seat])), pirsim.InputError, "scene.seats[1].id"),
            (scene(lambda s: setattr(s.sensors[0].world_from_sensor, "origin", (1e9, 0, 0))), pirsim.InputError,
             "scene.sensors[0].world_from_sensor.origin"),
            (scene(lambda s: s.meshes.append(pirsim.Mesh("m", [(1e9, 0, 0)] * 3, [(0, 1, 2)]))), pirsim.InputError,
             "scene.meshes[1].positions[0]"),
            (scene(lambda s: s.meshes.append(pirsim.Mesh("m", box, [(0, 1, 2**40)]))), ValueError,
             "scene.meshes[1].triangles"),
            (scene(lambda s: s.meshes.append(pirsim.Mesh("m", box, np.array([(0, 1, 2**40)])))), ValueError,
             "scene.meshes[1].triangles"),
            (scene(lambda s: s.meshes.append(pirsim.Mesh("m", box, [(0, 1, -1)]))), ValueError,
             "scene.meshes[1].triangles"),
            (scene(lambda s: s.meshes.append(pirsim.Mesh("m", box, [(0, 1.5, 2)]))), TypeError,
             "scene.meshes[1].triangles"),
            (scene(lambda s: setattr(s, "floor", pirsim.Floor([[(0, 0), (5, 0), (0, 4), (5, 4)]]))), pirsim.InputError,
             "scene.floor"),
            (scene(lambda s: setattr(s, "floor", pirsim.Floor.rectangle(0, 0, 1e9, 4))), pirsim.InputError,
             "scene.floor"),
            (scene(lambda s: s.sensor_models["EKMC1604111"].clusters.clear()), pirsim.InputError, model + ".clusters"),
            (scene(lambda s: setattr(s.sensor_models["EKMC1604111"].clusters[0], "lens_step", 0)), pirsim.InputError,
             model + ".clusters[0].lens_step"),
            (scene(lambda s: setattr(s.sensor_models["EKMC1604111"].optics, "blur_deg", 90.0)), pirsim.InputError,
             model + ".optics.blur_deg"),
            (script(lambda s: setattr(s.trials[0].people[0].actions[0], "point", (1e9, 0))), pirsim.InputError,
             "script.trials[0].people[0].actions[0].point"),
            (script(lambda s: setattr(s.trials[0].people[0].actions[1], "points", [])), pirsim.InputError,
             "script.trials[0].people[0].actions[1].points"),
            (script(lambda s: setattr(s.trials[0].people[0], "body_mesh_file", "nobody.gltf")), pirsim.InputError,
             "script.trials[0].people[0].body_mesh_file"),
            (script(lambda s: setattr(s.sensing, "ticks_per_window", 0)), pirsim.InputError,
             "script.sensing.ticks_per_window"),
            (script(lambda s: setattr(s, "seed", 2**63)), pirsim.InputError, "script.seed")):
        with pytest.raises(error) as caught:
            pirsim.compile(*objects)
        assert message in str(caught.value), str(caught.value)


def test_specs_print_in_a_few_lines(room, study_a, data):
    scene, script = pirsim.read_scene(room), pirsim.read_script(study_a)
    office = pirsim.read_scene(data / "rooms" / "open_office.gltf")
    for thing in (scene, office, script, script.trials[0], script.trials[0].people[0], scene.meshes[0], scene.floor,
                  scene.sensor_models["EKMC1604111"], scene.sensor_models["EKMC1604111"].clusters[0], scene.seats[0],
                  pirsim.effects()[0]):
        text = repr(thing)
        assert len(text) < 700 and text.count("\n") < 8, text
    assert "PIR1" in repr(scene) and "10 seats" in repr(scene) and "10 trials (S1, S2" in repr(script)
    assert f"seed {script.seed}" in repr(script)


def test_values_of_a_wrong_type_are_named_by_their_place():
    def compiled(change):
        study = own_script()
        change(study)
        return lambda: pirsim.compile(own_room(), study)

    person = "script.trials[0].people[0]"
    for call, place in (
            (compiled(lambda s: setattr(s.trials[0].people[0], "stature_m", "tall")), f"{person}.stature_m"),
            (compiled(lambda s: setattr(s.trials[0].people[0], "stature_m", True)), f"{person}.stature_m"),
            (compiled(lambda s: setattr(s, "replicates", 1.5)), "script.replicates"),
            (compiled(lambda s: setattr(s, "seed", -1)), "script.seed"),
            (compiled(lambda s: setattr(s.sensing, "change_per", "claster")), "script.sensing.change_per"),
            (compiled(lambda s: setattr(s.sensing, "rays_per_zone", 7)), "script.sensing.rays_per_zone"),
            (compiled(lambda s: s.trials[0].people[0].actions.append("sit")), f"{person}.actions[2]"),
            (compiled(lambda s: setattr(s.trials[0].people[0].actions[1], "points", [(1, 2, 3)])),
             f"{person}.actions[1].points[0]"),
            (compiled(lambda s: setattr(s.trials[0], "people", "nobody")), "script.trials[0].people")):
        with pytest.raises(TypeError) as caught:
            call()
        assert place + ": expected" in str(caught.value)
    with pytest.raises(AttributeError):
        own_script().trials[0].people[0].stature = 1.7  # not a field


def test_an_occupancy_is_made_of_counts_and_of_tracks(room):
    def people(occupancy):
        trial = pirsim.Trial("1", occupancy=occupancy)
        model = pirsim.compile(pirsim.read_scene(room), pirsim.Script("counted", [trial]))
        return pirsim.run(model).people[0]

    counted = people(pirsim.Occupancy(counts=pirsim.Counts(times_s=[0, 60, 120], people=[0, 3, 1])))
    assert len(counted) == 120 and counted[59] == 3 and counted[119] == 1
    track = pirsim.Track("a", times_s=[1, 5], points=[(6.3, -0.6), (2.3, -0.6)])
    assert list(people(pirsim.Occupancy(positions=pirsim.Positions([track])))) == [1] * 5


def test_marks_beside_a_model(tmp_path, room, study_a):
    """As by --marks: a Scene of a file has both, and a model made of both names has them too."""
    marks = tmp_path / "marks.yaml"
    marks.write_text("pirsim_marks: 1\nseats: [{id: extra, position_m: [6.3, 0.53, -0.6]}]\n")
    plain, marked = pirsim.read_scene(room), pirsim.read_scene(room, marks=marks)
    assert [seat.id for seat in marked.seats] == [seat.id for seat in plain.seats] + ["extra"]
    assert pirsim.compile(room, study_a, marks=marks).scene == marked
    assert "none.yaml" in str(pirsim.check(room, study_a, marks=tmp_path / "none.yaml").errors[0])
    marks.write_text("pirsim_marks: 1\nignore: [nothing_like_it]\n")
    with pytest.raises(pirsim.InputError, match="no node of the scene"):
        pirsim.read_scene(room, marks=str(marks))
    with pytest.raises(TypeError, match="marks"):
        pirsim.compile(plain, study_a, marks=marks)
