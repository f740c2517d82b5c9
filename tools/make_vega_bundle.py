#!/usr/bin/env python3
"""Joins Debian's libjs-vega into one script that defines `vega`, for pages that work without a network.

Usage: make_vega_bundle.py VEGA_DIRECTORY OUTPUT.js

Debian 12 ships one file a module, each of which sets `globalThis.vega` anew; here each is wrapped behind a small
`require`. Debian 13 ships the whole as vega.min.js, which is taken as it is.
"""
import pathlib
import re
import sys

# What Vega's own entry file gathers, less maps, force layouts, word clouds and the like.
MODULES = ["util", "time", "format", "loader", "dataflow", "canvas", "expression", "event-selector", "statistics",
           "scale", "scenegraph", "selection", "functions", "runtime", "transforms", "view-transforms", "encode",
           "view", "parser"]
# The package's file names and what the others call them.
CALLED = {"selection": "vega-selections"}

LICENCE = """/*! Vega (https://vega.github.io), Copyright 2015-2021 UW Interactive Data Lab, BSD-3-Clause licence;
 * bundles parts of D3 (https://d3js.org), Copyright Mike Bostock, ISC and BSD-3-Clause licences. */
"""
LOADER = """var vega = (function () {
"use strict";
var modules = {}, loaded = {};
function require(name) {
  if (!(name in modules)) return {};
  if (!(name in loaded)) { loaded[name] = {}; modules[name](loaded[name], { exports: loaded[name] }, require); }
  return loaded[name];
}
"""
ENTRY = """
var all = { version: "5", transforms: {} };
["vega-transforms", "vega-view-transforms", "vega-encode"].forEach(function (name) {
  var module = require(name);
  for (var key in module) all.transforms[key] = module[key];
});
Object.assign(require("vega-dataflow").transforms, all.transforms);
["vega-util", "vega-time", "vega-format", "vega-loader", "vega-dataflow", "vega-scale", "vega-scenegraph",
 "vega-runtime", "vega-functions", "vega-view", "vega-parser"].forEach(function (name) {
  var module = require(name);
  for (var key in module) if (!(key in all)) all[key] = module[key];
});
return all;
})();
"""


def bundle(directory: pathlib.Path) -> str:
    whole = directory / "vega.min.js"
    if whole.exists():
        return LICENCE + whole.read_text()
    parts = [LICENCE, LOADER]
    for module in MODULES:
        text = re.sub(r"//# sourceMappingURL=.*", "", (directory / f"vega-{module}.min.js").read_text())
        name = CALLED.get(module, f"vega-{module}")
        parts.append(f'modules["{name}"] = function (exports, module, require) {{\n{text.strip()}\n}};\n')
    parts.append(ENTRY)
    return "".join(parts)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    # Inside a page, `</script` would end the script.
    text = re.sub("</(script)", r"<\\/\1", bundle(pathlib.Path(sys.argv[1])), flags=re.IGNORECASE)
    pathlib.Path(sys.argv[2]).write_text(text)


if __name__ == "__main__":
    main()
