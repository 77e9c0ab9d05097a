#!/bin/sh
# SPDX-License-Identifier: MIT
# Gives an example what it has to refuse: the table tests/checks/malformed/<name>.txt, what every program refuses alike, and what no key of
# its kind may be, for each that --help-scene tells of. Each input has to be refused within seconds, before anything is written, with
# status 2 and one line that names file, section.key, value and what it must be. A program that reads no scene has a script
# of its own, tests/checks/malformed/<name>.sh.
# usage: malformed.sh <the program> <scene file, or -> <scratch folder> [every n-th input only]
program=$1
scene=$2
out=$3
step=${4:-1}
here=$(cd "$(dirname "$0")/malformed" && pwd)
case $scene in
  /* | -) ;;
  *) scene=$PWD/$scene ;;
esac
. "$here/try.sh"
if [ -f "$here/$name.sh" ]; then
  . "$here/$name.sh"
  finish
  exit
fi
table=$here/$name.txt
# with VALUE WORDS: the scene with one value replaced. The message names the file or the option, and the key.
with() {
  message=
  try "$2" "$scene" --output "$out/results" --quiet --set "$1"
  case $message in
    "" | *"$scene: yarn "* | *"$scene: "[a-z]*.[a-z]* | *"$scene: "[a-z]*"one of the sections"* | *"--set "*.*) ;;
    *) report "does not name file and key" "$message" "--set $1" ;;
  esac
}
# text CONTENT WORDS: a scene file of its own.
text() {
  printf '%b' "$1" > "$out/scene.toml"
  try "$2" "$out/scene.toml" --output "$out/results" --quiet
}

of files
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
try "below: cannot be read as a scene file: Not a directory" "$out/file/below" --output "$out/results"
try "is missing, but it must be given" /dev/null --output "$out/results"
head -c 5000 "$program" > "$out/binary.toml"
try "binary.toml:" "$out/binary.toml" --output "$out/results"
# Of one who may read everything no file is closed.
if [ "$(id -u)" -ne 0 ]; then
  cp "$scene" "$out/closed.toml" && chmod 000 "$out/closed.toml"
  try "closed.toml: cannot be read as a scene file: Permission denied" "$out/closed.toml" --output "$out/results"
  mkdir -p "$out/closed" && chmod 555 "$out/closed"
  try "closed: cannot be written to: Permission denied" "$scene" --output "$out/closed" --quiet
  try "below: cannot be made: Permission denied" "$scene" --output "$out/closed/below" --quiet
fi
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
# A byte order mark and lines that end in CR LF are read as what they are.
{ printf '\357\273\277'; sed 's/$/\r/' "$scene"; printf '[nonsense]\r\na = 1\r\n'; } > "$out/scene.toml"
try "nonsense = [section], but it must be one of the sections" "$out/scene.toml" --output "$out/results" --quiet

of options
try "$name: scene is required" --output "$out/results"
try "--output is required" "$scene"
try "$name: --threads has too few values, but it must have 1" "$scene" --output "$out/results" --threads
try "$name: --threads has too few values, but it must have 1" "$scene" --output "$out/results" --threads=
try "--threads = , but it must be a whole number from 0" "$scene" --output "$out/results" --quiet --threads ""
try "$name: --output has 2 values, but it must have at most 1" "$scene" --output "$out/results" --output "$out/others"
try "$name: " "$scene" "$scene" --output "$out/results"
try "--no-such-option" "$scene" --output "$out/results" --no-such-option
try "--resume" "$scene" --output "$out/results" --resume --overwrite
for flag in --quiet=3 --quiet=false --resume=true --overwrite=0 --other-scene=1; do
  try "${flag%=*} has a value, but it must have none" "$scene" --output "$out/results" "$flag"
done
try "--output is empty" "$scene" --output ""
try "is a file, but it must be a folder" "$scene" --output "$out/file"
try "cannot be made" "$scene" --output "$out/file/below"
try "cannot be made" "$scene" --output "$out/file/far/below"
try "File name too long" "$scene" --output "$out/$(head -c 300 /dev/zero | tr '\0' 'a')" --quiet
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
with 'output.unit="mm' "--set output.unit = \"mm, but it must be a value of TOML"
with "output.unit=mm
solver.threads=1" "but it must be section.key=value in one line"
with "output.deepest_over_radius=-1" "output.deepest_over_radius = -1, but it must be > 0 and <= 2"
with "output.nonsense=1" "output.nonsense = 1, but it must be one of the keys"
with "solver.threads=100000" "solver.threads = 100000, but it must be a whole number from 0"

# Results of another program are neither gone on from nor written over. Some are not made by increments and leave no checkpoint.
# A scene that begins from results of weave is given some.
of results
ready=$scene
if [ "$name" = fabric_loading ]; then
  ready=
  weave=$(dirname "$program")/weave
  woven=$(dirname "$scene")/../weave/plain.toml
  small="fabric.warp_tows=2 fabric.weft_tows=2 fabric.elements=20 warp.fibres=3 warp.real_fibres=60 warp.aspect=1"
  if [ -x "$weave" ] && [ "$step" -eq 1 ]; then
    "$weave" "$woven" --output "$out/woven" --quiet $(printf -- ' --set %s' $small) > /dev/null 2>&1
    ready=$out/ready.toml
    sed "s|^set = [^#]*|set = [$(printf '"%s", ' $small)] |; s|^scene = [^#]*|scene = \"$woven\" |
      s|^checkpoint = [^#]*|checkpoint = \"$out/woven/checkpoint.bin\" |" "$scene" > "$ready"
  fi
fi
if [ -n "$ready" ]; then
  earlier=$out/earlier
  mkdir -p "$earlier" && echo "{}" > "$earlier/summary.json"
  try "--output $earlier: holds results of an earlier run (summary.json): --overwrite begins anew" "$ready" --output "$earlier" --quiet
  try "--output $earlier: holds results (summary.json) but no checkpoint.bin to resume from" "$ready" --output "$earlier" --quiet --resume
  mkdir -p "$out/named" && : > "$out/named/paraview"
  # Of whatever name a program gives to a file, at the end of its work or before it.
  for file in report.html top.svg slice_x.svg curve.svg checkpoint.bin.before checkpoint.bin.part; do
    mkdir -p "$out/taken.$file/$file/kept"
    try "--output $out/taken.$file: $file in it is a folder, but results have files of such names" "$ready" \
      --output "$out/taken.$file" --quiet --overwrite
  done
  try "--output $out/named: paraview in it is a file, but results have a folder" "$ready" --output "$out/named" --quiet --overwrite
  head -c 5000 "$program" > "$earlier/checkpoint.bin"
  try "--resume: " "$ready" --output "$earlier" --quiet --resume
  try "checkpoint.bin" "$ready" --output "$earlier" --quiet --resume --other-scene
  other=yarn
  [ "$name" != yarn ] || other=tow
  foreign=$(dirname "$program")/$other
  if [ -x "$foreign" ] && [ "$step" -eq 1 ]; then
    "$foreign" "$(dirname "$scene")/../$other/$other.toml" --output "$out/foreign" --quiet --set "$other.fibres=7" --set loading.increments=1 > /dev/null 2>&1
    if [ -f "$out/foreign/checkpoint.bin" ]; then
      try "--output $out/foreign: holds results of an earlier run" "$ready" --output "$out/foreign" --quiet
      try "checkpoint.bin is of another scene: " "$ready" --output "$out/foreign" --quiet --resume
      try "checkpoint.bin" "$ready" --output "$out/foreign" --quiet --resume --other-scene
    else
      report "left no checkpoint" "" "$foreign"
    fi
  fi
fi

# Every key that the program tells of is given all that none of its kind may be, and is misspelt; where the scene has it and it
# must be given, it is left out.
every_key() {
  "$program" --help-scene | awk '/^\[/ { section = substr($0, 2, length($0) - 2) }
    /^  [a-z]/ && match($0, /\((number|whole number|true or false|text|list of texts)/) {
      key = $1
      sub(":", "", key)
      print section "." key "|" substr($0, RSTART + 1) "|" ($0 ~ /: must be given/)
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
# each KEY VALUE...: all of them are refused by the key.
each() {
  key=$1
  shift
  for value; do
    with "$key=$value" ": $key = "
  done
}
every_key > "$out/keys"
if [ -n "$(sed -n 's/^stands: //p' "$table")" ]; then
  sed -n 's/^stands: \(.*\) for \(.*\)$/s,^\1[.],\2.,/p' "$table" > "$out/stands"
  sed -f "$out/stands" "$out/keys" > "$out/keys.named" && mv "$out/keys.named" "$out/keys"
fi
[ -s "$out/keys" ] || { echo "malformed: $name tells of no keys"; exit 1; }
known=
unknown=
while IFS='|' read -r key told required; do
  section=${key%.*}
  of types
  with "$key=[[[1]]]" ": $section"
  case " $known $unknown " in
    *" $section "*) ;;
    *)
      if grep -q "^ *\[$section\]" "$scene" || section_known "$section"; then
        known="$known $section"
      else
        unknown="$unknown $section"
      fi
      ;;
  esac
  case " $known " in
    *" $section "*) ;;
    *) continue ;;
  esac
  case $told in
    number*)
      each "$key" '"text"' true '[1.0]' '{a = 1}' 0,5 1_ '0.02 rad' '0.02 0.03' 2026-11-26
      of numbers
      each "$key" nan -nan -inf -1e31
      case $told in
        *"or inf"*) ;;
        *) each "$key" inf 1e31 1e400 ;;
      esac
      ;;
    "whole number"*)
      each "$key" '"7"' '[7]' true '{a = 7}' 7x '7 8'
      of numbers
      each "$key" 1.5 1e3 nan inf 9223372036854775807 -9223372036854775808 99999999999999999999999
      case $told in
        *">= -"*) each "$key" -1000000 ;;
        *) each "$key" -1 ;;
      esac
      ;;
    "true or false"*) each "$key" 1 True '[true]' yes ;;
    text*)
      each "$key" 3 true '"\u0000"'
      with "$key=[\"text\"]" ": $key"  # some may be a list of rows as well, which are told by their own names
      ;;
    *) each "$key" 3 '[1]' '[["text"]]' '[true]' ;;
  esac
  of keys
  with "${key}x=1" ": ${key}x = 1, but it must be one of the keys"
  [ "$required" -eq 1 ] || continue
  awk -v section="[$section]" -v key="${key##*.}" '/^\[/ { within = ($1 == section) } !(within && $1 == key)' "$scene" > "$out/scene.toml"
  cmp -s "$scene" "$out/scene.toml" || try "scene.toml: $key is missing, but it must be given" "$out/scene.toml" --output "$out/results" --quiet
done < "$out/keys"
of keys
while IFS= read -r line; do
  case $line in
    "" | "#"* | "stands: "*) ;;
    *) with "${line%% :: *}" "${line#* :: }" ;;
  esac
done < "$table"

# Scenes that are changed at random.
if command -v python3 > /dev/null; then
  python3 "$here/mutate.py" "$program" "$scene" "$out/mutants" $((24 / step)) 0 "$([ "$step" -eq 1 ] && echo 2 || echo 0.3)" > "$out/mutants.txt" ||
    bad=$((bad + $(grep -c ', kept as ' "$out/mutants.txt")))
  cat "$out/mutants.txt"
fi

# Less memory than the scene needs, of one thread and of more than there is room for: told by its own message, unless the loader
# of the system tells that the program does not even begin. What is done before memory runs short is no matter here.
short() {  # KILOBYTES THREADS
  rm -rf "$out/results"
  message=$(ulimit -v "$1" && ulimit -t 2 && exec timeout -s KILL 20 "$program" "$scene" --output "$out/results" --quiet --threads="$2" 2>&1 < /dev/null)
  status=$?
  printf '%s\n' "$message" >> "$out/messages"
  case $status:$message in
    127:* | 0:* | 1:* | 137:* | 152:*) return ;;
    2:*"$scene: "*memory* | 2:*"--threads = $2, but it must be at most "*) echo "memory 1" >> "$out/kinds" ;;
    *)
      report "ended with status $status within $1 kB, $2 threads" "$message" "$scene"
      echo "memory 0" >> "$out/kinds"
      ;;
  esac
  tried=$((tried + 1))
}
of memory
for limit in 16000 20000 24000 30000 40000 60000; do
  short $limit 1
  [ "$step" -eq 1 ] || break
done
short 100000 64
rm -rf "$out/results"
finish
