#!/bin/sh
# SPDX-License-Identifier: MIT
# A run that is killed, told to stop (SIGTERM) and interrupted (SIGINT) in turns, at times spread over its length, and resumed each
# time ends at the same bits as one that is left alone: every file of results but clocks, memory and the pages made of them.
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
# A file of results without clocks and memory.
figures() {
  case $1 in
    *.csv) awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k ~ /second/ && $k !~ /moment/) clock[k] = 1 }
      { line = ""; for (k = 1; k <= NF; ++k) if (!(k in clock)) line = line $k ","; print line }' "$1" ;;
    *.json) awk '/"[a-z_]*seconds_by[a-z_]*": {/ { inside = 1 } !inside && !/seconds"|memory/ { print } /}/ { inside = 0 }' "$1" ;;
    *) cat "$1" ;;
  esac
}
# What of a folder has to be the same: a checkpoint has clocks in it, a report shows them.
results() {
  (cd "$1" && find . -type f ! -name '*.bin' ! -name report.html | sort)
}
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
results "$out/whole" > "$out/whole.txt"
results "$out/parts" > "$out/parts.txt"
cmp "$out/whole.txt" "$out/parts.txt" || fail "other files after $ended kills: $(diff "$out/whole.txt" "$out/parts.txt" | head -3)"
while read -r file; do
  figures "$out/whole/$file" > "$out/whole.figures"
  figures "$out/parts/$file" > "$out/parts.figures"
  cmp -s "$out/whole.figures" "$out/parts.figures" ||
    fail "another $file after $ended kills: $(diff "$out/whole.figures" "$out/parts.figures" | head -4 | cut -c 1-200)"
done < "$out/whole.txt"
echo "kills: $name: $ended of $kills ended it, $(wc -l < "$out/whole.txt") files of results are the same"
