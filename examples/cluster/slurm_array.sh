#!/bin/sh
# A benchmark as a Slurm array of 8 parts: sbatch slurm_array.sh SUITE.json OUT
# One cell at a time and a node to itself, so that times mean something. A part that is cut off goes
# on when it is submitted again. When all have ended: batten merge OUT OUT_part_*
#SBATCH --array=1-8
#SBATCH --cpus-per-task=1
#SBATCH --exclusive
#SBATCH --time=04:00:00
set -eu
batten bench "$1" --out="$2_part_$SLURM_ARRAY_TASK_ID" \
  --shard="$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --nofigures --quiet
