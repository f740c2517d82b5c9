#!/usr/bin/env bash
# Installs a build of pirsim under a scratch prefix, builds main.cpp against it by find_package and by pkg-config, and
# compares the rows of both with those of the installed command.
# Usage: run.sh BUILD_DIR SOURCE_DIR CXX "CXXFLAGS"
set -euo pipefail
build=$1 source=$2 cxx=$3 flags=$4
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cmake --install "$build" --prefix "$scratch/prefix" >/dev/null

cmake -S "$source/tests/consumer" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_CXX_FLAGS="$flags" >/dev/null
cmake --build "$scratch/build" >/dev/null
export PKG_CONFIG_PATH=$(dirname "$(find "$scratch/prefix" -name pirsim.pc)")
# shellcheck disable=SC2046
"$cxx" -std=c++20 $flags "$source/tests/consumer/main.cpp" -o "$scratch/by_pkg_config" \
  $(pkg-config --static --cflags --libs pirsim)

data="$scratch/prefix/share/pirsim"
scene="$data/rooms/meeting_room.gltf" script="$data/studies/studyA.yaml"
"$scratch/build/consumer" "$scene" "$script" >"$scratch/a.csv"
"$scratch/by_pkg_config" "$scene" "$script" >"$scratch/b.csv"
"$scratch/prefix/bin/pirsim" --scene "$scene" --script "$script" --replicates 1 -q |
  awk -F, 'NR == 1 || $2 == "S8"' >"$scratch/c.csv"
cmp "$scratch/a.csv" "$scratch/b.csv"
cmp "$scratch/a.csv" "$scratch/c.csv"
echo "consumer: $(wc -l <"$scratch/a.csv") rows, the same three ways"
