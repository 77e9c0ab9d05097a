# SPDX-License-Identifier: MIT
# A bundle of n fibres in hexagonal places as a noisy scan gives it: points fibre,x,y,z a radius apart, with Gaussian noise;
# neighbours lie in each other by `overlap` radii before the noise. The same numbers everywhere.
#   awk -v n=37 -v r=0.05 -v overlap=0.1 -v noise=0.1 -v length_over_radius=100 -f noisy_scan.awk > scan_37.csv
function uniform() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
function normal(  k, sum) { sum = -6; for (k = 0; k < 12; ++k) sum += uniform(); return sum }
BEGIN {
  seed = 20011; pi = atan2(0, -1); pitch = (2 - overlap) * r; m = 0
  for (i = -14; i <= 14; ++i)
    for (j = -14; j <= 14; ++j) {
      y[m] = pitch * (i + 0.5 * j); z[m] = pitch * sqrt(0.75) * j; d[m] = y[m] * y[m] + z[m] * z[m]; ++m
    }
  print "fibre,x,y,z"
  for (f = 0; f < n; ++f) {
    best = -1
    for (k = 0; k < m; ++k) if (!(k in used) && (best < 0 || d[k] < d[best] - 1e-12)) best = k
    used[best] = 1
    for (p = 0; p <= length_over_radius; ++p) {
      t = 2 * pi * p / length_over_radius
      printf "%d,%.6f,%.6f,%.6f\n", f, (p + noise * normal()) * r, y[best] + (0.5 * sin(t) + noise * normal()) * r,
             z[best] + (0.3 * cos(2 * t) + noise * normal()) * r
    }
  }
}
