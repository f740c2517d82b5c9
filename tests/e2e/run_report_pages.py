#!/usr/bin/env python3
"""Opens the reports of small studies in headless Chromium: every chart is drawn, nothing is fetched, nothing goes
wrong on the console, and pointing at a chart shows a value.

Usage: run_report_pages.py PIRSIM DATA_DIRECTORY; exits with 77 (skipped) where there is no Chromium.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

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
  document.body.dataset.shown = JSON.stringify(shown);
}, 3000);
</script>"""


def check_page(chromium, page, expected, folder, widths=(1400, 500)):
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


def main():
    pirsim, data = sys.argv[1], pathlib.Path(sys.argv[2])
    chromium = chromium_or_skip()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene = ["-q", "--scene", str(data / "rooms/meeting_room.gltf")]
        subprocess.run([pirsim, "coverage", *scene, "--script", str(data / "studies/studyB.yaml"), "--set",
                        "spacing_m=0.1", "-o", str(folder / "maps"), "--report", str(folder / "maps.html")], check=True)
        check_page(chromium, folder / "maps.html", 5, folder)
        subprocess.run([pirsim, "run", *scene, "--script", str(data / "studies/studyA.yaml"), "--replicates", "2", "--set",
                        "trials.for_each.seat=[S1, S7]", "--set", "people.0.actions.3.work.duration_s=30", "-o",
                        str(folder / "rows.csv"), "--report", str(folder / "study.html")], check=True)
        check_page(chromium, folder / "study.html", 12, folder)
    print("reports: both pages are whole")


if __name__ == "__main__":
    main()
