"""What nobody knows is unknown, however it is written: in arrays and in a dataset's rows."""

import json

import numpy as np
import pytest

import pirsim
from pirsim import counting
from pirsim.counting import _readings

BITS = [[0, 1], [1, 2], [2, 2], [1, 0]]  # 2: unknown


def written(as_what):
    known = [[None if bit == 2 else bit for bit in row] for row in BITS]
    if as_what == "None":
        return known
    if as_what == "empty texts":
        return [["" if bit is None else str(bit) for bit in row] for row in known]
    if as_what == "NaN":
        return np.array(known, dtype=float)
    values = np.array([[0 if bit is None else bit for bit in row] for row in known])
    unknown = np.array(BITS) == 2
    if as_what == "pandas":
        pd = pytest.importorskip("pandas")
        return pd.DataFrame(known, columns=["A", "B"]).astype("Int64")
    masked = {"masked": values, "masked bits": values.astype(bool), "masked numbers": values.astype(float)}
    return np.ma.array(masked[as_what], mask=unknown)


@pytest.mark.parametrize("as_what", ["None", "empty texts", "NaN", "masked", "masked bits", "masked numbers", "pandas"])
def test_unknown_bits_of_an_array(as_what):
    assert _readings.as_motion(written(as_what)).tolist() == BITS


def test_bits_are_numbers():
    for bits in (np.array(BITS, dtype=complex), np.array(BITS).astype("datetime64[s]")):
        with pytest.raises(ValueError, match="expected numbers, got"):
            _readings.as_motion(bits)


def test_a_live_count_takes_one_reading():
    assert _readings.as_reading([0, 1]).tolist() == [[0, 1]]
    with pytest.raises(ValueError, match="expected one reading, got 2"):
        _readings.as_reading([[0, 1], [1, 1]])


def test_unknown_people_of_a_day():
    for people in ([1, None, 2, 0], [1, np.nan, 2, 0], np.ma.array([1, 7, 2, 0], mask=[0, 1, 0, 0]), [1, -1, 2, 0]):
        assert _readings.as_day(counting.Day(1, BITS, people)).people.tolist() == [1, -1, 2, 0]
    with pytest.raises(ValueError, match="a whole number of people"):
        _readings.as_day(counting.Day(1, BITS, [1, 0.5, 2, 0]))
    with pytest.raises(ValueError):
        _readings.as_motion([["x"]])


def dataset(folder, lines, header="room,day,time_s,time,people,presence,arrivals,departures,A,B"):
    (folder / "rows").mkdir(exist_ok=True)
    (folder / "rows/day.csv").write_text("\n".join([header, *lines, ""]))
    resources = [{"name": "train", "path": ["rows/day.csv"]}]
    (folder / "datapackage.json").write_text(json.dumps({"resources": resources}))
    return folder


def day_row(i, a, people=1):
    return f"7,3,{10 * i},2026-03-02T08:{i // 6:02}:{10 * (i % 6):02},{people},1,0,0,{a},"


def test_unknown_fields_of_a_dataset(tmp_path):
    # Readings of three rows: motion is known beside what isn't; without, a reading is unknown. The room has no B.
    bits = ["0", "0", "0", "", "1", "0", "0", "", "0", "1", "0", "0"]
    lines = [day_row(i + 1, bit, "" if i == 5 else i) for i, bit in enumerate(bits)]
    (day,) = counting.read_dataset(dataset(tmp_path, lines), "train", step_s=30)
    assert day.room == 7
    assert day.motion.tolist() == [[0], [1], [2], [1]]
    assert day.people.tolist() == [2, -1, 8, 11]
    del lines[6:9]  # a gap
    (day,) = counting.read_dataset(dataset(tmp_path, lines), "train", step_s=30)
    assert day.motion.tolist() == [[0], [1], [2], [1]]
    assert day.people.tolist() == [2, -1, -1, 11]


def test_faulty_fields_of_a_dataset(tmp_path):
    good = [day_row(i, 0) for i in range(1, 9)]
    for lines, told in (([*good[:4], day_row(5, 2)], r"day\.csv:6:\d+: error: A: expected 0 or 1, got '2'"),
                        ([*good[:4], day_row(4, 0)], "day.csv:6:5: error: time_s doesn't grow: 40 after 40"),
                        ([*good, day_row(9, 0).replace("7,3,", "7,4,")], "day.csv:10:3: error: rows of more than one day"),
                        ([good[0], day_row(2, 0) + "1"], "B: its field is empty in the first row of this day")):
        with pytest.raises(pirsim.InputError, match=told):
            counting.read_dataset(dataset(tmp_path, lines), "train")
    with pytest.raises(pirsim.InputError, match="column 'people' is missing"):
        counting.read_dataset(dataset(tmp_path, ["1,1,1,0"], "room,day,time_s,A"), "train")
