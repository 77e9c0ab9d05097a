#!/bin/sh
# SPDX-License-Identifier: MIT
# What the compiler takes for the first program and for the umbrella header, as multiples of what it takes for a yardstick
# beside them, since machines and their load differ; and its memory, where a command tells it. Budgets are the last figures
# of g++ 12 on an idle machine and two fifths, since multiples change by a fifth with the load: one that is met by far is to be lowered.
# usage: compile_time.sh PROJECT_FOLDER SCRATCH_FOLDER umbrella|programs COMPILER FLAG...
set -eu
project=$1
scratch=$2
what=$3
shift 3
mkdir -p "$scratch"
printf '#include <fibrant/fibrant.hpp>\nint main() {}\n' > "$scratch/umbrella.cpp"

# Hundredths of a second of processor time that a compilation takes, and MB.
cost() {
  source=$1
  shift
  if [ -x /usr/bin/time ]; then
    /usr/bin/time -f '%U %M' -o "$scratch/cost" "$@" -O2 -I"$project/include" -c "$source" -o "$scratch/compiled.o" || return 1
    awk '{ printf "%d %d\n", 100 * $1, $2 / 1024 }' "$scratch/cost"
  else
    ("$@" -O2 -I"$project/include" -c "$source" -o "$scratch/compiled.o" && times > "$scratch/cost") || return 1
    sed -n 2p "$scratch/cost" | awk '{ split($1, part, /[ms]/); printf "%d 0\n", 100 * (60 * part[1] + part[2]) }'
  fi
}

failed=0
before=$(cost "$project/tests/checks/yardstick.cpp" "$@")
before=${before% *}
# usage: check NAME SOURCE TENTHS_OF_THE_YARDSTICK MB COMPILER FLAG...
check() {
  name=$1
  source=$2
  most=$3
  most_memory=$4
  shift 4
  taken=$(cost "$source" "$@")
  memory=${taken#* }
  taken=${taken% *}
  after=$(cost "$project/tests/checks/yardstick.cpp" "$@")
  after=${after% *}
  tenths=$((20 * taken / (before + after)))
  echo "$name: $((taken / 100)) s, $tenths tenths of the yardstick (at most $most), $memory MB (at most $most_memory)"
  before=$after
  [ "$tenths" -le "$most" ] && [ "$memory" -le "$most_memory" ] || failed=1
}
if [ "$what" = umbrella ]; then
  check umbrella "$scratch/umbrella.cpp" 28 580 "$@"
else
  check crossing "$project/examples/crossing/main.cpp" 165 1350 "$@"
  # The same program, whose model is in the compiled library.
  check compiled "$project/examples/crossing/main.cpp" 36 650 "$@" -DCROSSING_COMPILED
fi
exit $failed
