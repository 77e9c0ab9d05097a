#!/bin/sh
# SPDX-License-Identifier: MIT
# How much longer does a scene of fibres alone run because models may have solids? Builds examples/weave with the headers as they are
# and with a copy from which all that deals with solids has been cut out, and runs both in turn, on one thread.
# usage: without_solid_time.sh SOURCE_FOLDER [REPEATS] [COMPILER]; prints CSV: processor seconds of each run, then both medians
set -eu
source=$(cd "$1" && pwd)
repeats=${2:-11}
compiler=${3:-c++}
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -r "$source/include" "$folder/without_include"
sh "$here/cut_solid.sh" "$folder/without_include"
ln -s "$source/include" "$folder/with_include"
for kind in with without; do
  "$compiler" -std=c++20 -O3 -march=native -DNDEBUG -fopenmp -w -I"$folder/${kind}_include" -isystem /usr/include/eigen3 -DFIBRANT_WITH_METIS \
    -DFIBRANT_PROGRAM=weave_program "$source/examples/weave/weave.cpp" "$source"/examples/support/*.cpp -o "$folder/$kind" -ltomlplusplus -lmetis
done
seconds() { sed -n 's/.*"cpu_seconds": \([0-9.]*\).*/\1/p' "$folder/out/summary.json"; }
echo "headers,processor seconds"
for repeat in $(seq "$repeats"); do
  for kind in with without; do
    "$folder/$kind" "$source/examples/weave/plain.toml" --set warp.fibres=7 --set fabric.elements=16 --set output.paraview=false \
      --set output.pictures=false --output "$folder/out" --overwrite --threads 1 --quiet
    echo "$kind,$(seconds)" | tee -a "$folder/runs.csv"
  done
done
for kind in with without; do
  grep "^$kind," "$folder/runs.csv" | cut -d , -f 2 | sort -g | awk -v kind=$kind '{ value[NR] = $1 } END { printf "median %s,%.3f\n", kind, NR % 2 ? value[(NR + 1) / 2] : (value[NR / 2] + value[NR / 2 + 1]) / 2 }'
done
