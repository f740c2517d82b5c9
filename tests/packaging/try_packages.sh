#!/usr/bin/env bash
# Is the packages' user in a bare Debian system: installs the command, runs the main job, removes it without a trace;
# installs the library and builds the how-to's program; builds the source archive. Takes some minutes. Without root,
# debootstrap or a Debian mirror it can't be done: exit code 77.
# Usage: try_packages.sh SOURCE_DIR BUILD_DIR FOLDER_OF_PACKAGES
set -euo pipefail
source=$1 build=$2 packages=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
. "$source/tests/packaging/bare.sh"
version=$(sed -nE 's/^project\(pirsim VERSION ([0-9.]+).*/\1/p' "$source/CMakeLists.txt")
root=$scratch/root
bare_system "$root"
cp "$packages"/pirsim_*.deb "$root/try/pirsim.deb"
cp "$packages"/libpirsim-dev_*.deb "$root/try/libpirsim-dev.deb"
cp "$packages"/pirsim-[0-9]*.tar.gz "$root/try/pirsim.tar.gz"
cp "$source/tests/consumer/main.cpp" "$root/try/"
adding='add() { apt-get install -y -qq --no-install-recommends "$@" >/try/log 2>&1 || { tail -20 /try/log >&2; exit 1; }; }'
# Everything but what apt and dpkg write down for themselves, and what this script put there.
content() {
  (cd "$root" && find . -xdev \( -path ./try -o -path ./proc -o -path ./dev -o -path ./var/lib/dpkg -o \
    -path ./var/lib/apt -o -path ./var/cache -o -path ./var/log -o -path ./tmp \) -prune -o -print | LC_ALL=C sort)
}

inside "$root" 'apt-get update -qq; for name in pirsim cc cmake; do ! command -v $name || exit 1; done'
content >"$scratch/before"
inside "$root" "$adding"'
  add /try/pirsim.deb
  pirsim --version
  cd /try
  pirsim check -q --scene meeting_room.gltf --script studyA.yaml
  pirsim -q --scene meeting_room.gltf --script studyA.yaml -o rows.csv'
data="$source/data"
"$build/pirsim" -q --scene "$data/rooms/meeting_room.gltf" --script "$data/studies/studyA.yaml" |
  cmp - "$root/try/rows.csv"
echo "packages: installed in a bare Debian, $(($(wc -l <"$root/try/rows.csv") - 1)) rows as of the build itself"
inside "$root" 'apt-get purge -y -qq pirsim >/try/log 2>&1; apt-get autoremove --purge -y -qq >>/try/log 2>&1; ldconfig'
content >"$scratch/after"
diff "$scratch/before" "$scratch/after" || { echo "packages: the command left traces" >&2; exit 1; }
echo "packages: removed without a trace"

inside "$root" "$adding"'
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
echo "packages: the how-to's program, built by CMake and by pkg-config, gives the command's rows"

# shellcheck disable=SC2016
inside "$root" '
  apt-get purge -y -qq pirsim libpirsim-dev >/try/log 2>&1
  cd /try && tar -xzf pirsim.tar.gz && cd pirsim-*/
  tools/install_deps 2>/try/log
  cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DPIRSIM_BUILD_TESTS=OFF >/try/log
  cmake --build build --target install >/try/log
  /usr/local/bin/pirsim --version | grep -F "$(cat REVISION)"
  /usr/local/bin/pirsim -q --scene data/rooms/meeting_room.gltf --script data/studies/studyA.yaml -o /try/again.csv
  cmp /try/rows.csv /try/again.csv
  xargs rm <build/install_manifest.txt'
echo "packages: built from the archive in a bare Debian, the same rows"
