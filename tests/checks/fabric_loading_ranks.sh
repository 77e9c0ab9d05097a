#!/bin/sh
# SPDX-License-Identifier: MIT
# A small fabric, settled by weave_mpi beside the program, is released and sheared on one, two and four ranks of one and two
# threads: its averages are shared, and results are the same to the last bit. So they are without ranks, to the tolerances.
# usage: fabric_loading_ranks.sh <mpirun> <fabric_loading_mpi> <scene file of a release> <scratch folder>
mpirun=$1
loading=$2
release=$3
out=$4
weave=$(dirname "$loading")/weave_mpi
rm -rf "$out"
mkdir -p "$out" || exit 1
. "$(dirname "$0")/ranks.sh"
[ -x "$weave" ] || { echo "fabric_loading_ranks: left out, for there is no weave_mpi beside the program"; exit 0; }
. "$(dirname "$0")/small_fabric.sh"
on 1 1 "$weave" "$(dirname "$release")/../weave/plain.toml" --output "$out/settled" "$@" ||
  fail "the small scene did not settle"
load() { # ranks threads scene name checkpoint ...
  ranks=$1 threads=$2 scene=$3 name=$4 checkpoint=$5
  shift 5
  on "$ranks" "$threads" "$loading" "$scene" --output "$out/$name" --set "settled.set=[$list]" --set solver.subdomains=8 \
    --set settled.checkpoint="$checkpoint" --set output.paraview=false --set output.pictures=false --quiet "$@"
}
for run in "1 1" "2 1" "2 2" "4 1"; do
  set -- $run
  load "$1" "$2" "$release" "released_$1x$2" "$out/settled/checkpoint.bin" || fail "$1 ranks of $2 threads did not release it"
  load "$1" "$2" "$(dirname "$release")/shear.toml" "sheared_$1x$2" "$out/released_$1x$2/checkpoint.bin" \
    --set 'loading.stages=["tighten", "shear"]' --set 'shear.ramps=["shear = 0.02"]' --set shear.increments=2 ||
    fail "$1 ranks of $2 threads did not shear it"
  for part in released sheared; do
    figures "$out/${part}_$1x$2" >"$out/$part.now"
    [ -s "$out/$part.expected" ] || cp "$out/$part.now" "$out/$part.expected"
    cmp -s "$out/$part.now" "$out/$part.expected" || fail "$1 ranks of $2 threads have other bits: $part"
  done
done
exit 0
