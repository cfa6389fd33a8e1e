#!/bin/sh
# A benchmark in 8 parts on the machines of a file, one part at a time on each, then merged:
#   gnu_parallel.sh SUITE.json OUT MACHINES
# MACHINES names one machine a line, as ssh does. All share the folder and have one batten.
set -eu
suite=$1 out=$2 machines=$3
parallel --sshloginfile "$machines" --jobs 1 --workdir "$PWD" \
  batten bench "$suite" --out="${out}_part_{}" --shard={}/8 --nofigures --quiet ::: 1 2 3 4 5 6 7 8
batten merge "$out" "${out}"_part_*
