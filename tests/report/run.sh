#!/usr/bin/env bash
# Tries report pages in headless Chromium: opens each at 1200 and at 400 pixels, light and dark, and
# lets page_test.js do what a reader does; inputs.py then presses real keys and moves a real mouse.
#   tests/report/run.sh REPORT.html...
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
[ $# -gt 0 ] || { echo "run.sh: found no page; allowed: files that batten report wrote" >&2; exit 2; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# A sandbox needs rights that a container does not give.
browser() {
  chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --disable-dev-shm-usage \
    --user-data-dir="$scratch/profile" --no-first-run "$@" 2>"$scratch/browser.log"
}

# with_tests PAGE: the page with watch.js in front of all and the tests behind all.
with_tests() {
  awk -v watch="$here/watch.js" -v looks="$here/looks.js" -v pairs="$here/profile_test.js" \
    -v player="$here/player_test.js" -v panels="$here/panel_test.js" \
    -v filters="$here/filter_test.js" -v test="$here/page_test.js" '
    function put(file,  line) {
      print "<script>"
      while ((getline line < file) > 0) print line
      close(file)
      print "</script>"
    }
    $0 == "</body>" { put(looks); put(pairs); put(player); put(panels); put(filters); put(test) }
    { print }
    $0 == "<head>" { put(watch) }' "$1"
}

# frame WIDTH PAGE: Chromium makes no window below 500 pixels, but frames of any width.
frame() {
  cat <<HTML
<!DOCTYPE html><title>page test</title><style>body{margin:0}iframe{border:0;width:$1px;height:1000px}</style>
<pre id="result"></pre><iframe src="$2"></iframe>
<script>addEventListener('message', m => { document.getElementById('result').textContent = m.data; });</script>
HTML
}

failed=0
for page in "$@"; do
  with_tests "$page" >"$scratch/page.html"
  for width in 1200 400; do
    frame "$width" page.html >"$scratch/frame.html"
    for scheme in light dark; do
      flags=(--window-size=1250,1100 --virtual-time-budget=120000)
      [ "$scheme" = light ] || flags+=(--blink-settings=preferredColorScheme=0)
      browser "${flags[@]}" --dump-dom "file://$scratch/frame.html" >"$scratch/dom.html" || true
      if grep -q "^page test: $width px, $scheme: [0-9]* passed, 0 failed\$" "$scratch/dom.html"; then
        echo "$page: $(grep '^page test: [0-9]' "$scratch/dom.html")"
      else
        failed=1
        echo "$page, $width px, $scheme: FAILED"
        grep -E '^(FAILED|page test: [0-9])' "$scratch/dom.html" || cat "$scratch/browser.log"
      fi
      if "$here/inputs.py" "$page" "$width" "$scheme" >"$scratch/inputs.log" 2>&1; then
        echo "$page: $(cat "$scratch/inputs.log")"
      else
        failed=1
        echo "$page, $width px, $scheme: FAILED"
        cat "$scratch/inputs.log"
      fi
    done
  done
done
exit $failed
