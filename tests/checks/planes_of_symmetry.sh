#!/bin/sh
# SPDX-License-Identifier: MIT
# The stiffness of a cell whose planes of symmetry lie along its threads: strains in the plane and curvatures are not coupled.
# usage: planes_of_symmetry.sh <stiffness.csv>
awk -F, 'FNR > 1 { for (k = 1; k <= 6; ++k) K[FNR - 1, k] = $(k + 1) }
  END { for (i = 1; i <= 3; ++i) for (k = 4; k <= 6; ++k) {
      one = K[i, k] ^ 2 / (K[i, i] * K[k, k])
      if (!(one < 1e-5)) { print "coupled:", i, k, one; exit 1 } } }' "$1"
