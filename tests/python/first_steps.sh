#!/bin/sh
# What somebody does first with a wheel: installs it in /venv, and gets rows, a page, a dataset, and arrays in Python,
# from a folder that has none of pirsim's files. Tells the seconds of each. Needs python3 with venv, and nothing else.
# Usage: first_steps.sh FOLDER_OF_WHEELS [VENV] (default: /venv)
set -eu
house=$1 venv=${2:-/venv}
folder=$(mktemp -d)
cd "$folder"
step() {  # name, command
  name=$1 began=$(date +%s.%N)
  shift
  "$@"
  echo "$name: $(echo "$began $(date +%s.%N)" | awk '{printf "%.1f", $2 - $1}') s"
}
step "a virtual environment" python3 -m venv "$venv"
step "pip install" "$venv/bin/pip" install --quiet --disable-pip-version-check --no-index --find-links "$house" pirsim
PATH=$venv/bin:$PATH
pirsim --version
step "rows of Study A, 2000 runs" pirsim --scene meeting_room.gltf --script studyA.yaml -q -o rows.csv
[ "$(wc -l <rows.csv)" -gt 300000 ]
step "view, a run as a page" pirsim view --scene meeting_room.gltf --script studyA.yaml -q -o run.html
step "a dataset" pirsim dataset tiny.yaml -q -o tiny
[ -s tiny/datapackage.json ]
cat >ten_lines.py <<PY
import pirsim

model = pirsim.compile("meeting_room.gltf", "studyA.yaml", set={"replicates": 2})
result = pirsim.run(model)
print("bits", result.bits.shape, "people", int(result.people.max()))
coverage = pirsim.coverage("meeting_room.gltf", "studyB.yaml", set={"spacing_m": 1.0})
print("coverage of", ", ".join(coverage.sensors))
PY
step "ten lines of Python" python ten_lines.py
"$venv/bin/python" -m pirsim data flat.gltf
cd /
rm -r "$folder"
