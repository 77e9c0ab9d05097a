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
# All columns of increments.csv but the one of seconds, which depends on the clock, and whole tables. FOLDER TABLE...
figures() {
  folder=$1
  shift
  awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k == "seconds") left = k } { $left = ""; print }' "$folder/increments.csv"
  for table in "$@"; do cat "$folder/$table.csv" || return 1; done
}
