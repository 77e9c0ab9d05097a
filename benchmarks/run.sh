#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs the benchmarks of speed on one pinned core, one after the other, and leaves tables (.csv, .json) and plots (.svg) in a folder.
# usage: benchmarks/run.sh PROGRAMS FOLDER [search] [solver] [scaling] [micro] [SCENE.fpl|SYSTEM]...
#   PROGRAMS  folder of the programs, build/release/bin after `cmake --build --preset release`
#   scenes    end in .fpl or .fpt and are searched; other files are systems that benchmark_record_systems wrote, and are solved
# Without a choice all four run.
set -eu
[ $# -ge 2 ] || { sed -n '3,7s/^# //p' "$0"; exit 2; }
programs=$1
folder=$2
shift 2
mkdir -p "$folder"
chosen=""
scenes=""
systems=""
for argument in "$@"; do
  case $argument in
    search | solver | scaling | micro) chosen="$chosen $argument" ;;
    *.fpl | *.fpt) scenes="$scenes $argument" ;;
    *) systems="$systems $argument" ;;
  esac
done
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
pinned=""
if command -v taskset > /dev/null; then pinned="taskset -c 0"; fi
# shellcheck disable=SC2086
for bench in ${chosen:-search solver scaling micro}; do
  echo "$bench ..."
  case $bench in
    search)
      $pinned "$programs/benchmark_search_bench" --mat 100000 $scenes > "$folder/search.csv"
      $pinned "$programs/benchmark_search_bench" --repeats 3 --growth > "$folder/growth.csv"
      ;;
    solver) $pinned "$programs/benchmark_solver_bench" 76 152 $systems > "$folder/solver.csv" ;;
    scaling) $pinned "$programs/benchmark_scaling_bench" > "$folder/scaling.csv" ;;
    micro)
      if [ ! -x "$programs/benchmark_micro_bench" ]; then
        echo "benchmark_micro_bench is not there: it is built where Google Benchmark is found"
        continue
      fi
      $pinned "$programs/benchmark_micro_bench" --benchmark_out="$folder/micro.json" --benchmark_out_format=json > "$folder/micro.txt" 2> "$folder/micro.log"
      ;;
  esac
done
"$programs/benchmark_plots" "$folder"
