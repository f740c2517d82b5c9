"""Light in Python: what the command line says of the same rows."""

import csv
import io

import numpy as np
import pytest

import pirsim

RULE = {"lights": [{"id": "one", "sensors": ["PIR1"], "delay_min": 1}, {"id": "any", "delay_min": [0, 2]}]}


@pytest.fixture(scope="module")
def model(room, study_a):
    return pirsim.compile(room, study_a, set={"replicates": 1})


@pytest.fixture(scope="module")
def result(model):
    return pirsim.run(model)


def assert_same_numbers(light, told):
    """told: rows of the command's table, which rounds to six decimals."""
    assert [row["light"] for row in told] == light.columns["light"].tolist()
    assert told[0].keys() == light.columns.keys()
    for column in told[0].keys() - {"light"}:
        np.testing.assert_array_equal([float(f"{value:.6f}") for value in light.columns[column]],
                                      [float(row[column] or "nan") for row in told])


def test_costs_are_those_of_the_command_line(result, room, study_a, command, tmp_path):
    rows, costs, rule = tmp_path / "rows.csv", tmp_path / "costs.csv", tmp_path / "rule.yaml"
    rule.write_text("pirsim_control: 1\nlights: [{id: one, sensors: [PIR1], delay_min: 1}, {id: any, delay_min: [0, 2]}]\n")
    command("--scene", room, "--script", study_a, "--replicates", 1, "-q", "-o", rows)
    command("control", rows, "--rule", rule, "-o", costs, "--light", tmp_path / "lit.csv", "-q")
    light = pirsim.control(result, RULE)
    assert light.lights == ("one", "any")
    told = list(csv.DictReader(io.StringIO(costs.read_text())))
    assert_same_numbers(light, told)
    lit = [int(row["lit_any"]) for row in csv.DictReader((tmp_path / "lit.csv").open())]
    assert light.lit[:, :, 1][result.valid].tolist() == lit
    assert pirsim.control(result, rule).columns["lit_h"].tolist() == light.columns["lit_h"].tolist()


def test_with_its_model_a_result_is_switched_as_the_command_does_with_scene_and_script(data, command, tmp_path):
    """Each area's light by the sensors that watch it."""
    scene, script = data / "rooms" / "two_rooms.gltf", data / "studies" / "two_rooms.yaml"
    rows, costs = tmp_path / "rows.csv", tmp_path / "costs.csv"
    command("--scene", scene, "--script", script, "--replicates", 1, "-q", "-o", rows)
    command("control", rows, "--scene", scene, "--script", script, "-o", costs, "-q")
    model = pirsim.compile(scene, script, set={"replicates": 1})
    light = pirsim.control(pirsim.run(model), model=model)
    assert len(light.lights) == 2
    assert_same_numbers(light, list(csv.DictReader(io.StringIO(costs.read_text()))))


def test_a_delay_of_nothing_is_lit_with_motion_alone(result):
    light = pirsim.control(result, {"lights": [{"delay_min": 0}]})
    assert (light.lit[:, :, 0] == result.bits.any(axis=2)).all()
    at = light.at(0)
    dark = (result.people > 0) & ~result.bits.any(axis=2)
    assert at["dark_h"] == pytest.approx(dark.sum() / 3600, abs=1e-5)
    assert light.at(60)["dark_h"] < at["dark_h"]
    assert "light_1, 1 min" in repr(light)


def test_a_rule_that_does_not_fit_is_an_input_error(result, tmp_path):
    with pytest.raises(pirsim.InputError, match="no sensor 'PIR9'"):
        pirsim.control(result, {"lights": [{"sensors": ["PIR9"]}]})
    with pytest.raises(pirsim.InputError, match="unknown key 'delay'"):
        pirsim.control(result, {"lights": [{"delay": 5}]})
    with pytest.raises(pirsim.FileError):
        pirsim.control(result, tmp_path / "nowhere.yaml")
    with pytest.raises(KeyError, match="no light 'light' with a delay of 7.5 min"):
        pirsim.control(result).at(7.5)
