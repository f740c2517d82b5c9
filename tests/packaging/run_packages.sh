#!/usr/bin/env bash
# Makes the Debian packages and the source archive of a build, installs the command's package in a bare Debian system
# made by debootstrap, runs the main job there, and takes it out without a trace. With `everything` the library's
# package is installed there too, a program is built on it, and the source archive is unpacked, built and run.
# Without root, debootstrap or a Debian mirror that can't be done: exit code 77.
# Usage: run_packages.sh SOURCE_DIR BUILD_DIR [everything]
set -euo pipefail
source=$1 build=$2 extent=${3:-command}
if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap dpkg-shlibdeps >/dev/null; then
  echo "packages: NOT tried: that needs root, debootstrap and dpkg-dev" >&2
  exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$source/tools/package" "$build" "$scratch/packages" >"$scratch/package.log" 2>&1 || { cat "$scratch/package.log" >&2; exit 1; }
command_deb=$(ls "$scratch"/packages/pirsim_*.deb) library_deb=$(ls "$scratch"/packages/libpirsim-dev_*.deb)
archive=$(ls "$scratch"/packages/pirsim-*.tar.gz)

# Names of the packages that another one needs, or that tools/install_deps installs, with commas between.
needs() { dpkg-deb -f "$1" Depends | tr ',' '\n' | sed -E 's/ *([^ ]+).*/\1/' | paste -sd,; }
packages=$(needs "$command_deb")
release=$(. /etc/os-release && echo "$VERSION_CODENAME")
mirror=$(sed -nE 's/^deb (\[[^]]*\] )?(http[^ ]*) .*/\2/p; s/^URIs: *([^ ]*).*/\1/p' /etc/apt/sources.list \
  /etc/apt/sources.list.d/* 2>/dev/null | head -1 || true)  # one of them may be missing
if ! debootstrap --variant=minbase --include="$packages" "$release" "$scratch/root" ${mirror:+"$mirror"} >"$scratch/debootstrap.log" 2>&1; then
  tail -5 "$scratch/debootstrap.log" >&2
  echo "packages: made, but NOT tried: debootstrap failed" >&2
  exit 77
fi
mkdir "$scratch/root/try"
cp "$command_deb" "$library_deb" "$archive" "$scratch/root/try/"
cp "$source/README.md" "$scratch/root/try/"
in_root() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root chroot "$scratch/root" sh -euc "$1"; }

in_root '
  find /usr /etc /opt -xdev | sort >/try/before
  dpkg -i /try/pirsim_*.deb >/try/dpkg.log
  cd /try
  data=/usr/share/pirsim
  pirsim --scene $data/rooms/meeting_room.gltf --script $data/studies/studyA.yaml --replicates 1 -q -o rows.csv
  pirsim preview --scene $data/rooms/open_office.gltf --script $data/studies/office.yaml -q -o office.png
  test "$(wc -l <rows.csv)" -gt 2000 && test -s office.png'
"$build/pirsim" --scene "$source/data/rooms/meeting_room.gltf" --script "$source/data/studies/studyA.yaml" --replicates 1 \
  -q -o "$scratch/rows.csv"
cmp "$scratch/rows.csv" "$scratch/root/try/rows.csv"
echo "packages: the command makes the same rows in a bare $release"

in_root '
  dpkg -P pirsim >>/try/dpkg.log
  find /usr /etc /opt -xdev | sort >/try/after
  cmp /try/before /try/after'
echo "packages: taken out without a trace"

if [ "$extent" = everything ]; then
  cp -rL /etc/apt /etc/resolv.conf "$scratch/root/etc/"
  cp -r --parents /usr/share/keyrings "$scratch/root/"
  build_needs=$(needs "$library_deb" | tr , ' ')
  build_needs+=\ $(sed -n '/^packages=(/,/^)/p' "$source/tools/install_deps" | grep -v '[()]' | xargs)
  in_root "export DEBIAN_FRONTEND=noninteractive; apt-get update -qq && apt-get install -y -qq --no-install-recommends $build_needs" \
    >"$scratch/apt.log" 2>&1 || { tail -5 "$scratch/apt.log" >&2; exit 77; }
  # The README's program, from its own text.
  in_root '
    dpkg -i /try/pirsim_*.deb /try/libpirsim-dev_*.deb >>/try/dpkg.log
    mkdir /try/program && cd /try/program
    sed -n "/^#include <pirsim\/pirsim.hpp>/,/^\`\`\`/p" ../README.md | grep -v "^\`\`\`" >main.cpp
    printf "%s\n" "cmake_minimum_required(VERSION 3.25)" "project(program CXX)" "find_package(pirsim REQUIRED)" \
      "add_executable(program main.cpp)" "target_link_libraries(program pirsim::pirsim)" >CMakeLists.txt
    cmake -B build -G Ninja >log && cmake --build build >>log
    data=/usr/share/pirsim
    ./build/program $data/rooms/meeting_room.gltf $data/studies/studyA.yaml | head -3
    dpkg -P pirsim libpirsim-dev >>/try/dpkg.log'
  echo "packages: the README's program is built on the library's package"
  in_root '
    mkdir /try/source && tar -xzf /try/pirsim-*.tar.gz -C /try/source --strip-components 1 && cd /try/source
    cmake --preset release >log && cmake --build --preset release >>log
    build/release/pirsim --scene data/rooms/meeting_room.gltf --script data/studies/studyA.yaml --replicates 1 -q -o /try/source.csv
    cmp /try/rows.csv /try/source.csv'
  echo "packages: the source archive builds, and makes the same rows"
fi

