#!/bin/sh
# SPDX-License-Identifier: MIT
# A small weave on one, two and four ranks of one and two threads: the same results to the last bit, a run that is stopped and
# resumed on another number of ranks among them; and what happens when a rank is killed.
# usage: weave_ranks.sh <mpirun> <weave_mpi> <scene file> <scratch folder> [tows [fibres a tow]]
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
. "$(dirname "$0")/ranks.sh"
tables="fibres tows sections"

alike "a small weave" "$tables" "$weave" "$scene" $small

# Stopped on two ranks, gone on with on one: the checkpoint has all that a state is.
on 2 1 "$weave" "$scene" --output "$out/parts" $small --set settle.separation_increments=6
[ $? -eq 1 ] || fail "a run that was stopped early did not say so"
on 1 1 "$weave" "$scene" --output "$out/parts" $small --resume --other-scene || fail "the resumed run did not settle"
figures "$out/parts" $tables | cmp -s - "$out/expected" || fail "a run resumed on another number of ranks has other bits"

# Input that all ranks refuse, said once; what ranks cannot share; nothing is left of the folders of other ranks.
on 2 1 "$weave" "$scene" --output "$out/refused" $small --set solver.linear_solver=sparse_cholesky 2>"$out/message" &&
  fail "a solver that ranks cannot share was taken"
[ "$(grep -c 'solver.linear_solver' "$out/message")" -eq 1 ] || fail "a refusal is not said once: $(cat "$out/message")"

# Sends the first rank of a run a signal once it has an increment. FOLDER SIGNAL
signal_first_rank() {
  waited=0
  while [ ! -s "$out/$1/increments.csv" ] && [ $waited -lt 600 ]; do
    sleep 0.1
    waited=$((waited + 1))
  done
  kill "-$2" "$(cat "$out/$1/.lock")"
}

# One rank is told to stop: all do, after the same increment.
on 2 1 "$weave" "$scene" --output "$out/stopped" $small 2>"$out/message" &
run=$!
signal_first_rank stopped TERM
wait $run
[ -s "$out/stopped/checkpoint.bin" ] || fail "a rank that was told to stop left no checkpoint"
on 4 1 "$weave" "$scene" --output "$out/stopped" $small --resume || fail "the run that was told to stop did not settle in the end"
figures "$out/stopped" $tables | cmp -s - "$out/expected" || fail "the run that was told to stop has other bits"

# One rank is killed: the run ends, and goes on from its checkpoint.
on 2 1 "$weave" "$scene" --output "$out/killed" $small 2>"$out/message" &
run=$!
signal_first_rank killed KILL
wait $run && fail "a run whose rank was killed ended well"
on 2 1 "$weave" "$scene" --output "$out/killed" $small --resume || fail "the run whose rank was killed did not settle in the end"
figures "$out/killed" $tables | cmp -s - "$out/expected" || fail "the run whose rank was killed has other bits"
exit 0
