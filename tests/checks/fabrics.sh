#!/bin/sh
# SPDX-License-Identifier: MIT
# Settles a list of odd but valid weaves and says how each ended: status, convergence, audit, least gap, increments, time.
# usage: fabrics.sh <the program> <scene file> <list of fabrics> <scratch folder> [every n-th] [least share that is clean, %] [only names like]
weave=$1
scene=$2
list=$3
out=$4
every=${5:-1}
share=${6:-98}
only=${7:-.}
limit=${FABRICS_SECONDS:-300} # of processor time, each
rm -rf "$out"
mkdir -p "$out" || exit 1
# What fibres are is said by radius and inertia factor: those of 7 fibres that stand for 380.
sed -e 's/^real_fibres.*/radius = 0.0663/' -e 's/^real_diameter.*/inertia_factor = 0.0184/' -e '/^weft_spacing/d' "$scene" > "$out/scene.toml"
base="fabric.warp_tows=3 fabric.weft_tows=3 fabric.elements=20 warp.fibres=7 output.paraview=false output.pictures=false"
printf '%-27s %4s %-9s %-5s %8s %5s %5s %6s %7s  %s\n' fabric exit converged clean 'gap / r' incr rej newton time reason
value() {
  sed -n "s/^ *\"$1\": *\"\{0,1\}\([^\"]*[^\",]\)\"\{0,1\},\{0,1\}$/\1/p" "$out/$name/summary.json" 2> /dev/null | head -1
}
grep '^[a-z]' "$list" | grep -e "$only" | awk -v every="$every" 'NR % every == 1 || every == 1' > "$out/list"
while read -r name sets; do
  set --
  for one in $base $sets; do set -- "$@" --set "$one"; done
  (ulimit -t "$limit"; exec "$weave" "$out/scene.toml" --output "$out/$name" --threads 1 --quiet "$@" > "$out/$name.said" 2>&1 < /dev/null)
  status=$?
  [ $status -eq 0 ] && echo "$name" >> "$out/clean"
  why=$(value reason)
  [ -n "$why" ] || why=$(head -c 150 "$out/$name.said" | tr '\n' ' ')
  printf '%-27s %4d %-9s %-5s %8.4f %5d %5d %6d %7.1f  %s\n' "$name" $status "$(value converged)" "$(value audit_clean)" \
    "$(value least_gap_over_radius)" "$(value increments)" "$(value rejected_increments)" "$(value newton_iterations)" \
    "$(value wall_seconds)" "$why"
done < "$out/list" 2> /dev/null
all=$(wc -l < "$out/list")
clean=$(cat "$out/clean" 2> /dev/null | wc -l)
echo "$clean of $all settle with a clean audit"
[ $((100 * clean)) -ge $((share * all)) ] || exit 1
