#!/bin/sh
# SPDX-License-Identifier: MIT
# What macro-fibres cost in accuracy: the plain weave of examples/weave/plain.toml, whose tows of 380 filaments stand as 7 to 380
# fibres of the same area and bending stiffness on the same mesh, is settled, stretched and sheared. Leaves a table (printed) and
# a plot (.svg) of what differs from the finest that was computed.
# usage: benchmarks/macro_fibres/run.sh PROGRAMS FOLDER [FIBRES...]
#   PROGRAMS  folder of the programs, build/release/bin after `cmake --build --preset release`
#   FIBRES    computed fibres a tow, 7 19 38 76 unless said; settled,N is not loaded and stretched,N not sheared: 380 take hours
# What has come to its end in FOLDER is kept: a run that was interrupted goes on.
set -eu
[ $# -ge 2 ] || { sed -n '3,9s/^# //p' "$0"; exit 2; }
programs=$1
folder=$(mkdir -p "$2" && cd "$2" && pwd)
shift 2
here=$(cd "$(dirname "$0")" && pwd)
examples=$here/../../examples
export OMP_NUM_THREADS=1
status=0
compute() { # PROGRAM SCENE NAME [option]...
  program=$1 scene=$2 name=$3
  shift 3
  if grep -qs '"converged": true' "$folder/$name/summary.json"; then return; fi
  echo "$name"
  again=
  [ ! -e "$folder/$name/checkpoint.bin" ] || again=--resume
  "$programs/$program" "$examples/$program/$scene.toml" --output "$folder/$name" $again --quiet --threads 1 \
    --set output.paraview=false "$@" > "$folder/$name.log" 2>&1 ||
    { echo "$name: status $?, see $folder/$name.log"; status=1; }
}
for choice in ${*:-7 19 38 76}; do
  fibres=${choice#*,}
  # Elements of the finest mesh for all, so that nothing but fibres differs.
  compute weave plain "plain_$fibres" --set "warp.fibres=$fibres" --set fabric.elements=32
  [ "$choice" != "settled,$fibres" ] || continue
  # A step may move 0.05 mm, two and a half radii of 76 fibres.
  far=$(awk "BEGIN { print 0.05 / (0.009 * sqrt(380 / $fibres)) }")
  of="--set settled.checkpoint=$folder/plain_$fibres/checkpoint.bin --set loading.tow_ends=fibres
    --set loading.largest_displacement_over_radius=$far"
  set_of="settled.set=[\"warp.fibres=$fibres\",\"fabric.elements=32\"]"
  # shellcheck disable=SC2086
  compute fabric_loading equibiaxial "stretched_$fibres" $of --set "$set_of" --set 'stretch.ramps=["strain = 0.005"]' \
    --set stretch.increments=10
  [ "$choice" = "$fibres" ] || continue
  # shellcheck disable=SC2086
  compute fabric_loading shear "sheared_$fibres" $of --set "$set_of" --set 'loading.stages=["tighten","shear"]' \
    --set 'shear.ramps=["shear = 0.35"]' --set shear.increments=70 --set shear.damping=1e-3
done
python3 "$here/table.py" "$folder"
exit $status
