#!/bin/sh
# SPDX-License-Identifier: MIT
# A cell that is twice as long is the same fabric: what it bears at rest makes nothing of its stiffness against bending and twist.
# usage: textile_cells.sh <the program> <a scene in the folder of scenes> <scratch folder>
program=$1
scenes=$(dirname "$2")
out=$3
rm -rf "$out"
mkdir -p "$out" || exit 1
fail() {
  echo "textile_cells: $*"
  exit 1
}
cell() {
  name=$1
  shift
  "$program" "$scenes/cell_plain.toml" --output "$out/$name" --quiet --set output.paraview=false --set contact.friction_coefficient=0 \
    "$@" || fail "$name"
  sh "$(dirname "$0")/planes_of_symmetry.sh" "$out/$name/loading/stiffness.csv" || fail "planes of symmetry of $name"
}
cell usual
cell long --set 'levels.levels=["01","10","01","10"]' --set loading.amount=3e-6
for kind in bend_x bend_y twist; do
  awk -F, -v kind=$kind 'FNR == 1 { for (i = 1; i <= NF; ++i) of[$i] = i
      own = kind == "bend_x" ? "m_x" : kind == "bend_y" ? "m_y" : "m_xy" }
    $1 == kind { found[++files] = $of[own] }
    END { exit !(found[1] > 0 && found[2] > 0.99 * found[1] && found[2] < 1.01 * found[1]) }' \
    "$out/usual/loading/stiffness.csv" "$out/long/loading/stiffness.csv" || fail "$kind of a cell that is twice as long"
done
exit 0
