#!/bin/sh
# SPDX-License-Identifier: MIT
# A run that is killed, told to stop (SIGTERM) and interrupted (SIGINT) in turns, at times spread over its length, and resumed each
# time ends at the same bits as one that is left alone: every file of results but clocks, memory and the pages made of them. So does
# one that was ended before its first checkpoint, and is resumed.
# usage: kills.sh <the program> <scene file> <scratch folder> <kills> [--set section.key=value]...
program=$1
scene=$2
out=$3
kills=$4
shift 4
name=$(basename "$program")
. "$(dirname "$0")/results.sh"
fail() {
  echo "kills: $name: $*"
  exit 1
}
rm -rf "$out"
mkdir -p "$out" || exit 1
begin=$(date +%s%N)
"$program" "$scene" --output "$out/whole" --quiet "$@" || fail "the run that was left alone ended with status $?"
pause=$(awk -v t=$(($(date +%s%N) - begin)) -v n="$kills" 'BEGIN { printf "%.3f", t / 1e9 / (n + 1) }')
ended=0
done=0
while [ "$done" -lt "$kills" ]; do
  case $((done % 3)) in
    0) signal=KILL ;;
    1) signal=TERM ;;
    *) signal=INT ;;
  esac
  # What a shell runs in the background does not hear SIGINT otherwise.
  env --default-signal=INT "$program" "$scene" --output "$out/parts" --quiet --resume "$@" 2> "$out/message" &
  run=$!
  sleep "$pause"
  kill -$signal $run 2> /dev/null
  wait $run 2> /dev/null
  status=$?
  case $status in
    130 | 137 | 143) ended=$((ended + 1)) ;;
    0) break ;;
    *) fail "after $done kills: status $status: $(cat "$out/message")" ;;
  esac
  done=$((done + 1))
done
"$program" "$scene" --output "$out/parts" --quiet --resume "$@" 2> "$out/message" ||
  fail "the last of its parts: status $?: $(cat "$out/message")"
same_results "$out/whole" "$out/parts" "$out" || fail "after $ended kills: $difference"
# Rows of a table that is not this version's, and no checkpoint: all is written anew.
cp -r "$out/whole" "$out/begun"
find "$out/begun" -name '*.bin' -o -name '*.before' -o -name summary.json | xargs rm -f
sed -i '1s/^/earlier_/' "$out/begun/increments.csv"
"$program" "$scene" --output "$out/begun" --resume "$@" > "$out/message" 2>&1 ||
  fail "ended before its first checkpoint: status $?: $(cat "$out/message")"
[ "$(grep -c 'nothing to resume from, for a run was ended before its first checkpoint (increments.csv.*), so the run begins' "$out/message")" -eq 1 ] ||
  fail "ended before its first checkpoint: says nothing of it: $(head -3 "$out/message")"
same_results "$out/whole" "$out/begun" "$out" || fail "ended before its first checkpoint: $difference"
echo "kills: $name: $ended of $kills ended it, $(wc -l < "$out/a.txt") files of results are the same"
