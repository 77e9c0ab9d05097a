#!/bin/sh
# SPDX-License-Identifier: MIT
# A write that fails is told at once, whatever is written: each kind of file that a program leaves is in turn on a disk that is
# full. Once there is room, --resume ends at the same results as an undisturbed run.
# usage: full_disk.sh <the program> <scene file> <scratch folder> [--set section.key=value]...
program=$1
scene=$2
out=$3
shift 3
[ -e /dev/full ] || { echo "full_disk: left out, for there is no /dev/full"; exit 0; }
. "$(dirname "$0")/results.sh"
fail() {
  echo "full_disk: $(basename "$program"): $*"
  exit 1
}
rm -rf "$out"
mkdir -p "$out" || exit 1
whole=$out/whole
part=$out/part
"$program" "$scene" --output "$whole" --quiet "$@" || fail "the run that was left alone ended with status $?"
# One file of each kind: of numbered ones the first.
files=$(cd "$whole" && find . -type f ! -name .lock | sed 's,^\./,,' | sort | awk '{ kind = $0; gsub(/[0-9]+/, "", kind) } !(kind in seen) { seen[kind] = 1; print }')
for file in $files; do
  rm -rf "$part"
  mkdir -p "$(dirname "$part/$file")" || exit 1
  case $file in
    *.bin | *.before) ln -s /dev/full "$part/$file.part" ;;
    *) ln -s /dev/full "$part/$file.partial" ;;
  esac
  message=$("$program" "$scene" --output "$part" --overwrite --quiet "$@" 2>&1)
  status=$?
  [ $status -eq 2 ] || fail "$file: not told by the exit status, which is $status"
  case $message in
    *"cannot write"*"${file##*/}: No space left on device"*) ;;
    *) fail "$file: $message" ;;
  esac
  rm -f "$part/$file.part" "$part/$file.partial"
  message=$("$program" "$scene" --output "$part" --resume --quiet "$@" 2>&1) || fail "$file: resumed with room again: $message"
  same_results "$whole" "$part" "$out" || fail "$file: resumed with room again: $difference"
done
# Files that may not become longer: rows of a table are told as well.
rm -rf "$part"
message=$(ulimit -f 2 && "$program" "$scene" --output "$part" --quiet "$@" --set output.paraview=false 2>&1)
[ $? -eq 2 ] || fail "a file that may not grow was not told by the exit status"
case $message in
  *"cannot write"*"File too large"*) ;;
  *) fail "a file that may not grow: $message" ;;
esac
echo "full_disk: $(basename "$program"): $(echo "$files" | wc -l) kinds of files were told, and the results are the same with room again"
