#!/bin/sh
# SPDX-License-Identifier: MIT
# A checkpoint of another scene is refused in one line that names the key and both values, and taken where one says so.
# usage: other_scene.sh <the program> <scene file> <scratch folder> <changes, as section.key=value ...> [--set section.key=value]...
program=$1
scene=$2
out=$3
changes=$4
shift 4
fail() {
  echo "other_scene: $(basename "$program"): $*"
  exit 1
}
rm -rf "$out"
"$program" "$scene" --output "$out" --quiet "$@" --set output.paraview=false || fail "the scene itself: status $?"
before=$(cksum < "$out/checkpoint.bin")
for change in $changes; do
  message=$("$program" "$scene" --output "$out" --quiet --resume "$@" --set output.paraview=false --set "$change" 2>&1)
  status=$?
  [ $status -eq 2 ] || fail "$change: status $status: $message"
  case $message in
    *"is of another scene: ${change%%=*} ("*" there and "*" here)"*--other-scene*) ;;
    *) fail "$change: $message" ;;
  esac
  [ "$before" = "$(cksum < "$out/checkpoint.bin")" ] || fail "$change: the checkpoint is another one"
done
# Of the last change, told to take it.
message=$("$program" "$scene" --output "$out" --quiet --resume --other-scene "$@" --set output.paraview=false --set "$change" 2>&1)
status=$?
case $status:$message in
  0:* | 1:* | 2:*checkpoint*differs) ;;
  *) fail "--other-scene with $change: status $status: $message" ;;
esac
