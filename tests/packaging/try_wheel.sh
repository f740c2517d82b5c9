#!/usr/bin/env bash
# Tries a folder's wheels where there is neither a compiler nor Embree: in a bare system, whose Python takes the one that
# serves it. The first steps are timed there, and the package's tests pass. Without root, debootstrap or a mirror that
# can't be done: exit code 77.
# Usage: try_wheel.sh SOURCE_DIR FOLDER_OF_WHEELS [SUITE [MIRROR]]    (default: this machine's)
#        try_wheel.sh . out/release-0.2.0 jammy http://archive.ubuntu.com/ubuntu
set -euo pipefail
source=$1 wheels=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
. "$source/tests/packaging/bare.sh"
root=$scratch/root
bare_system "$root" "${3:-}" "${4:-}" "python3,python3-venv,tzdata"
# What the wheel and its tests need, fetched here: the bare system needs no network. pip goes by this machine's Python in
# what pytest needs of an older one.
mkdir "$root/try/house" "$root/try/tests"
cp "$wheels"/pirsim-*.whl "$root/try/house"
platforms=()
for glibc in 2_17 2_27 2_28 2_34; do platforms+=(--platform "manylinux_${glibc}_x86_64"); done
python3 -m pip download --quiet --disable-pip-version-check --only-binary :all: "${platforms[@]}" \
  --python-version "$(inside "$root" 'python3 -c "import sys; print(\"%d.%d\" % sys.version_info[:2])"')" \
  -d "$root/try/house" numpy pytest exceptiongroup tomli
cp -r "$source/tests/python/first_steps.sh" "$source/data" "$source/examples" "$source/docs" "$root/try/"
cp -r "$source/tests/python" "$source/tests/e2e" "$root/try/tests/"
inside "$root" '
  . /etc/os-release
  echo "wheel: in a bare $PRETTY_NAME, $(python3 --version), glibc $(ldd --version | sed -n "1s/.* //p")"
  for name in gcc cc g++ clang cmake; do ! command -v $name || exit 1; done
  ! find / -xdev \( -name "libembree*" -o -name "libtbb*" -o -name "libyaml-cpp*" \) | grep .
  /try/first_steps.sh /try/house
  cd /try
  /venv/bin/pip install --quiet --disable-pip-version-check --no-index --find-links /try/house pytest
  PIRSIM_SOURCE=/try PIRSIM=/venv/bin/pirsim /venv/bin/python -m pytest -q -p no:cacheprovider tests/python'
