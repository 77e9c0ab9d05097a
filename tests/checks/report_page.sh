#!/bin/sh
# SPDX-License-Identifier: MIT
# Opens a report in a browser: its script runs without an error, fibres are seen in every view, and a cut takes some of them away.
# All figures have a meaning, and all curves are there. Without a browser the test is skipped.
# usage: report_page.sh BROWSER REPORT.html SCRATCH_FOLDER        (BROWSER: chromium)
set -eu
browser=$1
report=$2
scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
fail() {
  echo "report_page: $*"
  exit 1
}
[ -x "$browser" ] || {
  echo "report_page: skipped, for there is no browser (Debian: chromium)"
  exit 77
}
[ -s "$report" ] || fail "there is no $report"
grep -q '<title>..*</title>' "$report" || fail "the page has no title"
grep -B 1 '<small></small>' "$report" && fail "a figure has no meaning: add it to examples/support/figure_meanings.hpp"
for curve in 'out of balance' 'Deepest contact' 'damping holds' Energies; do
  grep -q "$curve" "$report" || fail "there is no curve \"$curve\""
done
grep -qE '(src|href)="https?:' "$report" && fail "the page wants the network"

# The page, and a script that looks at the canvas as a user would.
cp "$report" "$scratch/page.html"
cat >> "$scratch/page.html" << 'END'
<script>
window.requestAnimationFrame = draw => setTimeout(draw, 0);  // without a window there are no frames
window.addEventListener('load', function () {
  const seen = [], canvas = document.getElementById('view');
  const count = function () {
    const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    let painted = 0;
    for (let k = 3; k < pixels.length; k += 4) if (pixels[k] > 0) ++painted;
    return painted;
  };
  const steps = [...document.querySelectorAll('button[data-view]')].map(button => function () { button.click(); });
  steps.push(function () {
    const cut = document.getElementById('cut');
    cut.value = 500, cut.dispatchEvent(new Event('input'));
  });
  const next = function () {
    if (steps.length === 0) {
      const told = document.createElement('p');
      told.textContent = 'PAINTED ' + seen.join(' ') + ' OF ' + canvas.width * canvas.height;
      return document.body.appendChild(told);
    }
    steps.shift()();
    setTimeout(function () { seen.push(count()), next(); }, 20);
  };
  next();
});
</script>
END
sh "$(dirname "$0")/in_browser.sh" "$browser" "file://$scratch/page.html" "$scratch/dom.html" "$scratch" || fail "see above"
told=$(sed -n 's/.*PAINTED \([0-9 ]*\) OF \([0-9]*\).*/\1 \2/p' "$scratch/dom.html" | grep '[0-9]' | tail -n 1)
[ -n "$told" ] || fail "the view was not drawn"
# shellcheck disable=SC2086
set -- $told
[ $# -ge 6 ] || fail "expected four views and a cut, but got: $told"
for whole; do :; done
# The bar and the axes alone paint a five hundredth.
number=1
while [ $# -gt 1 ]; do
  [ "$1" -gt $((whole / 200)) ] || fail "view $number is all but empty: $1 of $whole points are painted"
  before=${now:-$1}
  now=$1
  number=$((number + 1))
  shift
done
[ "$now" -lt "$before" ] || fail "the cut took nothing away: $before points before it, $now after"
echo "painted: $told"
