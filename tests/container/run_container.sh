#!/usr/bin/env bash
# Builds the image of tools/container and runs Study A in it, where there is an engine. Elsewhere it checks the recipes
# and exits with 77, a skip for CTest: what can't be built here is said, not passed.
# Usage: run_container.sh SOURCE_DIR
set -euo pipefail
cd "$1"
recipes=tools/container
say() { echo "container: $*" >&2; }

for engine in docker podman; do
  if command -v "$engine" >/dev/null && "$engine" info >/dev/null 2>&1; then
    "$engine" build -q -f $recipes/Dockerfile -t pirsim-test .
    rows=$("$engine" run --rm -v "$PWD/data:/work/data:ro" pirsim-test --scene data/rooms/meeting_room.gltf \
      --script data/studies/studyA.yaml --replicates 1 | wc -l)
    [ "$rows" -gt 1800 ] || { say "Study A has $rows rows in the image, too few for ten trials of 180 s"; exit 1; }
    exit 0
  fi
done
if command -v apptainer >/dev/null; then
  image=$(mktemp --suffix=.sif)
  trap 'rm -f "$image"' EXIT
  apptainer build --force "$image" $recipes/pirsim.def
  apptainer run "$image" --version
  exit 0
fi

for script in "$recipes"/install_*; do sh -n "$script"; done
# Every instruction is one that the format knows, and what is copied is there.
awk '/^[[:space:]]*(#|$)/ {next} !/^(    |(ARG|FROM|COPY|RUN|ENV|WORKDIR|ENTRYPOINT|CMD) )/ {print "Dockerfile:" NR ": " $0; bad = 1} END {exit bad}' \
  $recipes/Dockerfile $recipes/from_package/Dockerfile
awk '/^%/ && !/^%(files|post|environment|runscript|test)( from [a-z]+)?$/ {print "pirsim.def:" NR ": " $0; bad = 1} END {exit bad}' \
  $recipes/pirsim.def $recipes/from_package/pirsim.def
# One base for all, by its digest.
[ "$(grep -rhoE 'debian@sha256:[0-9a-f]+' $recipes | sort -u | grep -cE '@sha256:[0-9a-f]{64}$')" = 1 ] ||
  { say "the recipes don't share a base image with a digest"; exit 1; }
! grep -rnE '^(FROM|From:) *debian:' $recipes || { say "a base image without its digest"; exit 1; }
for file in tools/container/install_pirsim tools/container/install_runtime tools/install_deps; do
  [ -x "$file" ] || { say "$file is missing or can't be run"; exit 1; }
done
grep -q "$recipes/install_runtime" $recipes/Dockerfile
grep -q "$recipes/install_runtime" $recipes/pirsim.def
# The packages of the image's Debian, if this is one.
if grep -qs 'VERSION_ID="12"' /etc/os-release && command -v apt-cache >/dev/null && [ -n "$(apt-cache policy zlib1g)" ]; then
  for package in $(grep -oE '\bz?lib[a-z0-9.-]+' $recipes/install_runtime | grep '[0-9]' | sort -u); do
    apt-cache show "$package" >/dev/null 2>&1 || { say "Debian 12 has no package $package"; exit 1; }
  done
fi
say "SKIPPED: no docker, podman or apptainer here; the recipes were checked, not built"
exit 77
