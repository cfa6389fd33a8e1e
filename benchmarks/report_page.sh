#!/usr/bin/env bash
# How large the report of 2,000 cells is and how long headless Chromium takes to open it.
#   benchmarks/report_page.sh [BATTEN]      needs python3 and chromium (tools/setup.sh page)
# Prints seconds from the start of the navigation until the first plots stand (the page's own clock,
# median of 5) and fails beyond 2 s or 20 MB.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
batten=${1:-build/batten}
most_seconds=2.0 most_bytes=20000000

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
python3 benchmarks/report_folder.py "$scratch/results"
"$batten" report "$scratch/results" --out="$scratch/report.html"
bytes=$(stat -c %s "$scratch/report.html")

# Real time, hence no --virtual-time-budget and no --dump-dom, which does not wait for the plots: the
# page says on the console when they stand, and is closed then.
awk '$0 == "</body>" {
  print "<script>(async () => {"
  print "  await new Promise(done => requestAnimationFrame(() => setTimeout(done, 0)));"
  print "  await Promise.all(allPlots.map(plot => plot.isDone));"
  print "  console.log(`opened in ${(performance.now() / 1000).toFixed(3)} s`);"
  print "})();</script>" } { print }' "$scratch/report.html" >"$scratch/timed.html"
for run in 1 2 3 4 5; do
  chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --window-size=1200,1000 \
    --user-data-dir="$scratch/profile" --no-first-run --enable-logging=stderr \
    "file://$scratch/timed.html" >"$scratch/log" 2>&1 &
  for _ in $(seq 300); do
    ! grep -q 'opened in' "$scratch/log" || break
    sleep 0.1
  done
  kill $! 2>/dev/null || true
  wait
  sed -n 's/.*opened in \([0-9.]*\) s.*/\1/p' "$scratch/log" | head -n 1
done >"$scratch/seconds"
seconds=$(sort -n "$scratch/seconds" | sed -n 3p)
echo "2,000 cells: $bytes bytes (allowed $most_bytes), opened in ${seconds:-no} s (allowed $most_seconds)"
awk -v s="${seconds:-99}" -v b="$bytes" -v ms="$most_seconds" -v mb="$most_bytes" \
  'BEGIN { exit !(s <= ms && b <= mb) }'
