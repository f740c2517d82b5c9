#!/usr/bin/env bash
# Installs a build of pirsim under a scratch prefix and is its user there: the program of docs/howto/cpp.md by
# find_package and by pkg-config, one with a room made in memory, one with a detector of its own, one that surveys a
# room, one that compares a model with measurements, and every public header by itself.
# Usage: [CXXFLAGS=...] run.sh BUILD_DIR SOURCE_DIR CXX
set -euo pipefail
build=$1 source=$2 cxx=$3 flags=${CXXFLAGS:-}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# The how-to shows main.cpp, word for word but for its first line.
diff <(sed -n '/^```cpp$/,/^```$/p' "$source/docs/howto/cpp.md" | sed '1d;$d') <(tail -n +2 "$source/tests/consumer/main.cpp")
cmake --install "$build" --prefix "$scratch/prefix" >/dev/null

cmake -S "$source/tests/consumer" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
  -DPIRSIM_VERSION="$(sed -nE 's/^project\(pirsim VERSION ([0-9.]+).*/\1/p' "$source/CMakeLists.txt")" \
  -DPIRSIM_INCLUDE_DIR="$scratch/prefix/include" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_CXX_FLAGS="$flags" >/dev/null
cmake --build "$scratch/build" --parallel 2 >/dev/null
# The how-to's CMakeLists.txt, as it stands there.
mkdir "$scratch/own" && cp "$source/tests/consumer/main.cpp" "$scratch/own"
sed -n '/^```cmake$/,/^```$/p' "$source/docs/howto/cpp.md" | sed '1d;$d' >"$scratch/own/CMakeLists.txt"
cmake -S "$scratch/own" -B "$scratch/own/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_CXX_FLAGS="$flags" >/dev/null
cmake --build "$scratch/own/build" >/dev/null
PKG_CONFIG_PATH=$(dirname "$(find "$scratch/prefix" -name pirsim.pc)")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046
"$cxx" -std=c++20 $flags "$source/tests/consumer/main.cpp" -o "$scratch/by_pkg_config" \
  $(pkg-config --static --cflags --libs pirsim)
pkg-config --static --libs pirsim-reconcile | grep -q -- '-lpirsim_reconcile.*-lpirsim '

data="$scratch/prefix/share/pirsim"
scene="$data/rooms/meeting_room.gltf" script="$data/studies/studyA.yaml"
"$scratch/own/build/own" "$scene" "$script" >"$scratch/a.csv"
"$scratch/by_pkg_config" "$scene" "$script" >"$scratch/b.csv"
"$scratch/prefix/bin/pirsim" --scene "$scene" --script "$script" --replicates 1 -q |
  awk -F, 'NR == 1 || $2 == "S8"' >"$scratch/c.csv"
cmp "$scratch/a.csv" "$scratch/b.csv"
cmp "$scratch/a.csv" "$scratch/c.csv"
# An installation that is moved, and a room far from any folder of sensors: the library carries the shipped ones.
mkdir "$scratch/alone" "$scratch/moved" && cp "$scene" "$script" "$scratch/alone"
cp "$scratch/prefix/bin/pirsim" "$scratch/moved"
mv "$data" "$scratch/hidden_data"
(cd "$scratch/alone" && "$scratch/own/build/own" meeting_room.gltf studyA.yaml | cmp - "$scratch/a.csv" &&
  "$scratch/moved/pirsim" --scene meeting_room.gltf --script studyA.yaml --replicates 1 -q |
  awk -F, 'NR == 1 || $2 == "S8"' | cmp - "$scratch/c.csv")
mv "$scratch/hidden_data" "$data"
echo "consumer: $(wc -l <"$scratch/a.csv") rows, the same three ways"

# 4 m at 1 m/s past sixteen zones, there and back: some second must see it, and nobody is seen before the first.
"$scratch/build/own_room" >"$scratch/own_room.csv"
awk -F, 'NR > 1 { seen += $6 } END { exit !(NR > 8 && seen > 3 && seen < NR) }' "$scratch/own_room.csv"
# Fewer seconds have more active zones, and some have any.
"$scratch/build/own_detector" "$scene" "$script" >"$scratch/own_detector.txt"
awk 'NR > 1 && $2 > before { bad = 1 } { before = $2 } NR == 1 { first = $2 } END { exit bad || first == 0 || before == first }' \
  "$scratch/own_detector.txt"
# The same counts as the command line's.
"$scratch/build/own_survey" "$scene" "$data/studies/studyB.yaml" >"$scratch/own_survey.txt"
"$scratch/prefix/bin/pirsim" coverage --scene "$scene" --script "$data/studies/studyB.yaml" --set spacing_m=0.5 -q \
  -o "$scratch/coverage" 2>/dev/null
awk -F, 'NR > 1 { for (i = 3; i <= NF; ++i) n += $i } END { print NR - 1, n }' "$scratch/coverage/coverage.csv" |
  cmp - <(head -1 "$scratch/own_survey.txt")
awk 'NR == 2 { exit !($1 > 0 && $2 > 0) }' "$scratch/own_survey.txt"
# What is missing: of the wing for measured data, the simulator's own library holds nothing.
library=$(find "$scratch/prefix" -name libpirsim.a) wing=$(find "$scratch/prefix" -name libpirsim_reconcile.a)
symbols() { nm -C "$1" 2>/dev/null | grep -c ' [TWBDRV] .*pirsim::\(reconcile\|stats\)::' || true; }
[ "$(symbols "$library")" -eq 0 ] && [ "$(symbols "$scratch/own/build/own")" -eq 0 ] && [ "$(symbols "$wing")" -gt 100 ]
short=(--set 'trials.for_each.seat=[S4]' --set people.0.actions.3.work.duration_s=30 --set replicates=1)
"$scratch/prefix/bin/pirsim" --scene "$scene" --script "$script" "${short[@]}" --print-config >"$data/studies/short.yaml"
"$scratch/prefix/bin/pirsim" --scene "$scene" --script "$data/studies/short.yaml" -q --seed 5 \
  --set 'effects=[{false_triggers: {rate_per_s: 0.2}}]' >"$scratch/measured.csv"
"$scratch/build/own_analysis" "$scene" "$data/studies/short.yaml" "$scratch/measured.csv" "$scratch/found" \
  >"$scratch/sentence.txt"
grep -qF "\"sentence\": \"$(cat "$scratch/sentence.txt")\"" "$scratch/found/report.json"
[ -s "$scratch/found/report.html" ]
n_headers=$(find "$scratch/prefix/include/pirsim" -name '*.hpp' | wc -l)
[ "$n_headers" -le 38 ] || { echo "consumer: $n_headers public headers" >&2; exit 1; }
[ "$(find "$scratch/prefix/include/pirsim" -mindepth 1 -type d | wc -l)" -eq 0 ]
echo "consumer: own room, own detector, own survey, own analysis, $n_headers headers each alone"
