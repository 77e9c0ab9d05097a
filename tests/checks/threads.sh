#!/bin/sh
# SPDX-License-Identifier: MIT
# Settles a weave of seven fibres a tow on two threads under ThreadSanitizer. By clang: its OpenMP library has a tool, Archer, that tells the
# sanitizer what barriers and regions order (Debian's libomp-14-dev has both). g++'s has none, and would be full of races that are not there.
# A program with a race has to be found out first, or the sanitizer sees nothing.
# usage: threads.sh SOURCE_FOLDER SCRATCH_FOLDER CLANG FLAG...
set -eu
source=$1
scratch=$2
compiler=$3
shift 3
archer=$("$compiler" -print-resource-dir)/../../libarcher.so
[ -e "$archer" ] || { echo "$compiler has no libarcher.so: libomp-14-dev is missing"; exit 1; }
mkdir -p "$scratch"
export OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive OMP_TOOL_LIBRARIES="$archer"
export TSAN_OPTIONS="ignore_noninstrumented_modules=1 exitcode=66 halt_on_error=0"

cat > "$scratch/race.cpp" <<'END'
#include <cstdio>
int main() {
    double sum = 0.0, others[64] = {};
#pragma omp parallel for
    for (int k = 0; k < 64; ++k) others[k] = k;
#pragma omp parallel for
    for (int k = 0; k < 64; ++k)
#ifdef RACE
        sum += others[63 - k];
#else
        others[k] *= others[k];
#endif
    std::printf("%g %g\n", sum, others[3]);
}
END
for race in "" -DRACE; do
  # shellcheck disable=SC2086
  "$compiler" -O1 -g1 -fopenmp -fsanitize=thread $race "$scratch/race.cpp" -o "$scratch/race"
  status=0
  "$scratch/race" > "$scratch/race.log" 2>&1 || status=$?
  if [ -z "$race" ] && [ $status -ne 0 ]; then cat "$scratch/race.log"; echo "a program without a race is told to have one"; exit 1; fi
  if [ -n "$race" ] && [ $status -ne 66 ]; then cat "$scratch/race.log"; echo "a race is not seen"; exit 1; fi
done

"$compiler" "$@" -O1 -g1 -DNDEBUG -fopenmp -fsanitize=thread -I"$source/include" -I"$source/examples" \
  -DFIBRANT_PROGRAM=weave_program "$source/examples/weave/weave.cpp" "$source"/examples/support/*.cpp -o "$scratch/weave"
rm -rf "$scratch/out"
status=0
"$scratch/weave" "$source/examples/weave/plain.toml" --output "$scratch/out" --quiet --set warp.fibres=7 --set warp.real_fibres=140 \
  --set fabric.warp_tows=2 --set fabric.weft_tows=2 --set fabric.elements=12 > "$scratch/weave.log" 2>&1 || status=$?
grep -c 'WARNING: ThreadSanitizer' "$scratch/weave.log" && { head -n 60 "$scratch/weave.log"; exit 1; }
[ $status -eq 0 ] || { tail -n 20 "$scratch/weave.log"; echo "status $status"; exit 1; }
echo "no race in $(tail -n 1 "$scratch/out/increments.csv" | cut -d, -f1) increments"
