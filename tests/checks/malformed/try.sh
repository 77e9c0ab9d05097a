# SPDX-License-Identifier: MIT
# What malformed.sh and scripts of programs that read no scene have in common. Read by them, with $program and $out as told:
# sets $name, and goes to a folder where nothing is.
name=$(basename "$program")
number=0
tried=0
bad=0
newline='
'
absolute() {
  case $1 in
    /*) echo "$1" ;;
    *) echo "$PWD/$1" ;;
  esac
}
program=$(absolute "$program")
out=$(absolute "$out")
rm -rf "$out"
mkdir -p "$out/a folder" || exit 1
: > "$out/file"
: > "$out/messages"
: > "$out/kinds"
report() {
  bad=$((bad + 1))
  echo "malformed: $name $(printf '%s' "$3" | cut -c 1-160): $1: $(printf '%s' "$2" | cut -c 1-300)"
}
# of KIND: what the inputs that follow are, in the table at the end.
kind=other
of() {
  kind=$1
}
# try WORDS ARGUMENT...: what the message has to hold, then the whole command line; "results" stands for a folder that must not come to be.
# A process may take two seconds of a processor, however busy the machine is, and twenty by the clock, for what waits and does
# not work.
try() {
  words=$1
  shift
  number=$((number + 1))
  [ $((number % step)) -eq 0 ] || return 0
  tried=$((tried + 1))
  [ ! -e "$out/results" ] || rm -rf "$out/results"
  message=$(ulimit -t 2 && exec timeout -s KILL 20 "$program" "$@" 2>&1 < /dev/null)
  status=$?
  before=$bad
  if [ $status -ne 2 ]; then
    report "ended with status $status, not 2" "$message" "$*"
  elif [ -e "$out/results" ]; then
    report "left a folder of results" "$message" "$*"
  else
    case $message in
      *"$newline"*"$newline"*"$newline"*) report "says more than a line" "$message" "$*" ;;
      *"$words"*) ;;
      *) report "does not say '$words'" "$message" "$*" ;;
    esac
  fi
  printf '%s\n' "$message" >> "$out/messages"
  echo "$kind $((bad == before))" >> "$out/kinds"
}
# No message has words of C++: names of types and functions are nothing that a user gave. Paths may have them.
finish() {
  [ "$scene" != - ] || scene=$out/none
  sed "s,$out/,OUT/,g; s,/$(basename "$scene"):,/SCENE:,g; s,$(dirname "$scene")/,/,g; s,$program,PROGRAM,g; s/ParaView//g; s/TexGen//g; s/DataFile//g; s/VTKFile//g; s/PolyData//g" "$out/messages" |
    grep -a -E '::|(^|[^a-z])std([^a-z]|$)|basic_|fibrant|_param|bad_alloc|what\(\)|terminate|[A-Z][a-z]+[A-Z][a-z]+' |
    cut -c 1-300 | sort -u > "$out/words"
  while IFS= read -r line; do
    report "words of C++" "$line" ""
  done < "$out/words"
  sort "$out/kinds" | awk -v name="$name" '{ tried[$1] += 1; refused[$1] += $2 }
    END { for (kind in tried) printf "malformed: %s: %s: %d tried, %d refused\n", name, kind, tried[kind], refused[kind] }' | sort
  echo "malformed: $name: $bad of $tried inputs are not refused as they should be"
  [ "$bad" -eq 0 ]
}
cd "$out/a folder" || exit 1
