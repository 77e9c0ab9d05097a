#!/bin/sh
# SPDX-License-Identifier: MIT
# A nest falls as a user would let it; one on which a lid has come to rest pushes it up by what it weighs and is pressed by.
# usage: fall_example.sh <the program> <a scene in the folder of scenes> <scratch folder>
program=$1
scenes=$(dirname "$2")
out=$3
sh "$(dirname "$0")/run_example.sh" "$program" "$scenes/fall.toml" "$out" || exit 1
"$program" "$scenes/lid.toml" --output "$out/lid" --quiet || exit 1
# 10 g under 9.81e-3 mm/ms^2, at the end of the fall; 0.1 N more at the end of the press. It still moves a little.
awk -F, '
  function near(value, expected, part) { return value > (1 - part) * expected && value < (1 + part) * expected }
  NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k; next }
  { at[$column["stage"]] = $column["lid_force"] }
  END {
    if (!near(at["fall"], 0.0981, 0.06) || !near(at["press"], 0.1981, 0.03)) {
      print "fall_example: the lid feels " at["fall"] " and then " at["press"] ", and should 0.0981 and 0.1981"
      exit 1
    }
  }' "$out/lid/increments.csv"
