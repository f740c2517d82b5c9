#!/usr/bin/env python3
"""Pictures as a user sees them, by their pixels: previews of a room; and what a report shows of a long run.

Usage: run_pictures.py PIRSIM DATA_DIRECTORY
"""
import pathlib
import re
import subprocess
import sys
import tempfile

from box_scene import write_long_office
from png import Picture, box

BACKGROUND = (244, 246, 249)  # of a preview
VISIT = """
pirsim_script: 1
duration_s: 40
people:
  - {id: anna, actions: [{appear: {at_xz_m: [34, -2]}}, {wait: {duration_s: 40}}]}
"""


class Pictures:
    def __init__(self, pirsim, data, folder):
        self.pirsim, self.data, self.folder = pirsim, data, folder
        write_long_office(folder / "long.gltf")
        (folder / "visit.yaml").write_text(VISIT, encoding="utf-8")
        self.long = ["--scene", folder / "long.gltf", "--script", folder / "visit.yaml", "--time", 5]
        self.meeting = ["--scene", data / "rooms/meeting_room.gltf", "--script", data / "studies/studyA.yaml", "--time", 20]

    def call(self, *args):
        subprocess.run([self.pirsim, *map(str, args), "-q"], check=True)

    def preview(self, *args):
        self.call("preview", *args, "-o", self.folder / "p.png")
        return Picture(self.folder / "p.png")


def check_room_fills_the_picture(pictures):
    for name, files in (("long office", pictures.long), ("meeting room", pictures.meeting)):
        for size in ((640, 360), (360, 640)):
            sized = [*files, "--beams", "none", "--width", size[0], "--height", size[1]]
            bare = pictures.preview(*sized, "--labels", "none")
            left, top, right, bottom = box(bare.places(lambda colour: colour != BACKGROUND))
            share = max((right - left) / size[0], (bottom - top) / size[1])
            assert share > 0.9, f"the {name} takes {share:.0%} of a picture of {size}"
            assert min(left, top, size[0] - 1 - right, size[1] - 1 - bottom) > 0, f"the {name} is cut in a picture of {size}"
            # With its names and its key the room is a little smaller, and the key stands beside it.
            keyed = pictures.preview(*sized, "--labels", "key,seats,sensors,doors,people")
            left, top, right, bottom = box(keyed.places(lambda colour: colour != BACKGROUND))
            cut = min(left, top, size[0] - 1 - right, size[1] - 1 - bottom) <= 0
            assert not cut, f"the {name} or its key is cut in a picture of {size}"
    print("preview: rooms fill the picture and none is cut")


def check_lettering_is_smooth(pictures):
    """Of the key alone: the camera looks away from the room."""
    key = pictures.preview(*pictures.meeting, "--beams", "none", "--camera=50,50,50", "--look-at=90,50,90")
    shades = {key.at(x, y) for x, y in key.places(lambda colour: colour != BACKGROUND)}
    assert len(shades) > 60, f"{len(shades)} shades: letters without smooth edges"
    print(f"preview: letters have smooth edges ({len(shades)} shades)")


def check_leader(pictures):
    files = [*pictures.long, "--beams", "none"]
    named = pictures.preview(*files, "--labels", "people").differs(pictures.preview(*files, "--labels", "none"))
    left, _, right, bottom = box(named)
    lowest = [x for x, y in named if y > bottom - 6]
    assert max(lowest) - min(lowest) < 8 < right - left, "no line leads from the name to the person"
    print("preview: a line leads from a name to its person")


def check_report_of_a_long_run(pictures):
    """It has the charts of a schedule's days, and says what the map of the floor shows."""
    titles = {}
    for name, times in (("scheduled", 'schedule: {from: "09:00", to: "11:00", staff: [{count: 1}], arrival: {mean: "09:10"}}'),
                        ("plain", "duration_s: 7200\npeople:\n  - {id: anna, style: natural, actions: [{enter: front_door}, "
                                  "{sit: S1}, {work: {duration_s: 7000}}]}")):
        script = pictures.folder / f"{name}.yaml"
        script.write_text(f"pirsim_script: 1\n{times}\n", encoding="utf-8")
        report = pictures.folder / f"{name}.html"
        pictures.call("run", "--scene", pictures.data / "rooms/open_office.gltf", "--script", script, "-o",
                      pictures.folder / "rows.csv", "--report", report)
        page = re.sub(r"<script.*?</script>", "", report.read_text(encoding="utf-8"), flags=re.DOTALL)
        titles[name] = re.findall(r"<figcaption>(.*?)<", page)
        assert "Where people were" in titles[name], f"{name}: {titles[name]}"
        assert "how long somebody was in each" in page and "many more than" not in page, name
    assert titles["plain"] == titles["scheduled"], titles
    print("report: a long run's looks as that of a schedule's day")


def main():
    with tempfile.TemporaryDirectory() as name:
        pictures = Pictures(sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(name))
        checks = {check.__name__: check for check in (check_room_fills_the_picture, check_lettering_is_smooth, check_leader,
                                                      check_report_of_a_long_run)}
        for check in sys.argv[3:] or checks:
            checks[check](pictures)


if __name__ == "__main__":
    main()
