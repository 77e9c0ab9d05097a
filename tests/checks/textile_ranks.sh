#!/bin/sh
# SPDX-License-Identifier: MIT
# A braid on one, two and four ranks of one and two threads: the same results to the last bit. What ranks do not share is refused.
# usage: textile_ranks.sh <mpirun> <textile_mpi> <scene file of a braid> <scratch folder>
mpirun=$1
textile=$2
scene=$3
out=$4
rm -rf "$out"
mkdir -p "$out" || exit 1
small="--set solver.subdomains=8 --set output.paraview=false --set output.pictures=false --quiet"
. "$(dirname "$0")/ranks.sh"
tables="yarns centrelines crossings"

on 1 1 "$textile" "$scene" --output "$out/1" $small || fail "the braid did not settle on one rank"
figures "$out/1" $tables >"$out/expected" || fail "tables are missing"
for run in "2 1" "2 2" "4 1"; do
  set -- $run
  on "$1" "$2" "$textile" "$scene" --output "$out/$1x$2" $small || fail "the braid did not settle on $1 ranks of $2 threads"
  figures "$out/$1x$2" $tables | cmp -s - "$out/expected" || fail "$1 ranks of $2 threads have other bits than one of one"
done

refused() { # key settings ...
  key=$1
  shift
  on 2 1 "$textile" "$scene" --output "$out/refused" $small "$@" 2>"$out/message" && fail "$* was taken"
  [ "$(grep -c "$key" "$out/message")" -eq 1 ] || fail "$* is not refused by $key, once: $(cat "$out/message")"
}
refused solver.linear_solver --set solver.linear_solver=float_block_cholesky
refused loading.case --set loading.case=tension --set loading.grip=0.3 --set loading.amount=0.01
exit 0
