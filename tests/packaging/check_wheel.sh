#!/usr/bin/env bash
# What a wheel holds and needs. Builds it on a build of pirsim, unless it is there.
# Usage: check_wheel.sh SOURCE_DIR BUILD_DIR PYTHON [WHEEL]
set -euo pipefail
source=$1 build=$2 python=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
wheel=${4:-}
if [ -z "$wheel" ]; then
  "$source/tools/wheel" "$build" "$python" "$scratch/wheels"
  wheel=$(ls "$scratch"/wheels/pirsim-*.whl)
fi
"$python" -m zipfile -l "$wheel" >"$scratch/content"
for file in pirsim/_core.pyi pirsim/pirsim pirsim/py.typed pirsim/specs.py pirsim/counting/__main__.py \
  pirsim/data/sensors/EKMC1604111.yaml libembree libtbb dist-info/licenses/third_party/licences.toml; do
  grep -q "$file" "$scratch/content" || { echo "wheel: no $file in $wheel" >&2; exit 1; }
done
! grep -qE '\.(a|hpp|cmake) |share/|__pycache__' "$scratch/content" || { echo "wheel: more than a package in $wheel" >&2; exit 1; }
"$python" -m zipfile -e "$wheel" "$scratch/unpacked"
chmod +x "$scratch/unpacked/pirsim/pirsim"
python3 "$source/tests/packaging/check_licences.py" "$source" "$scratch"/unpacked/pirsim/{pirsim,_core*.so}
# Debian 12's libraries need glibc 2.34, and nothing of pirsim's needs a newer one.
if grep -qs 'VERSION_ID="12"' /etc/os-release && [[ "$wheel" != *manylinux_2_34_x86_64* ]]; then
  echo "wheel: it asks for a newer glibc than 2.34: $(basename "$wheel")" >&2
  exit 1
fi
echo "wheel: $(basename "$wheel"), $(($(stat -c %s "$wheel") / 1024)) KiB"
