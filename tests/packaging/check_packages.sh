#!/usr/bin/env bash
# What Debian packages and the source archive hold. Makes them of a build, unless they are there.
# Usage: check_packages.sh SOURCE_DIR BUILD_DIR [FOLDER of packages]
set -euo pipefail
source=$1 build=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
packages=${3:-$scratch/packages}
if ! command -v dpkg-shlibdeps >/dev/null; then
  echo "packages: NOT made: that needs dpkg-dev" >&2
  exit 77
fi
if [ ! -d "$packages" ]; then
  "$source/tools/package" "$build" "$packages" >"$scratch/log" 2>&1 || { tail -20 "$scratch/log" >&2; exit 1; }
fi
archive=$(ls "$packages"/pirsim-[0-9]*.tar.gz)
command=$(ls "$packages"/pirsim_*.deb) libraries=$(ls "$packages"/libpirsim-dev_*.deb)
if git -C "$source" rev-parse HEAD >/dev/null 2>&1; then
  # What git knows or would take, and the revision: no more and no less.
  diff <(tar -tzf "$archive" | sed 's,^[^/]*/,,' | grep -v '/$' | LC_ALL=C sort) \
    <({ git -C "$source" ls-files -co --exclude-standard | grep -v __pycache__; echo REVISION; } | LC_ALL=C sort) ||
    { echo "packages: the archive isn't what the clone holds" >&2; exit 1; }
fi
! dpkg-deb -c "$command" | grep -E '\.(a|hpp|cmake|pc)$' || { echo "packages: libraries in the command's" >&2; exit 1; }
! dpkg-deb -c "$libraries" | grep -E '/(bin|share)/' || { echo "packages: more than libraries in theirs" >&2; exit 1; }
dpkg-deb -x "$command" "$scratch/root"
for text in copyright third_party/licences.toml third_party/licences/nlopt.txt third_party/three/LICENSE; do
  test -s "$scratch/root/usr/share/doc/pirsim/$text"
done
[ "$("$scratch/root/usr/bin/pirsim" data studyA.yaml)" = "$(realpath "$scratch/root/usr/share/pirsim/studies/studyA.yaml")" ]
echo "packages: $(cd "$packages" && du -k ./*.deb ./*.tar.gz | awk '{printf "%s%s %d KiB", n++ ? ", " : "", substr($2, 3), $1}')"
