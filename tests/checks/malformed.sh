#!/bin/sh
# SPDX-License-Identifier: MIT
# Gives an example what it has to refuse: the table tests/checks/malformed/<name>.txt, and what every program refuses alike. Each input has to be
# refused within seconds, before anything is written, with status 2 and one line that names file, section.key, value and what it must be.
# usage: malformed.sh <the program> <scene file> <scratch folder> [every n-th input only]
program=$1
scene=$2
out=$3
step=${4:-1}
name=$(basename "$program")
table=$(dirname "$0")/malformed/$name.txt
number=0
tried=0
bad=0
absolute() {
  case $1 in
    /*) echo "$1" ;;
    *) echo "$PWD/$1" ;;
  esac
}
program=$(absolute "$program")
scene=$(absolute "$scene")
table=$(absolute "$table")
out=$(absolute "$out")
rm -rf "$out"
mkdir -p "$out/a folder" || exit 1
: > "$out/file"
cd "$out/a folder" || exit 1  # where nothing is
report() {
  bad=$((bad + 1))
  echo "malformed: $name $3: $1: $(printf '%s' "$2" | cut -c 1-300)"
}
# try WORDS ARGUMENT...: what the message has to hold, then the whole command line; "results" stands for a folder that must not come to be.
try() {
  words=$1
  shift
  number=$((number + 1))
  [ $((number % step)) -eq 0 ] || return 0
  tried=$((tried + 1))
  rm -rf "$out/results"
  message=$(timeout -s KILL 10 "$program" "$@" 2>&1 < /dev/null)
  status=$?
  shown=$(printf '%s ' "$@" | cut -c 1-160)
  if [ $status -ne 2 ]; then
    report "ended with status $status, not 2" "$message" "$shown"
  elif [ "$(printf '%s\n' "$message" | wc -l)" -gt 3 ]; then
    report "says more than a line" "$message" "$shown"
  elif [ -e "$out/results" ]; then
    report "left a folder of results" "$message" "$shown"
  else
    case $message in
      *"$words"*) ;;
      *) report "does not say '$words'" "$message" "$shown" ;;
    esac
  fi
}
# set VALUE WORDS: the scene with one value replaced.
with() {
  try "$2" "$scene" --output "$out/results" --quiet --set "$1"
}
# text CONTENT WORDS: a scene file of its own.
text() {
  printf '%b' "$1" > "$out/scene.toml"
  try "$2" "$out/scene.toml" --output "$out/results" --quiet
}

# What is no scene file at all.
many=$(head -c 200000 /dev/zero | tr '\0' '.' | sed 's/\./a./g')
text "${many}a = 1\n" "a key of more than 8 parts"
text "[${many}a]\n" "a key of more than 8 parts"
text "[a]\nb = {${many}a = 1}\n" "a key of more than 8 parts"
text "[a]\nb = $(head -c 100000 /dev/zero | tr '\0' '[')\n" "brackets are nested"
text "[a]\nb = $(head -c 100000 /dev/zero | tr '\0' '{')\n" "brackets are nested"
{ cat "$scene"; head -c 2000000 /dev/zero | tr '\0' '#'; } > "$out/long.toml"
try "more than 1,000,000 characters" "$out/long.toml" --output "$out/results"
try "is a folder, but it must be a scene file" "$out/a folder" --output "$out/results"
try "no_such.toml: cannot be read as a scene file" "$out/no_such.toml" --output "$out/results"
head -c 5000 "$program" > "$out/binary.toml"
try "binary.toml:" "$out/binary.toml" --output "$out/results"
text "" "is missing, but it must be given"
text "\n\n# nothing\n" "is missing, but it must be given"
text "[nonsense\n" "scene.toml:1:"
text "[solver]\nthreads = 1\nthreads = 2\n" "scene.toml:3:"
text "[solver]\nthreads = \n" "scene.toml:2:"
text "threads = 1\n" "threads, but it must be one of the sections"
text "[[solver]]\nthreads = 1\n" "solver is a list, but it must be a section"
text "solver = 3\n" "solver is a value, but it must be a section"
text "[nonsense]\na = 1\n" "nonsense = [section], but it must be one of the sections"
text "[output]\nunit = \"\\\\u0000\"\n" "output.unit"
text "[output]\nunit = \"$(head -c 10000 /dev/zero | tr '\0' 'm')\"\n" "output.unit"
text "[output]\n\0377\0376 = 1\n" "scene.toml:"
# The command line.
try "scene is required" --output "$out/results"
try "--output is required" "$scene"
try "--no-such-option" "$scene" --output "$out/results" --no-such-option
try "--resume" "$scene" --output "$out/results" --resume --overwrite
try "is a file, but it must be a folder" "$scene" --output "$out/file"
try "cannot be made" "$scene" --output "$out/file/below"
for threads in -1 1.5 2x 0x2 "1 2" 100000 99999999999999999999 nan 0,5; do
  try "--threads = $threads, but it must be a whole number from 0" "$scene" --output "$out/results" --quiet --threads="$threads"
done
OMP_NUM_THREADS=100000
export OMP_NUM_THREADS
try "OMP_NUM_THREADS = 100000, but it must be a whole number from 0" "$scene" --output "$out/results" --quiet
unset OMP_NUM_THREADS
try "--set = nonsense, but it must be section.key=value" "$scene" --output "$out/results" --set nonsense
try "--set = a=b, but it must be section.key=value" "$scene" --output "$out/results" --set a=b
try "--set = .a=b, but it must be section.key=value" "$scene" --output "$out/results" --set .a=b
try "--set = a.=b, but it must be section.key=value" "$scene" --output "$out/results" --set a.=b
try "the value is missing" "$scene" --output "$out/results" --set output.unit=
with "output.unit={a.a.a.a.a.a.a.a.a.a.a.a=1}" "a key of more than 8 parts"
with "output.pictures=1" "output.pictures = 1, but it must be true or false"
with "output.paraview=yes" "output.paraview = 'yes', but it must be true or false"
with "output.unit=3" "output.unit = 3, but it must be a text"
with "output.deepest_over_radius=-1" "output.deepest_over_radius = -1, but it must be > 0 and <= 2"
with "output.nonsense=1" "output.nonsense = 1, but it must be one of the keys"
with "solver.threads=100000" "solver.threads = 100000, but it must be a whole number from 0"
with "solver.threads=-1" "solver.threads = -1, but it must be"
with 'output.unit="mm' "--set output.unit = \"mm, but it must be a value of TOML"
with "output.unit=mm
solver.threads=1" "but it must be section.key=value in one line"
try "File name too long" "$scene" --output "$out/$(head -c 300 /dev/zero | tr '\0' 'a')" --quiet
# A byte order mark and lines that end in CR LF are read as what they are.
{ printf '\357\273\277'; sed 's/$/\r/' "$scene"; printf '[nonsense]\r\na = 1\r\n'; } > "$out/scene.toml"
try "nonsense = [section], but it must be one of the sections" "$out/scene.toml" --output "$out/results" --quiet
# Every key that the program tells of is given what is of another kind, and is misspelt.
every_key() {
  "$program" --help-scene | awk '/^\[/ { section = substr($0, 2, length($0) - 2) }
    /^  [a-z]/ && match($0, /\((number|whole number|true or false|text|list of texts)/) {
      key = $1
      sub(":", "", key)
      print section "." key "|" substr($0, RSTART + 1, RLENGTH - 1)
    }'
}
# A section in capitals stands for those that the user names: the table says "stands: STAGE for NAME". One that the scene has no
# use for is refused whole.
section_known() {  # by the program in this scene
  case $("$program" "$scene" --output "$out/results" --quiet --set "$1.no_such_key=1" 2>&1) in
    *"$1.no_such_key = 1"*) ;;
    *) return 1 ;;
  esac
}
every_key > "$out/keys"
if [ -n "$(sed -n 's/^stands: //p' "$table")" ]; then
  sed -n 's/^stands: \(.*\) for \(.*\)$/s,^\1[.],\2.,/p' "$table" > "$out/stands"
  sed -f "$out/stands" "$out/keys" > "$out/keys.named" && mv "$out/keys.named" "$out/keys"
fi
[ -s "$out/keys" ] || { echo "malformed: $name tells of no keys"; exit 1; }
while IFS='|' read -r key kind; do
  case $kind in
    number) values='"text" true [1.0] nan 0,5 1_ -1e31' ;;
    "whole number") values='1.5 "7" [7] true nan -9223372036854775808' ;;
    "true or false") values='1 True [true] yes' ;;
    text) values='3 true ["text"] "\u0000"' ;;
    *) values='3 [1] [["text"]] [true]' ;;
  esac
  with "$key=[[[1]]]" ": ${key%.*}"
  grep -q "^ *\[${key%.*}\]" "$scene" || section_known "${key%.*}" || continue
  for value in $values; do
    with "$key=$value" ": $key"
  done
  with "${key}x=1" ": ${key}x = 1, but it must be one of the keys"
done < "$out/keys"
# The program's own keys. A line "number: section.key" is a number to which all is done that a number may not be.
while IFS= read -r line; do
  case $line in
    "" | "#"* | "stands: "*) ;;
    "number: "*)
      key=${line#number: }
      for value in nan inf -inf '"text"' true '[1.0]' '{a = 1}' 0,5 '0.02 rad' '0.02 0.03' 1e400 -1e31 1e31 2026-11-26; do
        with "$key=$value" ": $key = "
      done
      ;;
    "count: "*)
      key=${line#count: }
      for value in -1 1.5 nan 1e3 '"7"' 7x 9223372036854775807 99999999999999999999999 -9223372036854775808 '[7]'; do
        with "$key=$value" ": $key = "
      done
      ;;
    "missing: "*)
      key=${line#missing: }
      section=${key%%.*}
      awk -v section="[$section]" -v key="${key#*.}" '/^\[/ { within = ($1 == section) } !(within && $1 == key)' "$scene" > "$out/scene.toml"
      try "scene.toml: $key is missing, but it must be given" "$out/scene.toml" --output "$out/results" --quiet
      ;;
    *)
      with "${line%% :: *}" "${line#* :: }"
      ;;
  esac
done < "$table"
echo "malformed: $name: $bad of $tried inputs are not refused as they should be"
[ "$bad" -eq 0 ]
