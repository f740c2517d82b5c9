#!/usr/bin/env python3
"""Opens pages of `pirsim view` in headless Chromium. They fetch nothing and say nothing on the console.

- A run of Study A: its rows are those of the CSV at ten moments, the picture changes with them, slider and keyboard work,
  and who isn't there has no name in the picture.
- Ten minutes with three people, with a coverage map: at most 5 MB; the map is drawn, of all sensors and of one; an address
  as reports of reconcile name it opens the moment and the sensor; no name lies on another.
- A day of a dataset: its rows are those of the dataset.

Usage: run_view.py PIRSIM DATA_DIRECTORY; exits with 77 (skipped) where there is no Chromium.
"""
import csv
import gzip
import html
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from browser import check_fetches_nothing, chromium_or_skip, opened

# On the way in and out, and at work at three phases of the arms' swing of 3 s: no two with the same posture.
MOMENTS = [3, 5, 8, 12, 15, 30, 61, 101, 200, 206]

TOOLS = """<script>
const wait = (ms) => new Promise((done) => setTimeout(done, ms));
const slider = document.getElementById("time"), view = document.getElementById("view");
async function showing(t) {
  slider.value = t;
  slider.dispatchEvent(new Event("input"));
  while (Number(document.body.dataset.drawn) !== t) await wait(20);
}
const names = () => [...document.querySelectorAll("#labels .person")].filter((name) => name.style.display !== "none")
                                                                     .map((name) => name.textContent);
const press = (key) => document.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
(async () => {
  while (!document.body.dataset.ready) await wait(50);
  const seen = {};
  STEPS
  document.body.dataset.seen = JSON.stringify(seen);
})();
</script>"""

RUN_STEPS = """
  Object.assign(seen, { rows: [], frames: [], keys: [] });
  for (const t of [...MOMENTS, MOMENTS[0]]) {  // the first once more, which must look as it did
    await showing(t);
    seen.rows.push(document.body.dataset.row);
    seen.frames.push(view.toDataURL());
  }
  seen.here = names();
  press("ArrowLeft"); seen.keys.push(Number(slider.value));
  press("ArrowRight"); seen.keys.push(Number(slider.value));
  press("Home"); seen.keys.push(Number(slider.value));
  await showing(0);
  seen.before = names();
  const frames = [];  // when, and what the slider says after it
  const note = (now) => { frames.push([now / 1000, Number(slider.value)]); requestAnimationFrame(note); };
  requestAnimationFrame(note);
  while (frames.length < 2) await wait(20);
  press(" ");
  while (frames.at(-1)[1] === 0) await wait(20);
  press(" ");
  const first = frames.findIndex(([, time]) => time > 0), paused = Number(slider.value), n = frames.length;
  seen.played = [frames[first][1], frames[first][0] - frames[first - 1][0]];
  while (frames.length < n + 2) await wait(20);
  seen.paused = Number(slider.value) === paused;
  seen.same = seen.frames.pop() === seen.frames[0] && seen.rows.pop() === seen.rows[0];
  seen.frames = new Set(seen.frames).size;
"""

MAP_STEPS = """
  while (document.body.dataset.drawn !== String(Number(slider.value))) await wait(20);
  seen.row = document.body.dataset.row;
  seen.chosen = document.querySelector("#gutter .chosen").textContent;
  const drawn = async () => {  // virtual time would be up if nothing waited for it
    let frames = 0;
    const count = () => ++frames < 3 && requestAnimationFrame(count);
    requestAnimationFrame(count);
    while (frames < 3) await wait(20);
    return view.toDataURL();
  };
  const one = await drawn();
  press("Escape");
  const all = await drawn();
  document.getElementById("map").click();
  const none = await drawn();
  seen.maps = new Set([one, all, none]).size;
  press("Home");
  await showing(300);
  seen.here = names();
  seen.now = document.getElementById("now").textContent;
  const boxes = [...document.querySelectorAll("#labels > *")].map((label) => label.getBoundingClientRect())
    .filter((box) => box.width > 0);
  seen.covered = boxes.filter((a, i) => boxes.slice(0, i).some((b) => a.left < b.right - 1 && b.left < a.right - 1 &&
    a.top < b.bottom - 1 && b.top < a.bottom - 1)).length;
"""

DAY_STEPS = """
  seen.rows = [];
  for (const t of MOMENTS) { await showing(t); seen.rows.push(document.body.dataset.row); }
  seen.clock = document.getElementById("clock").textContent;
"""

VISIT = """
pirsim_script: 1
name: three people for ten minutes
duration_s: 600
summary: {phases: [working]}
people:
  - {id: anna, style: natural, actions: [{enter: door}, {sit: S1}, {work: {duration_s: 500}}, {leave: door}]}
  - {id: ben, style: natural, actions: [{wait: {duration_s: 20}}, {enter: door}, {sit: S4}, {work: {duration_s: 500}}]}
  - {id: carla, style: natural, actions: [{wait: {duration_s: 40}}, {enter: door}, {sit: S8}, {work: {duration_s: 300}},
                                          {leave: door}]}
"""


class Pages:
    def __init__(self, pirsim, folder):
        self.pirsim, self.folder, self.chromium = pirsim, folder, chromium_or_skip()

    def call(self, *args):
        subprocess.run([self.pirsim, *map(str, args), "-q"], check=True)

    def made(self, name, *args):
        page = self.folder / name
        self.call("view", *args, "-o", page)
        check_fetches_nothing(page)
        return page

    def seen(self, page, steps, address=""):
        """What the steps found, on the page as its address opens it."""
        text = page.read_text(encoding="utf-8")
        steps = TOOLS.replace("STEPS", steps).replace("MOMENTS", json.dumps(MOMENTS))
        page.write_text(text.replace("</body>", steps + "</body>"), encoding="utf-8")
        dom = opened(self.chromium, page, self.folder, "900,700", "--use-gl=angle", "--use-angle=swiftshader",
                     "--enable-unsafe-swiftshader",
                     # Waiting spends virtual time at once, drawing takes as long as it takes on a busy machine.
                     "--virtual-time-budget=300000000", address=address)
        assert 'data-ready="room"' in dom, "the room isn't drawn"
        return json.loads(html.unescape(re.search(r'data-seen="(.*?)"', dom, re.DOTALL).group(1)))


def check_run(pages, data):
    study = ["--scene", data / "rooms/meeting_room.gltf", "--script", data / "studies/studyA.yaml"]
    page = pages.made("run.html", *study, "--trial", "S1")
    pages.call("run", *study, "--replicates", "1", "--set", "trials.for_each.seat=[S1]", "-o", pages.folder / "rows.csv")
    with open(pages.folder / "rows.csv", newline="", encoding="utf-8") as file:
        rows = {float(row[2]): ",".join(row[2:]) for row in list(csv.reader(file))[1:]}
    seen = pages.seen(page, RUN_STEPS)
    assert seen["rows"] == [rows[t] for t in MOMENTS], (seen["rows"], [rows[t] for t in MOMENTS])
    assert seen["same"], "a moment that is shown a second time looks otherwise"
    assert seen["frames"] == len(MOMENTS), f"{seen['frames']} different pictures of ten moments"
    assert seen["keys"] == [MOMENTS[0] - 1, MOMENTS[0], 0], seen["keys"]
    played, passed = seen["played"]
    assert abs(played - passed) < 0.01, f"in a picture of {passed} s the run went on by {played} s"
    assert seen["paused"], "it goes on after the second press of the space bar"
    assert (seen["before"], seen["here"]) == ([], ["occupant"]), "names of people: " + str((seen["before"], seen["here"]))
    print(f"view: ten moments agree with the rows, {seen['frames']} different pictures")


def check_map(pages, data):
    (pages.folder / "visit.yaml").write_text(VISIT, encoding="utf-8")
    (pages.folder / "map.yaml").write_text("pirsim_coverage: 1\nspacing_m: 0.1\nduration_s: 10\ntarget: {x_shapes: {}}\n",
                                           encoding="utf-8")
    page = pages.made("visit.html", "--scene", data / "rooms/meeting_room.gltf", "--script", pages.folder / "visit.yaml",
                      "--coverage", pages.folder / "map.yaml")
    size = page.stat().st_size
    assert size <= 5_000_000, f"ten minutes with three people take {size} bytes"
    seen = pages.seen(page, MAP_STEPS, "#phase=working&sensor=PIR4")
    assert seen["row"].split(",")[1] == "working" and seen["chosen"] == "PIR4", seen
    assert seen["maps"] == 3, "the map of a sensor, of all and none look alike"
    assert seen["here"] == ["anna", "ben", "carla"], seen["here"]
    assert seen["now"] == "row 300 s: anna: working, 3 people", seen["now"]
    assert seen["covered"] == 0, f"{seen['covered']} names lie on others"
    print(f"view: ten minutes, three people and a map in {size / 1e6:.1f} MB; an address opens phase and sensor")


def check_day(pages, data):
    days = pages.folder / "days"
    pages.call("dataset", data / "recipes/tiny.yaml", "-o", days)
    page = pages.made("day.html", "--scene", days / "rooms/room_0002.gltf", "--script",
                      days / "scripts/room_0002/day_02.yaml", "--replicate", 2)
    with gzip.open(days / "rows/room_0002/day_02.csv.gz", "rt", newline="", encoding="utf-8") as file:
        rows = {float(row["time_s"]): row for row in csv.DictReader(file)}
    seen = pages.seen(page, DAY_STEPS)
    for t, shown in zip(MOMENTS, seen["rows"]):
        time, _, people, *bits = shown.split(",")
        sensors = [name for name in rows[t] if name.startswith("PIR")]
        assert float(time) == t and people == rows[t]["people"] and bits == [rows[t][name] for name in sensors], shown
    assert seen["clock"] == rows[MOMENTS[-1]]["time"].replace("T", " "), seen["clock"]
    print("view: a day of a dataset agrees with its rows")


def main():
    data = pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        pages = Pages(sys.argv[1], pathlib.Path(name))
        check_run(pages, data)
        check_map(pages, data)
        check_day(pages, data)


if __name__ == "__main__":
    main()
