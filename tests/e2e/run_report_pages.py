#!/usr/bin/env python3
"""Opens the reports of small studies in headless Chromium: every chart is drawn, nothing is fetched, nothing goes
wrong on the console, and pointing at a chart shows a value.

Usage: run_report_pages.py PIRSIM DATA_DIRECTORY; exits with 77 (skipped) where there is no Chromium.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from box_scene import write_long_office
from browser import check_fetches_nothing, chromium_or_skip, opened, without_scripts

# Points at the middle of every chart, and writes down what the page then shows.
POINTER = """<script>
setTimeout(() => {
  const shown = [];
  document.querySelectorAll(".plot canvas").forEach((canvas) => {
    const box = canvas.getBoundingClientRect();
    const tip = document.getElementById("tip");
    let best = "";
    for (let i = 1; i < 12 && !best; ++i) for (let k = 1; k < 24 && !best; ++k) {
      const at = { bubbles: true, clientX: box.left + box.width * k / 24, clientY: box.top + box.height * i / 12 };
      canvas.dispatchEvent(new PointerEvent("pointermove", at));  // what later Vegas listen to
      canvas.dispatchEvent(new MouseEvent("mousemove", at));
      if (tip.style.visibility === "visible") best = tip.textContent;
    }
    shown.push(best);
  });
  // On maps, pairs of names that cover each other.
  let names = 0, covered = 0;
  document.querySelectorAll(".map .plot").forEach((place) => {
    const find = (item) => (item.items || []).flatMap((inner) => (inner.name === "names" ? [inner] : find(inner)));
    const boxes = find(place.view.scenegraph().root).flatMap((mark) => mark.items.map((item) => item.bounds));
    names += boxes.length;
    covered += boxes.filter((a, i) => boxes.slice(0, i).some((b) => a.x1 < b.x2 && b.x1 < a.x2 && a.y1 < b.y2 && b.y1 < a.y2))
      .length;
  });
  document.body.dataset.names = JSON.stringify([names, covered]);
  document.body.dataset.shown = JSON.stringify(shown);
}, 3000);
</script>"""


def check_page(chromium, page, expected, folder, widths=(1400, 500), least_names=0):
    check_fetches_nothing(page)
    text = page.read_text(encoding="utf-8")
    pointed = folder / ("pointed_" + page.name)
    pointed.write_text(text.replace("</body>", POINTER + "</body>"), encoding="utf-8")
    for width in widths:
        dom = without_scripts(opened(chromium, pointed, folder, f"{width},30000", "--disable-gpu"))
        plots, canvases = dom.count('class="plot'), dom.count("<canvas")
        assert plots == canvases == expected, f"{page.name}, {width} wide: {canvases} of {plots} charts, not {expected}"
        shown = re.search(r'data-shown="(.*?)"', dom, flags=re.DOTALL)
        assert shown, f"{page.name}: the pointer did not run"
        values = shown.group(1).replace("&quot;", '"')
        assert '""' not in values, f"{page.name}, {width} wide: a chart shows no value: {values}"
        names, covered = json.loads(re.search(r'data-names="(.*?)"', dom)[1])
        assert covered == 0, f"{page.name}, {width} wide: {covered} of {names} names lie on others"
        assert names >= least_names, f"{page.name}, {width} wide: {names} names"


def write_log(file):
    """Ten days of two sensors and a count, with a gap."""
    lines = ["time,A,B,people"]
    for i in range(10 * 480):
        of_day, day = i % 480, 1 + i // 480
        n = 2 if 160 < of_day < 360 else 0
        if not (day == 4 and 200 < of_day < 240):
            lines.append(f"2025-03-{day:02}T{of_day // 20:02}:{of_day % 20 * 3:02}:00,{int(n > 0 and i % 3 == 0)},"
                         f"{int(n > 0 and i % 4 != 0)},{n}")
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main():
    pirsim, data = sys.argv[1], pathlib.Path(sys.argv[2])
    chromium = chromium_or_skip()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene = ["-q", "--scene", str(data / "rooms/meeting_room.gltf")]
        subprocess.run([pirsim, "coverage", *scene, "--script", str(data / "studies/studyB.yaml"), "--set",
                        "spacing_m=0.2", "-o", str(folder / "maps"), "--report", str(folder / "maps.html")], check=True)
        check_page(chromium, folder / "maps.html", 6, folder, least_names=6 * 8)
        write_long_office(folder / "long.gltf")
        subprocess.run([pirsim, "coverage", "-q", "--scene", str(folder / "long.gltf"), "--script",
                        str(data / "studies/studyB.yaml"), "--set", "spacing_m=0.5", "--set", "duration_s=2", "--set",
                        "without=[]", "-o", str(folder / "long"), "--report", str(folder / "long.html")], check=True)
        check_page(chromium, folder / "long.html", 7, folder, least_names=7 * 4)
        subprocess.run([pirsim, "run", *scene, "--script", str(data / "studies/studyA.yaml"), "--replicates", "2", "--set",
                        "trials.for_each.seat=[S1, S7]", "--set", "people.0.actions.3.work.duration_s=30", "-o",
                        str(folder / "rows.csv"), "--report", str(folder / "study.html")], check=True)
        check_page(chromium, folder / "study.html", 12, folder)
        write_log(folder / "log.csv")
        subprocess.run([pirsim, "log", "-q", str(folder / "log.csv"), "--report", str(folder / "log.html")], check=True)
        check_page(chromium, folder / "log.html", 3, folder)
    print("reports: all pages are whole, and no name lies on another")


if __name__ == "__main__":
    main()
