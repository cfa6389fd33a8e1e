#!/bin/sh
# Kills a benchmark of 2,000 cells 20 times at random and lets it go on; its table, but for times,
# and its cells must be those of an undisturbed run. Usage: benchmarks/kill_bench.sh [BATTEN]
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
batten=${1:-$root/build/batten}
suite=$root/experiments/suites/two_thousand.json
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

echo "undisturbed ..."
began=$(date +%s.%N)
"$batten" bench "$suite" --out="$folder/whole" --nofigures --quiet > /dev/null
# Parts of it on average three quarters of a twentieth long, so that the last kill still hits.
part=$(awk -v began="$began" -v now="$(date +%s.%N)" 'BEGIN { print (now - began) / 20 }')

kills=0
while [ "$kills" -lt 20 ]; do
  "$batten" bench "$suite" --out="$folder/killed" --nofigures --quiet > /dev/null 2>&1 &
  pid=$!
  sleep "$(awk -v seed="$kills" -v part="$part" \
    'BEGIN { srand(seed + 20261128); print part * (0.25 + rand()) }')"
  if ! kill -9 "$pid" 2> /dev/null; then
    echo "kill $((kills + 1)) came too late" >&2
    exit 1
  fi
  wait "$pid" 2> /dev/null || true
  kills=$((kills + 1))
  echo "kill $kills: $(wc -l < "$folder/killed/cells.jsonl") lines"
done
"$batten" bench "$suite" --out="$folder/killed" --nofigures --quiet > /dev/null

for run in whole killed; do
  # The last four columns are times.
  awk -F, -v OFS=, '{ NF -= 4; print }' "$folder/$run/table.csv" > "$folder/$run.table"
  sed 's/.*"key":"\([0-9a-f]*\)".*/\1/' "$folder/$run/cells.jsonl" | sort > "$folder/$run.keys"
done
cmp "$folder/whole.table" "$folder/killed.table"
cmp "$folder/whole.keys" "$folder/killed.keys"
[ "$(uniq "$folder/killed.keys" | wc -l)" -eq 2000 ]
[ "$(wc -l < "$folder/killed.keys")" -eq 2000 ]
echo "the same table, 2000 cells, none lost, none twice"
