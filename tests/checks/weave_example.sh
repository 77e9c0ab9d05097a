#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs the example `weave` as a user would: a small scene to its end, the same one stopped and resumed to the same bits, and
# scenes that are refused before any work.
# usage: weave_example.sh <the program> <scene file> <scratch folder>
weave=$1
scene=$2
out=$3
rm -rf "$out"
mkdir -p "$out" || exit 1
small="--set fabric.warp_tows=2 --set fabric.weft_tows=2 --set fabric.elements=20 --set warp.fibres=3 --set warp.real_fibres=60
  --set warp.aspect=1 --set output.paraview=false --set output.pictures=false --quiet"
fail() {
  echo "weave_example: $*"
  exit 1
}
. "$(dirname "$0")/results.sh"

"$weave" "$scene" --output "$out/whole" $small || fail "the small scene did not settle"
for key in converged fibres nodes dofs contact_elements increments rejected_increments newton_iterations linear_solves \
  linear_iterations wrong_crossings greatest_penetration_over_radius least_gap_over_radius crimp_warp crimp_weft thickness \
  wall_seconds cpu_seconds peak_memory_bytes seconds_by_stage solver threads version; do
  grep -q "\"$key\"" "$out/whole/summary.json" || fail "summary.json has no $key"
done

# The page of results has all of them, and a run is on one page.
documented() {
  for name in $(sed -n 's/^  "\([a-z_]*\)":.*/\1/p' "$1/summary.json") $(head -1 "$1/increments.csv" | tr ',' ' '); do
    grep -q "\`$name\`" "$(dirname "$0")/../../docs/reference/files.md" || fail "docs/reference/files.md has no $name"
  done
}
documented "$out/whole"
grep -q 'The result is good' "$out/whole/report.html" || fail "report.html does not say that the result is good"
grep -A 2 'where the time went' "$out/whole/report.html" | grep -q '[0-9][.][0-9]\{6\}' && fail "report.html has figures of all digits"
grep -q '<script src\|<link\|url(' "$out/whole/report.html" && fail "report.html needs other files"

"$weave" "$scene" --output "$out/parts" $small --set settle.separation_increments=6
[ $? -eq 1 ] || fail "a run that was stopped early did not say so"
grep -q '"converged": false' "$out/parts/summary.json" || fail "summary.json of a run that was stopped says nothing of it"
says() {
  grep -q "$1" "$out/message" || fail "$2 says: $(cat "$out/message")"
}
"$weave" "$scene" --output "$out/parts" $small --resume 2> "$out/message" && fail "a checkpoint of another scene was resumed"
says "settle.separation_increments (6 there and 250 here)" "a checkpoint of another scene"
"$weave" "$scene" --output "$out/parts" $small --resume --other-scene || fail "the resumed run did not settle"
figures "$out/whole/summary.json" > "$out/whole.txt"
figures "$out/parts/summary.json" > "$out/parts.txt"
cmp "$out/whole.txt" "$out/parts.txt" || fail "the resumed run found another state"

# A folder that holds results, one that another run is in, and a run that is stopped.
"$weave" "$scene" --output "$out/whole" $small 2> "$out/message" && fail "results were written over"
says "holds results of an earlier run" "a folder with results"
"$weave" "$scene" --output "$out/stopped" $small &
run=$!
waited=0
while [ ! -s "$out/stopped/increments.csv" ] && [ $waited -lt 300 ]; do
  sleep 0.1
  waited=$((waited + 1))
done
"$weave" "$scene" --output "$out/stopped" $small --overwrite 2> "$out/message" && fail "two runs were in one folder"
says "another run is in this folder (process $run)" "a folder that is in use"
kill -TERM $run
wait $run
[ $? -eq 143 ] || fail "a run that was told to stop did not say so"
[ -s "$out/stopped/checkpoint.bin" ] || fail "a run that was told to stop left no checkpoint"
"$weave" "$scene" --output "$out/stopped" $small --resume || fail "the run that was told to stop did not settle in the end"
figures "$out/stopped/summary.json" > "$out/stopped.txt"
cmp "$out/whole.txt" "$out/stopped.txt" || fail "the run that was told to stop found another state"
"$weave" "$out/whole/parameters.toml" --output "$out/echoed" --quiet || fail "parameters.toml is no scene that settles"
figures "$out/echoed/summary.json" > "$out/echoed.txt"
cmp "$out/whole.txt" "$out/echoed.txt" || fail "parameters.toml is another scene"

refused() {
  text=$1
  shift
  "$weave" "$scene" --output "$out/refused" --quiet "$@" 2> "$out/message" && fail "accepted: $*"
  grep -q "$text" "$out/message" || fail "$* says: $(cat "$out/message")"
  [ ! -e "$out/refused/summary.json" ] || fail "$* was refused after work had begun"
}
refused "fabric.warp_towz" --set fabric.warp_towz=4
refused "radius" --set warp.radius=-0.02
refused "radius" --set warp.radius=nan
refused "fibres" --set warp.fibres=0
refused "warp_tows" --set fabric.warp_tows=\"four\"
refused "pattern" --set 'fabric.pattern=["101", "010"]'
refused "pattern" --set 'fabric.pattern=["1111", "1111", "1111", "1111"]'
refused "elements" --set fabric.elements=4000
exit 0
