#!/usr/bin/env bash
# Packs a build and is the packages' user in a bare Debian system made by debootstrap: installs the command, runs the
# main job, removes it without a trace; installs the library and builds the README's program. With `everything` the
# source archive is built there too, which takes some minutes.
# Without root, debootstrap or a Debian mirror that can't be done: exit code 77.
# Usage: run_packages.sh SOURCE_DIR BUILD_DIR [everything]
set -euo pipefail
source=$1 build=$2 extent=${3:-usual}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
if ! command -v dpkg-shlibdeps >/dev/null; then
  echo "packages: NOT made: that needs dpkg-dev" >&2
  exit 77
fi
packages=$scratch/packages
"$source/tools/package" "$build" "$packages" >"$scratch/log" 2>&1 || { tail -20 "$scratch/log" >&2; exit 1; }
version=$(sed -nE 's/^project\(pirsim VERSION ([0-9.]+).*/\1/p' "$source/CMakeLists.txt")
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
echo "packages: $(cd "$packages" && du -k ./*.deb ./*.tar.gz | awk '{printf "%s%s %d KiB", n++ ? ", " : "", substr($2, 3), $1}')"

if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
  echo "packages: made, but NOT tried in a bare system: that needs root and debootstrap" >&2
  exit 77
fi
release=$(. /etc/os-release && echo "$VERSION_CODENAME")
mirror=$(sed -nE 's/^deb (\[[^]]*\] )?(http[^ ]*) .*/\2/p; s/^URIs: *([^ ]*).*/\1/p' /etc/apt/sources.list \
  /etc/apt/sources.list.d/* 2>/dev/null | head -1 || true)  # one of them may be missing
if ! debootstrap --variant=minbase "$release" "$scratch/root" ${mirror:+"$mirror"} >"$scratch/log" 2>&1; then
  tail -5 "$scratch/log" >&2
  echo "packages: made, but NOT tried in a bare system: debootstrap failed" >&2
  exit 77
fi
cp /etc/resolv.conf "$scratch/root/etc/" 2>/dev/null || true
cp /etc/apt/apt.conf.d/*prox* "$scratch/root/etc/apt/apt.conf.d/" 2>/dev/null || true
mkdir "$scratch/root/try"
cp "$command" "$scratch/root/try/pirsim.deb"
cp "$libraries" "$scratch/root/try/libpirsim-dev.deb"
cp "$archive" "$scratch/root/try/pirsim.tar.gz"
cp "$source/tests/consumer/main.cpp" "$scratch/root/try/"

# /proc and /dev are mounted in a namespace that ends with the command.
inside() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    ${http_proxy:+http_proxy="$http_proxy"} unshare --mount sh -euc \
    'mount -t proc proc "$0/proc"; mount --rbind /dev "$0/dev"; cd /; exec chroot "$0" sh -euc "$1"' "$scratch/root" "
    add() { apt-get install -y -qq --no-install-recommends \"\$@\" >/try/log 2>&1 || { tail -20 /try/log >&2; exit 1; }; }
    $1"
}
# Everything but what apt and dpkg write down for themselves, and what this script put there.
content() {
  (cd "$scratch/root" && find . -xdev \( -path ./try -o -path ./proc -o -path ./dev -o -path ./var/lib/dpkg -o \
    -path ./var/lib/apt -o -path ./var/cache -o -path ./var/log -o -path ./tmp \) -prune -o -print | LC_ALL=C sort)
}

inside 'apt-get update -qq; for name in pirsim cc cmake; do ! command -v $name || exit 1; done'
content >"$scratch/before"
inside '
  add /try/pirsim.deb
  pirsim --version
  test "$(pirsim data studyA.yaml)" = /usr/share/pirsim/studies/studyA.yaml
  for text in copyright third_party/licences.toml third_party/licences/nlopt.txt third_party/three/LICENSE; do
    test -s /usr/share/doc/pirsim/$text
  done
  cd /try
  pirsim check -q --scene meeting_room.gltf --script studyA.yaml
  pirsim -q --scene meeting_room.gltf --script studyA.yaml -o rows.csv'
data="$source/data"
"$build/pirsim" -q --scene "$data/rooms/meeting_room.gltf" --script "$data/studies/studyA.yaml" |
  cmp - "$scratch/root/try/rows.csv"
echo "packages: installed in a bare $release, $(($(wc -l <"$scratch/root/try/rows.csv") - 1)) rows as of the build itself"
inside 'apt-get purge -y -qq pirsim >/try/log 2>&1; apt-get autoremove --purge -y -qq >>/try/log 2>&1; ldconfig'
content >"$scratch/after"
diff "$scratch/before" "$scratch/after" || { echo "packages: the command left traces" >&2; exit 1; }
echo "packages: removed without a trace"

inside '
  add /try/pirsim.deb /try/libpirsim-dev.deb g++ cmake make
  cd /try
  g++ -std=c++20 main.cpp -o by_pkg_config $(pkg-config --static --cflags --libs pirsim)
  printf "%s\n" "cmake_minimum_required(VERSION 3.25)" "project(user CXX)" "find_package(pirsim '"$version"' REQUIRED)" \
    "add_executable(by_cmake main.cpp)" "target_link_libraries(by_cmake PRIVATE pirsim::reconcile)" >CMakeLists.txt
  cmake -B user >/dev/null && cmake --build user >/dev/null
  data=/usr/share/pirsim
  for program in ./by_pkg_config user/by_cmake; do
    $program $data/rooms/meeting_room.gltf $data/studies/studyA.yaml >run.csv
    head -1 rows.csv >expected.csv && awk -F, "\$1 == 1 && \$2 == \"S8\"" rows.csv >>expected.csv
    cmp run.csv expected.csv
  done'
echo "packages: the README's program, built by CMake and by pkg-config, gives the command's rows"

[ "$extent" = everything ] || exit 0
# shellcheck disable=SC2016
inside '
  apt-get purge -y -qq pirsim libpirsim-dev >/try/log 2>&1
  cd /try && tar -xzf pirsim.tar.gz && cd pirsim-*/
  tools/install_deps 2>/try/log
  cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DPIRSIM_BUILD_TESTS=OFF >/try/log
  cmake --build build --target install >/try/log
  /usr/local/bin/pirsim --version | grep -F "$(cat REVISION)"
  /usr/local/bin/pirsim -q --scene data/rooms/meeting_room.gltf --script data/studies/studyA.yaml -o /try/again.csv
  cmp /try/rows.csv /try/again.csv
  xargs rm <build/install_manifest.txt'
echo "packages: built from the archive in a bare $release, the same rows"
