#!/bin/sh
# SPDX-License-Identifier: MIT
# Computes what docs/evidence/validation.md compares with measurements, and leaves tables (printed) and plots (.svg) in a folder.
# usage: benchmarks/validation/run.sh PROGRAMS FOLDER [knots] [mats] [knits] [conductor] [closed]
#   PROGRAMS  folder of the programs, build/release/bin after `cmake --build --preset release`
# Without a choice all are run, one after the other, on one thread; what is in FOLDER already is computed again.
set -eu
[ $# -ge 2 ] || { sed -n '3,6s/^# //p' "$0"; exit 2; }
programs=$1
folder=$2
shift 2
here=$(dirname "$0")
mkdir -p "$folder"
export OMP_NUM_THREADS=1
status=0
compute() { # PROGRAM SCENE NAME [option]...
  program=$1 scene=$2 name=$3
  shift 3
  echo "$name"
  "$programs/$program" "$scene" --output "$folder/$name" --overwrite --quiet --threads 1 \
    --set output.paraview=false --set output.pictures=false "$@" > "$folder/$name.log" 2>&1 ||
    { echo "$name: status $?, see $folder/$name.log"; status=1; }
}
for set in ${*:-closed knots knits conductor mats}; do
  case $set in
    closed) "$programs/benchmark_validation_closed_forms_bench" > "$folder/closed.csv" || status=1 ;;
    knots)
      compute knot "$here/knot.toml" knot_3_100 --set knot.loop_radius=100 --set knot.tail=300 --set knot.elements=200
      compute knot "$here/knot.toml" knot_3_200 --set knot.loop_radius=200 --set knot.tail=500 --set knot.elements=320 \
        --set loading.draw=10
      compute knot "$here/knot.toml" knot_5_100 --set knot.crossings=5 --set knot.loop_radius=100 --set knot.tail=300 \
        --set knot.elements=240 --set loading.draw=26
      compute knot "$here/knot.toml" knot_5_200 --set knot.crossings=5 --set knot.loop_radius=200 --set knot.tail=500 \
        --set knot.elements=360 --set loading.draw=0
      ;;
    mats)
      mat="$here/../../examples/dense_mat/dense_mat.toml"
      compute dense_mat "$mat" mat_plane --set levels.last=0.33 --set mat.seeds=2
      compute dense_mat "$mat" mat_space --set mat.tilt_deg=90 --set mat.volume_fraction=0.1 --set levels.last=0.26 \
        --set mat.seeds=2
      ;;
    knits)
      for courses in 3 5; do
        compute textile "$here/knit.toml" knit_$courses --set weft_knit.courses=$courses
      done
      ;;
    conductor)
      compute strand_bending "$here/conductor.toml" conductor
      # A Poisson's ratio next to -1 makes wires 65 times as stiff in torsion, and changes nothing else of weight: none rolls.
      compute strand_bending "$here/conductor.toml" conductor_no_rolling --set material.poisson_ratio=-0.98 \
        --set inner.poisson_ratio=-0.98 --set loading.angle_deg=1.0
      ;;
    *) echo "$set is none of closed, knots, knits, conductor, mats"; exit 2 ;;
  esac
done
python3 "$here/plots.py" "$folder"
exit $status
