#!/bin/sh
# SPDX-License-Identifier: MIT
# What the compiler takes for README's first program and for the umbrella header, as multiples of what it takes for a yardstick beside them, since
# machines and their load differ. Budgets are the last figures and a fifth: one that is met by far is lowered.
# usage: compile_time.sh PROJECT_FOLDER SCRATCH_FOLDER COMPILER FLAG...
set -eu
project=$1
scratch=$2
shift 2
mkdir -p "$scratch"
printf '#include <fibrant/fibrant.hpp>\nint main() {}\n' > "$scratch/umbrella.cpp"

# Hundredths of a second of processor time that a compilation takes.
cost() {
  source=$1
  shift
  (
    "$@" -O2 -I"$project/include" -c "$source" -o "$scratch/compiled.o" || exit 1
    times
  ) > "$scratch/times" || exit 1
  sed -n 2p "$scratch/times" | awk '{ split($1, part, /[ms]/); printf "%d\n", 100 * (60 * part[1] + part[2]) }'
}
# KB at most, where a command says so; budgets are of g++.
memory() {
  source=$1
  shift
  if [ -x /usr/bin/time ] && "$1" --version | grep -q 'Free Software Foundation'; then
    /usr/bin/time -f %M "$@" -O2 -I"$project/include" -c "$source" -o "$scratch/compiled.o" 2>&1 | tail -n 1
  else
    echo 0
  fi
}

failed=0
before=$(cost "$project/tests/checks/yardstick.cpp" "$@")
# usage: check NAME SOURCE HUNDREDTHS_OF_THE_YARDSTICK
check() {
  name=$1
  source=$2
  most=$3
  shift 3
  taken=$(cost "$source" "$@")
  after=$(cost "$project/tests/checks/yardstick.cpp" "$@")
  times=$((200 * taken / (before + after)))
  echo "$name: $((taken / 100)).$(printf %02d $((taken % 100))) s, $times hundredths of the yardstick ($before and $after), at most $most"
  before=$after
  [ "$times" -le "$most" ] || failed=1
}
check umbrella "$scratch/umbrella.cpp" UMBRELLA_MOST "$@"
check crossing "$project/examples/crossing/main.cpp" CROSSING_MOST "$@"
used=$(memory "$scratch/umbrella.cpp" "$@")
echo "umbrella: $used KB, at most UMBRELLA_KB"
[ "$used" -le UMBRELLA_KB ] || failed=1
exit $failed
