#!/bin/sh
# SPDX-License-Identifier: MIT
# A small weave on one, two and four ranks of one and two threads: the same results to the last bit, a run that is stopped and
# resumed on another number of ranks among them; and what happens when a rank is killed.
# usage: ranks.sh <mpirun> <weave_mpi> <scene file> <scratch folder> [tows [fibres a tow]]
mpirun=$1
weave=$2
scene=$3
out=$4
tows=${5:-2}
fibres=${6:-3}
rm -rf "$out"
mkdir -p "$out" || exit 1
small="--set fabric.warp_tows=$tows --set fabric.weft_tows=$tows --set fabric.elements=20 --set warp.fibres=$fibres
  --set warp.real_fibres=$((20 * fibres)) --set warp.aspect=1 --set solver.subdomains=8 --set output.paraview=false
  --set output.pictures=false --quiet"
fail() {
  echo "ranks: $*"
  exit 1
}
# MPI does not run as root unless it is told to; it ties threads to one core unless it is told not to.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMP_WAIT_POLICY=passive
on() { # ranks threads program ...
  ranks=$1
  threads=$2
  shift 2
  OMP_NUM_THREADS=$threads "$mpirun" -n "$ranks" "$@"
}
# All columns of a table but the one of seconds, which depends on the clock.
figures() {
  awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k == "seconds") left = k } { $left = ""; print }' "$1/increments.csv"
  cat "$1/fibres.csv" "$1/tows.csv" "$1/sections.csv"
}

on 1 1 "$weave" "$scene" --output "$out/1" $small || fail "the small scene did not settle on one rank"
figures "$out/1" >"$out/expected"
for run in "2 1" "2 2" "4 1"; do
  set -- $run
  on "$1" "$2" "$weave" "$scene" --output "$out/$1x$2" $small || fail "the small scene did not settle on $1 ranks of $2 threads"
  figures "$out/$1x$2" | cmp -s - "$out/expected" || fail "$1 ranks of $2 threads have other bits than one of one"
done
exit 0
