#!/bin/sh
# SPDX-License-Identifier: MIT
# Settles a list of odd but valid weaves or textiles and says how each ended: status, convergence, audit, least gap, increments,
# time. Where a folder of scenes is given, each line of the list has a scene after its name. Names with `refused_` are to end
# with status 2; those with `unstable_` with 1, for a stiffness that is symmetric and has a negative one on its diagonal.
# usage: fabrics.sh <the program> <scene file or folder> <list of fabrics> <scratch folder> [every n-th]
#   [least share that is clean, %] [only names like]
program=$1
scene=$2
list=$3
out=$4
every=${5:-1}
share=${6:-98}
only=${7:-.}
limit=${FABRICS_SECONDS:-300} # of processor time, each
rm -rf "$out"
mkdir -p "$out" || exit 1
base="output.paraview=false output.pictures=false"
if [ ! -d "$scene" ]; then
  # What fibres are is said by radius and inertia factor: those of 7 fibres that stand for 380.
  sed -e 's/^real_fibres.*/radius = 0.0663/' -e 's/^real_diameter.*/inertia_factor = 0.0184/' -e '/^weft_spacing/d' "$scene" > "$out/scene.toml"
  base="fabric.warp_tows=3 fabric.weft_tows=3 fabric.elements=20 warp.fibres=7 $base"
fi
printf '%-27s %4s %-9s %-5s %-8s %8s %5s %5s %6s %7s  %s\n' fabric exit converged clean topology 'gap / r' incr rej newton time reason
value() {
  sed -n "s/^ *\"$1\": *\"\{0,1\}\([^\"]*[^\",]\)\"\{0,1\},\{0,1\}$/\1/p" "$out/$name/summary.json" 2> /dev/null | head -1
}
grep '^[a-z]' "$list" | grep -e "$only" | awk -v every="$every" 'NR % every == 1 || every == 1' > "$out/list"
while read -r name sets; do
  start=$out/scene.toml
  if [ -d "$scene" ]; then
    start=$scene/${sets%% *}.toml
    case $sets in *' '*) sets=${sets#* } ;; *) sets= ;; esac
  fi
  set --
  for one in $base $sets; do set -- "$@" --set "$one"; done
  (ulimit -t "$limit"
   exec "$program" "$start" --output "$out/$name" --threads 1 --quiet "$@" > "$out/$name.said" 2>&1 < /dev/null)
  status=$?
  case $name in refused_*) expected=2 ;; unstable_*) expected=1 ;; *) expected=0 ;; esac
  if [ $expected -eq 1 ]; then
    grep -q '"symmetric": true' "$out/$name/loading/summary.json" && grep -q '"stable": false' "$out/$name/loading/summary.json" \
      || expected=unstable
  fi
  [ "$status" = "$expected" ] && echo "$name" >> "$out/clean"
  why=$(value reason)
  [ -n "$why" ] || why=$(head -c 150 "$out/$name.said" | tr '\n' ' ')
  printf '%-27s %4d %-9s %-5s %-8s %8.4f %5d %5d %6d %7.1f  %s\n' "$name" $status "$(value converged)" "$(value audit_clean)" \
    "$(value topology_clean)" "$(value least_gap_over_radius)" "$(value increments)" "$(value rejected_increments)" \
    "$(value newton_iterations)" "$(value wall_seconds)" "$why"
done < "$out/list" 2> /dev/null
all=$(wc -l < "$out/list")
clean=$(cat "$out/clean" 2> /dev/null | wc -l)
echo "$clean of $all end as they should"
[ $((100 * clean)) -ge $((share * all)) ] || exit 1
