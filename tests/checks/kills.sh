#!/bin/sh
# SPDX-License-Identifier: MIT
# A run that is killed and told to stop in turns, at times spread over its length, and resumed each time ends at the same bits
# as one that is left alone: every increment but for its clock, and the picture of the end.
# usage: kills.sh <the program> <scene file> <scratch folder> <kills> [--set section.key=value]...
program=$1
scene=$2
out=$3
kills=$4
shift 4
name=$(basename "$program")
fail() {
  echo "kills: $name: $*"
  exit 1
}
rm -rf "$out"
mkdir -p "$out" || exit 1
# Numbers of all increments but clocks.
increments() {
  find "$1" -name increments.csv | sort | while read -r file; do
    awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k ~ /second/) clock[k] = 1 }
      { line = ""; for (k = 1; k <= NF; ++k) if (!(k in clock)) line = line $k ","; print line }' "$file"
  done
}
begin=$(date +%s%N)
"$program" "$scene" --output "$out/whole" --quiet "$@" || fail "the run that was left alone ended with status $?"
pause=$(awk -v t=$(($(date +%s%N) - begin)) -v n="$kills" 'BEGIN { printf "%.3f", t / 1e9 / (n + 1) }')
ended=0
done=0
while [ "$done" -lt "$kills" ]; do
  signal=KILL
  [ $((done % 2)) -eq 0 ] || signal=TERM
  "$program" "$scene" --output "$out/parts" --quiet --resume "$@" 2> "$out/message" &
  run=$!
  sleep "$pause"
  kill -$signal $run 2> /dev/null
  wait $run 2> /dev/null
  status=$?
  case $status in
    137 | 143) ended=$((ended + 1)) ;;
    0) break ;;
    *) fail "after $done kills: status $status: $(cat "$out/message")" ;;
  esac
  done=$((done + 1))
done
"$program" "$scene" --output "$out/parts" --quiet --resume "$@" 2> "$out/message" ||
  fail "the last of its parts: status $?: $(cat "$out/message")"
increments "$out/whole" > "$out/whole.txt"
increments "$out/parts" > "$out/parts.txt"
cmp "$out/whole.txt" "$out/parts.txt" || fail "other increments after $ended kills"
(cd "$out/whole" && find . -name view.svg -o -name levels.csv) | while read -r file; do
  cmp "$out/whole/$file" "$out/parts/$file" || { echo "kills: $name: another $file"; exit 1; }
done || exit 1
echo "kills: $name: $ended of $kills ended it, $(wc -l < "$out/whole.txt") lines of increments are the same"
