# SPDX-License-Identifier: MIT
# What checks of programs on ranks have alike; read by them, once `mpirun` and `out` are set.
fail() {
  echo "$(basename "$0"): $*"
  exit 1
}
# MPI does not run as root unless it is told to; it ties threads to one core unless it is told not to.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMP_WAIT_POLICY=passive
on() { # ranks threads program ...
  ranks=$1
  threads=$2
  shift 2
  OMP_NUM_THREADS=$threads "$mpirun" -n "$ranks" "$@"
}
# A program on one rank, and then on two and four of one and two threads: the same figures, in $out/expected. What it does is
# said where it fails. WHAT TABLES PROGRAM ARGUMENT...
alike() {
  what=$1
  tables=$2
  shift 2
  on 1 1 "$@" --output "$out/1" || fail "$what did not end on one rank"
  figures "$out/1" $tables >"$out/expected" || fail "tables are missing: $what"
  [ -s "$out/expected" ] || fail "there is no table: $what"
  for run in "2 1" "2 2" "4 1"; do
    name=${run% *}x${run#* }
    on "${run% *}" "${run#* }" "$@" --output "$out/$name" || fail "$what did not end on $name ranks x threads"
    figures "$out/$name" $tables | cmp -s - "$out/expected" || fail "$what has other bits on $name ranks x threads than on one"
  done
}
# All columns of increments.csv but the one of seconds, which depends on the clock, and whole tables. FOLDER TABLE...
figures() {
  folder=$1
  shift
  awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k == "seconds") left = k } { $left = ""; print }' "$folder/increments.csv"
  for table in "$@"; do cat "$folder/$table.csv" || return 1; done
}
