#!/usr/bin/env bash
# Builds the wheel on an installed pirsim, has auditwheel bundle the shared libraries, and tries it where there is
# neither a compiler nor Embree: in a bare Debian system made by debootstrap. There it passes the package's tests, and
# the main job, a page, a dataset and ten lines of Python are timed. Without root, debootstrap or a Debian mirror the
# last part can't be done: exit code 77.
# Usage: run_wheel.sh SOURCE_DIR BUILD_DIR PYTHON [FOLDER for the wheel]
set -euo pipefail
source=$1 build=$2 python=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
wheels=${4:-$scratch/wheels}
"$source/tools/wheel" "$build" "$python" "$wheels"
wheel=$(ls "$wheels"/pirsim-*.whl)
"$python" -m zipfile -l "$wheel" >"$scratch/content"
for file in pirsim/_core.pyi pirsim/pirsim pirsim/py.typed pirsim/specs.py pirsim/counting/__main__.py \
  pirsim/data/sensors/EKMC1604111.yaml libembree libtbb dist-info/licenses/third_party/licences.toml; do
  grep -q "$file" "$scratch/content" || { echo "wheel: no $file in $wheel" >&2; exit 1; }
done
! grep -qE '\.(a|hpp|cmake)|share/|__pycache__' "$scratch/content" || { echo "wheel: more than a package in $wheel" >&2; exit 1; }
"$python" -m zipfile -e "$wheel" "$scratch/unpacked"
chmod +x "$scratch/unpacked/pirsim/pirsim"
python3 "$source/tests/packaging/check_licences.py" "$source" "$scratch"/unpacked/pirsim/{pirsim,_core*.so}
# Debian 12's libraries need glibc 2.34, and nothing of pirsim's needs a newer one.
if grep -qs 'VERSION_ID="12"' /etc/os-release && [[ "$wheel" != *manylinux_2_34_x86_64* ]]; then
  echo "wheel: it asks for a newer glibc than 2.34: $(basename "$wheel")" >&2
  exit 1
fi
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
cp -r "$scratch/house" "$source/tests/python/first_steps.sh" "$source/data" "$source/examples" "$source/docs" \
  "$scratch/root/try/"
mkdir -p "$scratch/root/try/tests" && cp -r "$source/tests/python" "$source/tests/e2e" "$scratch/root/try/tests/"
# /proc, which the tests of memory read, is mounted in a namespace that ends with the command.
env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root PIRSIM_SOURCE=/try unshare --mount sh -euc \
  'mount -t proc proc "$0/proc"; exec chroot "$0" sh -euc "$1"' "$scratch/root" '
  for name in gcc cc g++ clang cmake; do ! command -v $name || exit 1; done
  ! find / -xdev \( -name "libembree*" -o -name "libtbb*" -o -name "libyaml-cpp*" \) | grep .
  /try/first_steps.sh /try/house
  cd /try
  /venv/bin/pip install --quiet --disable-pip-version-check --no-index --find-links /try/house pytest
  PIRSIM=/venv/bin/pirsim /venv/bin/python -m pytest -q -p no:cacheprovider tests/python'
echo "wheel: tried in a bare $release"
