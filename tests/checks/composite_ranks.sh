#!/bin/sh
# SPDX-License-Identifier: MIT
# A small composite is settled, bonded and bent on one, two and four ranks of one and two threads: the same results to the last
# bit.
# usage: composite_ranks.sh <mpirun> <composite_mpi> <scene file> <scratch folder>
mpirun=$1
composite=$2
scene=$3
out=$4
rm -rf "$out"
mkdir -p "$out" || exit 1
small="--set load.increments=4 --set solver.subdomains=8 --set output.paraview=false --set output.pictures=false --quiet"
. "$(dirname "$0")/ranks.sh"

on 1 1 "$composite" "$scene" --output "$out/1" $small || fail "the composite was not bent on one rank"
figures "$out/1" >"$out/expected"
[ -s "$out/expected" ] || fail "there is no table"
for run in "2 1" "2 2" "4 1"; do
  set -- $run
  on "$1" "$2" "$composite" "$scene" --output "$out/$1x$2" $small || fail "the composite was not bent on $1 ranks of $2 threads"
  figures "$out/$1x$2" | cmp -s - "$out/expected" || fail "$1 ranks of $2 threads have other bits than one of one"
done
exit 0
