#!/usr/bin/env python3
"""Opens pages of `pirsim view` in headless Chromium. They fetch nothing and say nothing on the console.

- A run of Study A: its rows are those of the CSV at ten moments, the picture changes with them, slider and keyboard work,
  and who isn't there has no name in the picture.
- Ten minutes with three people, with a coverage map: at most 5 MB; the map is drawn, of all sensors and of one; an address
  as reports of reconcile name it opens the moment and the sensor; no name lies on another.
- A day of a dataset: its rows are those of the dataset.
- An office of 40 m: on a wide page and on a narrow one all of it is in view and the legend covers nothing of it; where
  the user likes it dark the room and the rows of the sensors are dark, and names can be read.
- Where rows have a clock the time line has its marks at the clock's whole minutes.

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

from box_scene import write_long_office
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

OFFICE_STEPS = """
  while (document.body.dataset.drawn !== String(Number(slider.value))) await wait(20);
  const legend = document.getElementById("legend"), copy = document.createElement("canvas");
  const over = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
  function measure() {
    const stage = document.getElementById("stage").getBoundingClientRect(), key = legend.getBoundingClientRect();
    const pen = Object.assign(copy, { width: stage.width, height: stage.height }).getContext("2d", { willReadFrequently: true });
    pen.drawImage(view, 0, 0, copy.width, copy.height);
    const { data, width, height } = pen.getImageData(0, 0, copy.width, copy.height), back = [...data.slice(0, 3)];
    const drawn = (x, y) => back.some((value, i) => Math.abs(data[4 * (y * width + x) + i] - value) > 8);
    let left = width, right = -1, top = height, bottom = -1, covered = 0;
    for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) {
      if (!drawn(x, y)) continue;
      left = Math.min(left, x); right = Math.max(right, x); top = Math.min(top, y); bottom = Math.max(bottom, y);
      covered += x < key.right - stage.left && x > key.left - stage.left && y < key.bottom - stage.top ? 1 : 0;
    }
    const doors = [...document.querySelectorAll("#labels .door")].filter((door) => door.style.display !== "none");
    return { back, covered, margins: [left, top, width - 1 - right, height - 1 - bottom], stage: [width, height],
      fills: Math.max((right - left) / width, (bottom - top) / height), open: legend.open,
      doors: doors.filter((door) => !over(door.getBoundingClientRect(), key)).length };
  }
  seen.first = measure();
  const rows = document.getElementById("rows"), scale = rows.width / rows.clientWidth;
  const at = rows.getContext("2d").getImageData((rows.clientWidth - 4) * scale, (46 + 3 * 20 + 8) * scale, 1, 1).data;
  seen.row = [...at.slice(0, 3)];
  const numbers = (colour) => colour.match(/[\\d.]+/g).map(Number);
  seen.names = ["seat", "door"].map((kind) => {
    const style = getComputedStyle(document.querySelector("#labels ." + kind));
    const [r, g, b, share = 1] = numbers(style.backgroundColor);
    return [numbers(style.color).slice(0, 3), [r, g, b].map((value, i) => share * value + (1 - share) * seen.first.back[i])];
  });
  document.getElementById("panel").style.display = "none";  // as a taller window
  window.dispatchEvent(new Event("resize"));
  let frames = 0;
  const count = () => ++frames < 3 && requestAnimationFrame(count);
  requestAnimationFrame(count);
  while (frames < 3) await wait(20);
  seen.taller = measure();
"""

CLOCK_STEPS = """
  seen.marks = document.getElementById("rows").getAttribute("aria-label");
  seen.notice = document.getElementById("notice").textContent;
  await showing(12);
  seen.now = document.getElementById("now").textContent;
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


LONG_VISIT = """
pirsim_script: 1
duration_s: 60
people:
  - {id: anna, actions: [{enter: door}, {sit: D4}, {work: {duration_s: 50}}]}
"""

OWN_CLOCK = """
pirsim_script: 1
begin: 2026-03-02T06:44:48
duration_s: 60
sensing: {window_s: 0.5}
people: [{id: anna, actions: [{enter: door, at: "06:45"}, {sit: S1}]}]
"""

MORNING = """
pirsim_script: 1
schedule: {first_day: 2026-03-02, from: "08:07", to: "08:27", staff: [{count: 2}], arrival: {mean: "08:10"}}
"""


def luminance(colour):
    """Of sRGB from 0 to 255, as WCAG 2 has it."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (value / 255 for value in colour)]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a, b):
    dark, light = sorted((luminance(a), luminance(b)))
    return (light + 0.05) / (dark + 0.05)


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

    def seen(self, page, steps, address="", size="900,700", flags=()):
        """What the steps found, on the page as its address opens it."""
        text = page.read_text(encoding="utf-8")
        page = page.with_stem(page.stem + "_seen")
        steps = TOOLS.replace("STEPS", steps).replace("MOMENTS", json.dumps(MOMENTS))
        page.write_text(text.replace("</body>", steps + "</body>"), encoding="utf-8")
        dom = opened(self.chromium, page, self.folder, size, *flags, "--use-gl=angle", "--use-angle=swiftshader",
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


def check_office(pages):
    write_long_office(pages.folder / "long.gltf")
    (pages.folder / "long.yaml").write_text(LONG_VISIT, encoding="utf-8")
    page = pages.made("long.html", "--scene", pages.folder / "long.gltf", "--script", pages.folder / "long.yaml")
    for size, is_open in (("1300,850", True), ("500,800", False), ("900,1200", True)):
        seen = pages.seen(page, OFFICE_STEPS, size=size)
        for state in ("first", "taller"):
            it = seen[state]
            assert min(it["margins"]) >= 3, f"{size}, {state}: the room is cut: {it}"
            assert it["fills"] > 0.55, f"{size}, {state}: the room is small: {it}"
            assert it["covered"] == 0 and it["doors"] == 1, f"{size}, {state}: the legend covers the room: {it}"
            assert it["open"] == is_open, f"{size}: the legend is {'open' if it['open'] else 'folded'}"
        assert luminance(seen["first"]["back"]) > 0.7 and luminance(seen["row"]) > 0.7, seen
    dark = pages.seen(page, OFFICE_STEPS, size="1300,850", flags=["--blink-settings=preferredColorScheme=0"])
    back = dark["first"]["back"]
    assert luminance(back) < 0.05, f"in the dark the room stands before {back}"
    assert luminance(dark["row"]) < 0.1, f"in the dark a sensor's row is {dark['row']}"
    for names in (seen["names"], dark["names"]):
        for text, back in names:
            assert contrast(text, back) > 4.5, f"a name of {text} on {back}"
    print("view: a long office is whole, wide and narrow; dark where the user likes it")


def check_clock(pages, data):
    (pages.folder / "morning.yaml").write_text(MORNING, encoding="utf-8")
    page = pages.made("morning.html", "--scene", data / "rooms/open_office.gltf", "--script", pages.folder / "morning.yaml")
    marks = re.findall(r"\d\d:\d\d(?::\d\d)?", pages.seen(page, CLOCK_STEPS)["marks"])
    assert len(marks) >= 4 and all(re.fullmatch(r"08:\d[02468]", mark) for mark in marks), marks
    (pages.folder / "anna.yaml").write_text(OWN_CLOCK, encoding="utf-8")
    page = pages.made("anna.html", "--scene", data / "rooms/meeting_room.gltf", "--script", pages.folder / "anna.yaml",
                      "--to", "06:45:38")
    seen = pages.seen(page, CLOCK_STEPS, "#t=55")
    assert re.findall(r"\d\d:\d\d:\d\d", seen["marks"])[:3] == ["06:44:50", "06:44:55", "06:45:00"], seen["marks"]
    assert "06:45:43 isn't on this page: it holds 06:44:48 to 06:45:38" in seen["notice"], seen["notice"]
    assert seen["now"].startswith("row 06:45:00: anna: outside"), seen["now"]
    assert seen["clock"] == "2026-03-02 06:45:00", seen["clock"]
    print("view: the time line has its marks where the clock shows whole minutes, a script's own clock too")


def main():
    data = pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        pages = Pages(sys.argv[1], pathlib.Path(name))
        checks = {"run": lambda: check_run(pages, data), "map": lambda: check_map(pages, data),
                  "day": lambda: check_day(pages, data), "office": lambda: check_office(pages),
                  "clock": lambda: check_clock(pages, data)}
        for check in sys.argv[3:] or checks:
            checks[check]()


if __name__ == "__main__":
    main()
