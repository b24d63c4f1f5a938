#!/usr/bin/env bash
# The examples of examples/batch do what they are for. Usage: engines_test.sh SOURCE PROGRAM dask|snakemake|slurm|slurm-node|parallel|xargs
# Exit code 77 and a line that says why: the engine is not installed.
set -euo pipefail
source=$1 program=$2 engine=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export HOME=$folder ORCHARD=$program
skip() { echo "skipped: $1 is not installed"; exit 77; }

# A controller and a node in $folder/slurm, on ports of their own; both end with this script.
start_slurm() {
  mkdir -p "$folder/slurm/state" "$folder/slurm/spool"
  export SLURM_CONF=$folder/slurm/slurm.conf
  cat > "$SLURM_CONF" << END
ClusterName=batch
SlurmctldHost=$(hostname -s)
SlurmctldPort=26817
SlurmdPort=26818
SlurmUser=root
SlurmdUser=root
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
MpiDefault=none
StateSaveLocation=$folder/slurm/state
SlurmdSpoolDir=$folder/slurm/spool
SlurmctldPidFile=$folder/slurm/controller.pid
SlurmdPidFile=$folder/slurm/node.pid
SlurmctldLogFile=$folder/slurm/controller.log
SlurmdLogFile=$folder/slurm/node.log
NodeName=$(hostname -s) CPUs=$(nproc) RealMemory=2000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
END
  slurmctld -D -f "$SLURM_CONF" > /dev/null 2>&1 &
  local controller=$!
  slurmd -D -f "$SLURM_CONF" > /dev/null 2>&1 &
  local node=$!
  # shellcheck disable=SC2064
  trap "kill $controller $node; wait; rm -rf '$folder'" EXIT
  for _ in $(seq 100); do
    [ "$(sinfo -h -o %t 2> /dev/null)" = idle ] && return
    sleep 0.2
  done
  echo "skipped: Slurm does not start here: $(tail -1 "$folder/slurm/node.log")"
  exit 77
}
command=(build --method octree --depth 1 --no-views)

mkdir "$folder/meshes"
for number in 1 2 3 4 5 6 7; do sed "s/^o .*/o copy-$number/" "$source/data/lamp.obj" > "$folder/meshes/lamp-$number.obj"; done
echo garbage > "$folder/meshes/bad.stl"

case $engine in
  dask)
    /usr/bin/python3 -c 'import distributed' 2> /dev/null || skip python3-distributed
    /usr/bin/python3 "$source/examples/batch/dask_shards.py" "$folder/meshes" "$folder/out" --shards 8 --workers 2 --kill-one \
      --orchard "$program" -- "${command[@]}" > "$folder/said" 2> "$folder/errors" || { cat "$folder/said" "$folder/errors" >&2; exit 1; }
    grep -q '^killing the worker' "$folder/said"
    [ "$(grep -c ' meshes of shard ' "$folder/said")" = 8 ]
    ;;
  snakemake)
    command -v snakemake > /dev/null || skip snakemake
    (cd "$folder" && snakemake -s "$source/examples/batch/Snakefile" --cores 2 --quiet all --config "orchard=$program" meshes=meshes out=out \
      chunk=3 "command=${command[*]}" > said 2>&1) || { cat "$folder/said" >&2; exit 1; }
    [ -e "$folder/out/shards/3-of-3.jsonl" ]
    ;;
  slurm)
    # What Slurm sets for each task of an array; two of them at once, as on two nodes.
    for task in 1 2 3; do
      SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_COUNT=3 SLURM_CPUS_PER_TASK=1 SLURM_MEM_PER_NODE=1000 \
        "$source/examples/batch/slurm_array.sh" "$folder/meshes" "$folder/out" "${command[@]}" > "$folder/said-$task" &
    done
    for task in 1 2 3; do wait -n; done
    # One that is sent again finds everything there.
    SLURM_ARRAY_TASK_ID=2 SLURM_ARRAY_TASK_COUNT=1 SHARDS=3 "$source/examples/batch/slurm_array.sh" "$folder/meshes" "$folder/out" "${command[@]}" > "$folder/again"
    grep -q '3 known before' "$folder/again"
    "$program" batch merge "$folder/out" -o "$folder/out/table" --quiet
    ;;
  slurm-node)
    # Slurm itself, as a cluster of this machine alone.
    for word in slurmctld slurmd sbatch munge; do command -v "$word" > /dev/null || skip "$word"; done
    munge -n > /dev/null 2>&1 || { echo "skipped: munged does not run here"; exit 77; }
    [ "$(id -u)" = 0 ] || { echo "skipped: only root can start slurmd"; exit 77; }
    start_slurm
    sbatch --wait --array=1-3 --mem=500M --output "$folder/said-%a" "$source/examples/batch/slurm_array.sh" "$folder/meshes" "$folder/out" \
      "${command[@]}" || { cat "$folder"/said-* "$folder"/slurm/*.log >&2; exit 1; }
    [ "$(cat "$folder"/said-* | grep -c ' meshes of shard ')" = 3 ]
    "$program" batch merge "$folder/out" -o "$folder/out/table" --quiet
    ;;
  parallel | xargs)
    command -v "$engine" > /dev/null || skip "$engine"
    WITH=$engine AT_A_TIME=2 "$source/examples/batch/parallel.sh" "$folder/meshes" "$folder/out" 3 "${command[@]}" > "$folder/said"
    ;;
esac

# A row for each mesh, in order, whatever ran them.
[ "$(wc -l < "$folder/out/table/batch.jsonl")" = 8 ]
grep -c '"status":"solid"' "$folder/out/table/batch.jsonl" | grep -qx 7
head -1 "$folder/out/table/batch.jsonl" | grep -q '"mesh":"bad.stl".*"why":"refused"'
"$program" batch "$folder/meshes" -o "$folder/whole" --quiet -- "${command[@]}"
cmp "$folder/whole/shards/1-of-1.jsonl" "$folder/out/table/batch.jsonl"
