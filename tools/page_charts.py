#!/usr/bin/env python3
"""Saves charts of report pages as PNG pictures for the documentation, as headless Chromium draws them.

Usage: page_charts.py PAGE.html FOLDER BEGINNING=NAME...
       The chart whose title starts with BEGINNING becomes FOLDER/NAME.png. Needs Chromium (tools/install_deps --all).
"""
import base64
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SAVE = """<script>
setTimeout(() => {
  const charts = {};
  document.querySelectorAll("figure").forEach((figure) => {
    const drawn = figure.querySelector("canvas"), picture = document.createElement("canvas");
    if (!drawn) return;
    picture.width = drawn.width;
    picture.height = drawn.height;
    const context = picture.getContext("2d");
    context.fillStyle = "#ffffff";
    context.fillRect(0, 0, picture.width, picture.height);
    context.drawImage(drawn, 0, 0);
    charts[figure.querySelector("figcaption").firstChild.textContent] = picture.toDataURL("image/png");
  });
  document.body.dataset.saved = btoa(unescape(encodeURIComponent(JSON.stringify(charts))));
}, 3000);
</script>"""


def charts_of(page: str) -> dict:
    """The PNG of every chart of an HTML page, by its title."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not chromium:
        sys.exit("no Chromium here: tools/install_deps --all installs it")
    with tempfile.TemporaryDirectory() as name:
        file = pathlib.Path(name) / "page.html"
        file.write_text(page.replace("</body>", SAVE + "</body>"), encoding="utf-8")
        command = [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", f"--user-data-dir={name}/profile",
                   "--window-size=1400,30000", "--force-device-scale-factor=1.5", "--virtual-time-budget=20000", "--dump-dom",
                   file.as_uri()]
        dom = subprocess.run(command, capture_output=True, text=True, timeout=240, check=True).stdout
    saved = re.search(r'data-saved="([^"]*)"', dom)
    if not saved:
        sys.exit("the page drew nothing")
    charts = json.loads(base64.b64decode(saved.group(1)))
    return {title: base64.b64decode(url.split(",", 1)[1]) for title, url in charts.items()}


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    page, folder, *wanted = sys.argv[1:]
    charts = charts_of(pathlib.Path(page).read_text(encoding="utf-8"))
    for pair in wanted:
        beginning, name = pair.split("=", 1)
        found = [png for title, png in charts.items() if title.startswith(beginning)]
        if found:
            (pathlib.Path(folder) / f"{name}.png").write_bytes(found[0])
        else:
            print(f"{page} has no chart '{beginning}...'", file=sys.stderr)


if __name__ == "__main__":
    main()
