#!/bin/sh
# SPDX-License-Identifier: MIT
# Faults of one line as a reviewer would plant them, in a header each: the short test that faults.txt names fails by each of them, and
# passes without. A test that no fault makes fail says nothing; a fault that no test sees is a test that is missing.
# usage: faults.sh SOURCE_FOLDER SCRATCH_FOLDER COMPILER FLAG...
set -eu
source=$1
scratch=$2
compiler=$3
shift 3
rm -rf "$scratch"
mkdir -p "$scratch/none"
failed=0
complain() { echo "faults: $*"; failed=1; }
# A header that is found before its own carries the fault.
build() { # <folder of such headers, for the program too> <flag>...
  folder=$1
  shift
  "$compiler" -O1 -DNDEBUG "$@" -I"$folder" -I"$source/include" -I"$source/tests" -I"$source" -o "$folder/program" \
    "$source/tests/${test}_test.cpp" "$scratch/main.o"
}
"$compiler" "$@" -I"$source/include" -I"$source/tests" -c "$source/tests/test_main.cpp" -o "$scratch/main.o"
number=0 seen=
while IFS='	' read -r header test fault text change; do
  case $header in '#'*) continue ;; esac
  number=$((number + 1))
  over=$scratch/$number
  mkdir -p "$over/fibrant/${header%/*}"
  text=$text change=$change awk 'BEGIN { text = ENVIRON["text"]; change = ENVIRON["change"] }
    { k = index($0, text); if (k > 0) { ++lines; $0 = substr($0, 1, k - 1) change substr($0, k + length(text)) } print }
    END { exit lines != 1 }' "$source/include/fibrant/$header" > "$over/fibrant/$header" ||
    { complain "$header has no one line with: $text"; continue; }
  if [ "$test" != "$seen" ]; then
    seen=$test
    build "$scratch/none" "$@" || { complain "$test does not compile"; continue; }
    (cd "$scratch" && none/program > none/said.txt 2>&1) || complain "$test fails without a fault"
  fi
  build "$over" "$@" || { complain "$header: $fault: $test does not compile"; continue; }
  if (cd "$scratch" && "$over/program" > "$over/said.txt" 2>&1); then complain "$header: $fault: $test does not see it"; fi
done < "$source/tests/checks/faults.txt"
[ "$failed" -eq 0 ] && echo "faults: $number of $number found"
exit $failed
