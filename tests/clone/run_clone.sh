#!/usr/bin/env bash
# A clone that belongs to somebody else, as on a shared file system or in a container: git alone refuses to look at it,
# a build must still know its revision. Usage: run_clone.sh SOURCE_DIR CXX. Exit code 77 where this can't be tried.
set -euo pipefail
source=$1 cxx=$2
[ "$(id -u)" -eq 0 ] || { echo "only root can give files away" >&2; exit 77; }
git -c safe.directory='*' -C "$source" rev-parse HEAD >/dev/null 2>&1 || { echo "$source is no clone" >&2; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export HOME=$scratch GIT_CONFIG_NOSYSTEM=1
git -c safe.directory='*' clone -q --depth 1 "file://$source" "$scratch/clone"
revision=$(git -C "$scratch/clone" describe --always --abbrev=12)
chown -R nobody "$scratch/clone"
if git -C "$scratch/clone" status >/dev/null 2>&1; then
  echo "git doesn't mind here: nothing would be shown" >&2
  exit 77
fi
cmake -S "$scratch/clone" -B "$scratch/build" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DPIRSIM_BUILD_TESTS=OFF >/dev/null
grep -q "return \"$revision\"" "$scratch/build/src/version.cpp" ||
  { grep git_revision "$scratch/build/src/version.cpp"; echo "expected $revision"; exit 1; }
echo "revision $revision"
