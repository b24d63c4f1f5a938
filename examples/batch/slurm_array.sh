#!/usr/bin/env bash
# A batch of orchard as an array of Slurm: each task takes its shard.
#
#   orchard batch data --cost --shard 1/100 -- build --depth 2 --no-views     # says what to write into the lines below
#   sbatch examples/batch/slurm_array.sh data out/slurm build --depth 2 --no-views
#   orchard batch merge out/slurm -o out/slurm/table                          # when all tasks have ended
#
# A task that was killed is sent again by SHARDS=100 sbatch --array=17 .. with the same words, and does what is missing.
#SBATCH --array=1-100
#SBATCH --cpus-per-task=1
#SBATCH --time=01:00:00
#SBATCH --mem=1000M
set -euo pipefail
meshes=$1 out=$2
shift 2
# The numbers of the array that was sent first; a single task that is sent again must keep to them.
count=${SHARDS:-$SLURM_ARRAY_TASK_COUNT}
# Slurm kills what exceeds the task's memory, and with it the whole shard: a mesh gets nine tenths of it and costs a row.
memory=()
if [ -n "${SLURM_MEM_PER_NODE:-}" ]; then
  memory=(--memory $((SLURM_MEM_PER_NODE * 9 / 10 / ${SLURM_CPUS_PER_TASK:-1})))
fi
exec "${ORCHARD:-orchard}" batch "$meshes" -o "$out" --shard "$SLURM_ARRAY_TASK_ID/$count" \
  --jobs "${SLURM_CPUS_PER_TASK:-1}" --timeout 600 "${memory[@]}" --resume -- "$@"
