"""Pictures of the documentation: panels with axes, drawn by Vega as report pages draw their charts.

A picture is a title, a note that says what its lines and colours mean, and a list of panels; draw() writes all of them
as PNG files. Needs Chromium and libjs-vega
(tools/install_deps --all).
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from make_vega_bundle import bundle

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


VEGA = pathlib.Path("/usr/share/javascript/vega")
PALETTE = pathlib.Path(__file__).parents[1] / "src/show/palette.css"
# Lines told apart by colour: the pages' own, on white.
COLOURS = tuple(re.findall(r"--series-\d+: (#\w+)", PALETTE.read_text().split("@media")[0]))
# Lines in the background, what was measured or what a formula says, lines to guide the eye.
LIGHT, REFERENCE, GUIDE = "#9ecae1", COLOURS[1], "#999999"


def scale(name, bounds, pixels, kind="linear"):
    return {"name": name, "type": kind, "domain": bounds, "range": [0, pixels] if name == "x" else [pixels, 0], "nice": False,
            "zero": False}


def panel(title, size, x, y, marks, legends=(), kinds=("linear", "linear")):
    """A group with axes. x, y: (label, bounds, ticks or None)."""
    axes = [{"orient": orient, "scale": name, "title": label or None, "grid": True, "gridColor": "#e0e0e0", "zindex": 0,
             **({"values": ticks, "format": "~g"} if ticks else {"tickCount": 6})}
            for orient, name, (label, _, ticks) in (("bottom", "x", x), ("left", "y", y))]
    return {"type": "group", "title": {"text": title, "fontSize": 12},
            "encode": {"enter": {"width": {"value": size[0]}, "height": {"value": size[1]}}},
            "scales": [scale("x", x[1], size[0], kinds[0]), scale("y", y[1], size[1], kinds[1])], "axes": axes,
            "marks": [{"type": "group", "clip": True, "marks": marks,
                       "encode": {"enter": {"width": {"value": size[0]}, "height": {"value": size[1]}}}}, *legends]}


def at(value, of):
    return {"scale": of, "value": value} if not isinstance(value, str) else {"scale": of, "field": value}


def marks_of(kind, points, look):
    """Marks at (x, y) points; look: more of Vega's encoding."""
    values = [{"x": x, "y": y} for x, y in points]
    mark = {"type": kind, "encode": {"enter": {"x": at("x", "x"), "y": at("y", "y"),
                                               **{key: {"value": value} for key, value in look.items()}}}}
    return {"type": "group", "data": [{"name": "points", "values": values}], "marks": [{"from": {"data": "points"}, **mark}]}


def line(points, colour, width=1.5, dash=(1, 0)):
    return marks_of("line", points, {"stroke": colour, "strokeWidth": width, "strokeDash": list(dash)})


def key(entries, x, y):
    """Names beside short lines: (name, colour)."""
    marks = []
    for i, (name, colour) in enumerate(entries):
        row = y + 16 * i
        marks += [{"type": "rule", "encode": {"enter": {"x": {"value": x}, "x2": {"value": x + 18}, "y": {"value": row},
                                                        "stroke": {"value": colour}, "strokeWidth": {"value": 2}}}},
                  {"type": "text", "encode": {"enter": {"x": {"value": x + 24}, "y": {"value": row}, "text": {"value": name},
                                                        "baseline": {"value": "middle"}, "fontSize": {"value": 11}}}}]
    return marks


def heading(title, note):
    return {"text": title, "subtitle": note.split("\n"), "anchor": "start", "fontSize": 14, "subtitleFontSize": 12,
            "subtitlePadding": 4, "offset": 12, "frame": "group"}


def draw(pictures, folder, columns=3):
    """Writes folder/NAME.png for each picture, (title, note, panels) by its name; `columns` panels stand side by side."""
    specs = [{"padding": 8, "layout": {"columns": columns, "padding": 14, "bounds": "full", "align": "each"},
              "title": heading(title, note), "marks": panels} for title, note, panels in pictures.values()]
    figures = "".join(f"<figure><figcaption>{name}</figcaption><div></div></figure>" for name in pictures)
    vega = bundle(VEGA).replace("</script", "<\\/script")
    page = (f"<!DOCTYPE html><html><body>{figures}<script>{vega}</script><script>const specs = {json.dumps(specs)};"
            "specs.forEach((spec, i) => new vega.View(vega.parse(spec), {renderer: 'canvas'}).initialize("
            "document.querySelectorAll('figure div')[i]).runAsync());</script></body></html>")
    pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    for name, png in charts_of(page).items():
        (pathlib.Path(folder) / f"{name}.png").write_bytes(png)
