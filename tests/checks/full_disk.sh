#!/bin/sh
# SPDX-License-Identifier: MIT
# A write that fails is told at once, whatever is written: each file in turn is on a disk that is full.
# usage: full_disk.sh <the program> <scene file> <scratch folder> [--set section.key=value]...
program=$1
scene=$2
out=$3
shift 3
[ -e /dev/full ] || { echo "full_disk: left out, for there is no /dev/full"; exit 0; }
rm -rf "$out"
fail() {
  echo "full_disk: $(basename "$program"): $*"
  exit 1
}
for file in parameters.toml.partial increments.csv.partial paraview/fibres_0001.vtp.partial paraview/contacts.pvd.partial checkpoint.bin.part \
  view.svg.partial summary.json.partial; do
  rm -rf "$out"
  mkdir -p "$out/paraview" || exit 1
  ln -s /dev/full "$out/$file"
  message=$("$program" "$scene" --output "$out" --overwrite --quiet "$@" 2>&1)
  [ $? -eq 2 ] || fail "$file: not told by the exit status"
  case $message in
    *"cannot write"*"${file%.part*}: No space left on device"*) ;;
    *) fail "$file: $message" ;;
  esac
done
# Files that may not become longer: rows of a table are told as well.
rm -rf "$out"
message=$(ulimit -f 2 && "$program" "$scene" --output "$out" --quiet "$@" --set output.paraview=false 2>&1)
[ $? -eq 2 ] || fail "a file that may not grow was not told by the exit status"
case $message in
  *"cannot write"*"File too large"*) ;;
  *) fail "a file that may not grow: $message" ;;
esac
exit 0
