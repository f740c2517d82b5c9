"""Rows from a trace are those of the study; other electronics and seeds need no new simulation."""

import numpy as np
import pytest

import pirsim


def same(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name))
               for name in ("bits", "people", "valid", "phase", "trial", "replicate", "time"))


@pytest.fixture(scope="module")
def study(data):
    return data / "rooms" / "open_office.gltf", data / "studies" / "office.yaml"


def test_a_trace_gives_the_studys_rows(study, room, study_a):
    for scene, script, changes in ((*study, {"replicates": 3}),
                                   (room, study_a, {"replicates": 1, "effects": ["soft_zone_edges", "dead_time"]})):
        model = pirsim.compile(scene, script, set=changes)
        trace = pirsim.trace(model)
        assert same(trace.emit(), pirsim.run(model)) and trace.n_runs == model.n_runs
        assert same(pirsim.trace(model, [1, 0]).emit(), pirsim.run(model, [1, 0]))


def test_effects_on_a_trace_are_those_of_a_model_that_has_them(study):
    scene, script = study
    plain = pirsim.compile(scene, script, set={"replicates": 2})
    trace = pirsim.trace(plain)
    for effects, written in (
            ([pirsim.Effect("missed_triggers", {"probability": 0.5})], [{"missed_triggers": {"probability": 0.5}}]),
            (["dead_time", {"false_triggers": {"sensor": plain.sensors.names[0]}}],
             ["dead_time", {"false_triggers": {"sensor": plain.sensors.names[0]}}])):
        model = pirsim.compile(scene, script, set={"replicates": 2, "effects": written})
        emitted = trace.emit(effects=effects)
        assert same(emitted, pirsim.run(model))
        assert not np.array_equal(emitted.bits, trace.emit().bits)
        assert same(emitted, trace.emit(effects=effects, seed=model.script.seed))
        assert not np.array_equal(emitted.bits, trace.emit(effects=effects, seed=100).bits)


def test_effects_that_a_trace_can_not_show_are_refused(study, room, study_a):
    trace = pirsim.trace(pirsim.compile(*study, set={"replicates": 1}))
    with pytest.raises(pirsim.UsageError, match="'sensor_yaw' changes what the optics show"):
        trace.emit(effects=["sensor_yaw"])
    with pytest.raises(pirsim.Error, match="did you mean 'dead_time'"):
        trace.emit(effects=["dead_tyme"])
    with pytest.raises(TypeError, match="dead_time"):
        trace.emit(effects=[{"dead_time": {}, "x": {}}])
    other = pirsim.compile(room, study_a, set={"replicates": 1})
    with pytest.raises(pirsim.UsageError, match="other optics"):
        trace.emit(model=other)
    with pytest.raises(TypeError, match="pirsim.Model"):
        trace.emit(model="office.yaml")


@pytest.mark.parametrize("response", ["zones", "analog"])
@pytest.mark.filterwarnings("ignore:.*makes no use of")
def test_a_trace_serves_other_electronics(study, response):
    scene, script = study
    settings = {"replicates": 2, "sensing.response": response}
    plain = pirsim.compile(scene, script, set=settings)
    trace = pirsim.trace(plain)
    assert same(trace.emit(), pirsim.run(plain))
    altered = plain.scene
    for sensor in altered.sensor_models.values():
        sensor.detector.amplifier.low_hz = 0.7
        sensor.detector.comparator.positive_v = 0.25
        sensor.detector.report.hold_s = 2.0
    other = pirsim.compile(altered, plain.script)
    emitted = trace.emit(model=other)
    assert same(emitted, pirsim.run(other))
    assert not np.array_equal(emitted.bits, trace.emit().bits)
    noise = trace.emit(model=other, seed=100)
    assert np.array_equal(noise.bits, emitted.bits) == (response == "zones") and noise.seed == 100


def test_the_catalogue_is_the_command_lines(command):
    import json

    effects = pirsim.effects()
    assert len(effects) == len({effect.name for effect in effects}) >= 27
    text = command("effects")
    for effect in effects:
        assert effect.name in text
        assert effect.reach in ("geometry", "triggers", "rows")
        for parameter in effect.parameters:
            assert parameter.least <= parameter.typical <= parameter.most
    assert json.dumps([effect.name for effect in effects])
