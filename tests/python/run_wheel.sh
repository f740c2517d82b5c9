#!/usr/bin/env bash
# Builds the wheel on an installed pirsim, has auditwheel bundle the shared libraries, and tries it where there is
# neither a compiler nor Embree: in a bare Debian system made by debootstrap. Without root, debootstrap or a Debian
# mirror the last part can't be done: exit code 77.
# Usage: run_wheel.sh SOURCE_DIR BUILD_DIR PYTHON [FOLDER for the wheel]
set -euo pipefail
source=$1 build=$2 python=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
wheels=${4:-$scratch/wheels}
mkdir -p "$wheels"
bin=$(dirname "$python")

cmake --install "$build" --prefix "$scratch/prefix" >/dev/null
"$python" -m pip wheel --quiet --disable-pip-version-check --no-build-isolation --no-deps "$source" -w "$scratch/plain" \
  --config-settings cmake.source-dir=python --config-settings build-dir="$scratch/build" --config-settings cmake.define.CMAKE_PREFIX_PATH="$scratch/prefix"
PATH=$bin:$PATH "$python" -m auditwheel repair --wheel-dir "$wheels" "$scratch"/plain/pirsim-*.whl >"$scratch/repair.log" 2>&1 || {
  cat "$scratch/repair.log" >&2
  exit 1
}
wheel=$(ls "$wheels"/pirsim-*.whl)
"$python" -m zipfile -l "$wheel" >"$scratch/content"
for file in pirsim/_core.pyi pirsim/py.typed pirsim/specs.py pirsim/counting/__main__.py pirsim/data/sensors/EKMC1604111.yaml libembree libtbb; do
  grep -q "$file" "$scratch/content" || { echo "wheel: no $file in $wheel" >&2; exit 1; }
done
! grep -qE '\.(a|hpp|cmake)|share/|__pycache__' "$scratch/content" || { echo "wheel: more than a package in $wheel" >&2; exit 1; }
echo "wheel: $(basename "$wheel"), $(($(stat -c %s "$wheel") / 1024)) KiB"

if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
  echo "wheel: built and repaired, but NOT tried in a bare system: that needs root and debootstrap" >&2
  exit 77
fi
# What the wheel and its tests need, fetched here: the bare system needs no network.
"$python" -m pip download --quiet --disable-pip-version-check --only-binary :all: -d "$scratch/house" "$wheel" pytest
release=$(. /etc/os-release && echo "$VERSION_CODENAME")
mirror=$(sed -nE 's/^deb (\[[^]]*\] )?(http[^ ]*) .*/\2/p; s/^URIs: *([^ ]*).*/\1/p' /etc/apt/sources.list \
  /etc/apt/sources.list.d/* 2>/dev/null | head -1 || true)  # one of them may be missing
if ! debootstrap --variant=minbase --include=python3-venv "$release" "$scratch/root" ${mirror:+"$mirror"} >"$scratch/debootstrap.log" 2>&1; then
  tail -5 "$scratch/debootstrap.log" >&2
  echo "wheel: built and repaired, but NOT tried in a bare system: debootstrap failed" >&2
  exit 77
fi
mkdir -p "$scratch/root/try"
cp -r "$scratch/house" "$source/tests/python" "$source/tests/e2e" "$source/data" "$source/examples" "$source/docs" \
  "$scratch/root/try/"
mkdir -p "$scratch/root/try/tests" && mv "$scratch/root/try/python" "$scratch/root/try/e2e" "$scratch/root/try/tests/"
# /proc, which the tests of memory read, is mounted in a namespace that ends with the command.
env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root PIRSIM_SOURCE=/try unshare --mount sh -euc \
  'mount -t proc proc "$0/proc"; exec chroot "$0" sh -euc "$1"' "$scratch/root" '
  for name in gcc cc g++ clang cmake; do ! command -v $name || exit 1; done
  ! find / -xdev \( -name "libembree*" -o -name "libtbb*" -o -name "libyaml-cpp*" \) | grep .
  python3 -m venv /venv
  /venv/bin/pip install --quiet --disable-pip-version-check --no-index --find-links /try/house pirsim pytest
  cd /try
  /venv/bin/python -m pytest -q -p no:cacheprovider tests/python'
echo "wheel: tried in a bare $release"
