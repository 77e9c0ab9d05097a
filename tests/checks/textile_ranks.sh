#!/bin/sh
# SPDX-License-Identifier: MIT
# A braid on one, two and four ranks of one and two threads: the same results to the last bit. A plain knit, whose contact places
# slide, settles, and the braid is pulled by bodies at its ends. What ranks do not share is refused.
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

alike "a braid" "$tables" "$textile" "$scene" $small

knit=$(dirname "$scene")/knit_plain.toml
for run in "1 1" "3 2"; do
  set -- $run
  on "$1" "$2" "$textile" "$knit" --output "$out/knit_$1" $small || fail "the knit did not settle on $1 ranks"
  on "$1" "$2" "$textile" "$scene" --output "$out/pulled_$1" $small --set loading.case=tension --set loading.grip=0.1 \
    --set loading.amount=0.005 || fail "the braid was not pulled on $1 ranks"
  figures "$out/knit_$1" $tables >"$out/knit_$1.figures" || fail "tables of the knit are missing"
  figures "$out/pulled_$1/loading" >"$out/pulled_$1.figures" || fail "tables of the load are missing"
done
for part in knit pulled; do
  cmp -s "$out/${part}_1.figures" "$out/${part}_3.figures" || fail "three ranks have other bits than one: $part"
done

refused() { # key settings ...
  key=$1
  shift
  on 2 1 "$textile" "$scene" --output "$out/refused" $small "$@" 2>"$out/message" && fail "$* was taken"
  [ "$(grep -c "$key" "$out/message")" -eq 1 ] || fail "$* is not refused by $key, once: $(cat "$out/message")"
}
refused solver.linear_solver --set solver.linear_solver=float_block_cholesky
refused textile.generator --set ends.kind=periodic --set flat_braid.periods=1
exit 0
