#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs small scenes with the programs of two builds, without -march=native, and compares every file but for clock times: for changes that are to
# leave all bits the same. By hand, as it needs two builds; programs that one of them has not are left out.
# usage: same_bits.sh BIN_BEFORE BIN_AFTER EXAMPLES_FOLDER SCRATCH_FOLDER
set -eu
before=$1
after=$2
scenes=$3
scratch=$4

# usage: run BIN OUT NAME SCENE OPTION...
run() {
  bin=$1
  out=$2
  name=$3
  scene=$4
  shift 4
  [ -x "$before/$name" ] && [ -x "$after/$name" ] || return 0
  "$bin/$name" "$scenes/$name/$scene" --output "$out/$name" --quiet "$@" > "$out/$name.log" 2>&1 || echo "$bin/$name: status $?"
}
# Numbers of all files but clocks and what holds them.
sums() {
  (cd "$1" && find . -name '*.vtu' -o -name '*.vtp' -o -name '*.svg' -o -name crossing.txt | sort | xargs md5sum
    find . -name increments.csv | sort | while read -r file; do
      awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k ~ /second/) clock[k] = 1 }
        { line = ""; for (k = 1; k <= NF; ++k) if (!(k in clock)) line = line $k ","; print line }' "$file" | md5sum | sed "s|-|$file|"
    done)
}
for which in before after; do
  bin=$before
  [ $which = before ] || bin=$after
  for threads in 1 2; do
    out=$scratch/$which$threads
    export OMP_NUM_THREADS=$threads
    rm -rf "$out" && mkdir -p "$out"
    [ ! -x "$bin/crossing" ] || "$bin/crossing" > "$out/crossing.txt"
    run "$bin" "$out" weave plain.toml --set fabric.warp_tows=2 --set fabric.weft_tows=2 --set fabric.elements=20 --set warp.fibres=3 \
      --set warp.real_fibres=60 --set warp.aspect=1
    run "$bin" "$out" knot knot.toml --set knot.elements=100 --set loading.increments=6 --set loading.draw=1.0
    run "$bin" "$out" strand strand.toml --set strand.elements=8 --set contact.friction_coefficient=0.1 --set loading.increments=2
    run "$bin" "$out" mat mat.toml --set mat.fibres=20 --set mat.elements=6 --set loading.increments=12
    run "$bin" "$out" composite strip.toml --set fabric.weft_tows=2 --set fabric.elements=8 --set warp.fibres=3 --set matrix.cells_along=6 \
      --set matrix.cells_across=4 --set load.increments=2 --set load.angle_deg=5
    sums "$out" > "$scratch/$which$threads.sums"
  done
done
failed=0
for other in after1 before2 after2; do
  diff "$scratch/before1.sums" "$scratch/$other.sums" || { echo "before, one thread, and $other differ"; failed=1; }
done
echo "$(wc -l < "$scratch/before1.sums") files, sum $(md5sum < "$scratch/before1.sums")"
exit $failed
