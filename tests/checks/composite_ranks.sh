#!/bin/sh
# SPDX-License-Identifier: MIT
# A small composite is settled, bonded and bent on one, two and four ranks of one and two threads: the same results to the last
# bit.
# usage: composite_ranks.sh <mpirun> <composite_mpi> <scene file> <scratch folder>
mpirun=$1
composite=$2
scene=$3
out=$4
rm -rf "$out"
mkdir -p "$out" || exit 1
small="--set load.increments=4 --set solver.subdomains=8 --set output.paraview=false --set output.pictures=false --quiet"
. "$(dirname "$0")/ranks.sh"

alike "a composite" "" "$composite" "$scene" $small
exit 0
