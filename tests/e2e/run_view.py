#!/usr/bin/env python3
"""Opens the page of `pirsim view` in headless Chromium: it fetches nothing and says nothing on the console, the whole
room is in view, its rows are those of the CSV at ten moments, the picture changes with them, and slider and keyboard work.

Usage: run_view.py PIRSIM DATA_DIRECTORY; exits with 77 (skipped) where there is no Chromium.
"""
import csv
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

DRIVER = """<script>
// Whether the picture's edges show nothing but its background: the whole room is in view.
const framed = async (url) => {
  const picture = new Image(), paper = document.createElement("canvas");
  picture.src = url;
  await picture.decode();
  const [width, height] = [paper.width, paper.height] = [picture.width, picture.height];
  const context = paper.getContext("2d", { willReadFrequently: true });
  context.drawImage(picture, 0, 0);
  const edges = [[0, 0, width, 1], [0, height - 1, width, 1], [0, 0, 1, height], [width - 1, 0, 1, height]];
  return edges.every((edge) => context.getImageData(...edge).data.every((v, i, all) => v === all[i % 4]));
};
(async () => {
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  while (!document.body.dataset.ready) await wait(50);
  const slider = document.getElementById("time"), seen = { rows: [], frames: [], keys: [] };
  const press = (key) => document.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  for (const t of [...MOMENTS, MOMENTS[0]]) {  // the first once more, which must look as it did
    slider.value = t;
    slider.dispatchEvent(new Event("input"));
    while (Number(document.body.dataset.drawn) !== t) await wait(20);
    seen.rows.push(document.body.dataset.row);
    seen.frames.push(document.getElementById("view").toDataURL());
  }
  press("ArrowLeft"); seen.keys.push(Number(slider.value));
  press("ArrowRight"); seen.keys.push(Number(slider.value));
  press("Home"); seen.keys.push(Number(slider.value));
  press(" "); await wait(1000); press(" ");
  seen.keys.push(Number(slider.value));
  seen.same = seen.frames.pop() === seen.frames[0] && seen.rows.pop() === seen.rows[0];
  seen.framed = await framed(seen.frames[0]);
  seen.frames = new Set(seen.frames).size;
  document.body.dataset.seen = JSON.stringify(seen);
})();
</script>"""


def main():
    pirsim, data = sys.argv[1], pathlib.Path(sys.argv[2])
    chromium = chromium_or_skip()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        study = ["-q", "--scene", str(data / "rooms/meeting_room.gltf"), "--script", str(data / "studies/studyA.yaml")]
        page = folder / "run.html"
        subprocess.run([pirsim, "view", *study, "--trial", "S1", "-o", str(page)], check=True)
        subprocess.run([pirsim, "run", *study, "--replicates", "1", "--set", "trials.for_each.seat=[S1]", "-o",
                        str(folder / "rows.csv")], check=True)
        with open(folder / "rows.csv", newline="", encoding="utf-8") as file:
            rows = {float(row[2]): ",".join(row[2:]) for row in list(csv.reader(file))[1:]}
        check_fetches_nothing(page)
        text = page.read_text(encoding="utf-8")
        page.write_text(text.replace("</body>", DRIVER.replace("MOMENTS", json.dumps(MOMENTS)) + "</body>"),
                        encoding="utf-8")
        dom = opened(chromium, page, folder, "900,700", "--use-gl=angle", "--use-angle=swiftshader",
                     "--enable-unsafe-swiftshader",
                     # Waiting spends virtual time at once, drawing takes as long as it takes on a busy machine.
                     "--virtual-time-budget=3000000")
    assert 'data-ready="room"' in dom, "the room isn't drawn"
    seen = json.loads(html.unescape(re.search(r'data-seen="(.*?)"', dom, re.DOTALL).group(1)))
    assert seen["rows"] == [rows[t] for t in MOMENTS], (seen["rows"], [rows[t] for t in MOMENTS])
    assert seen["same"], "a moment that is shown a second time looks otherwise"
    assert seen["frames"] == len(MOMENTS), f"{seen['frames']} different pictures of ten moments"
    assert seen["framed"], "part of the room is out of view at the beginning"
    left, right, home, played = seen["keys"]
    assert (left, right, home) == (MOMENTS[0] - 1, MOMENTS[0], 0), seen["keys"]
    assert 0 < played < 5, f"a second of playing ended at {played} s"
    print(f"view: ten moments agree with the rows, {seen['frames']} different pictures")


if __name__ == "__main__":
    main()
