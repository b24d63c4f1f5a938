#!/usr/bin/env bash
# A batch of orchard by GNU parallel, or by xargs where that is not installed: so many shards at a time.
#
#   examples/batch/parallel.sh data out/parallel 16 build --depth 2 --no-views
#
# With GNU parallel the shards may go to other machines that see the same folders: PARALLEL_OPTIONS="--sshlogin a,b,c".
# WITH=xargs takes xargs all the same; AT_A_TIME=8 sets how many run at once (default: as many as there are processors).
set -euo pipefail
meshes=$1 out=$2 shards=$3
shift 3
orchard=${ORCHARD:-orchard}
at_a_time=${AT_A_TIME:-$(nproc)}
run=("$orchard" batch "$meshes" -o "$out" --shard "{}/$shards" --jobs 1 --timeout 600 --resume --quiet -- "$@")
if [ "${WITH:-parallel}" = parallel ] && command -v parallel > /dev/null; then
  # shellcheck disable=SC2086
  seq "$shards" | parallel --quote --jobs "$at_a_time" --retries 2 ${PARALLEL_OPTIONS:-} "${run[@]}"
else
  seq "$shards" | xargs -P "$at_a_time" -I '{}' "${run[@]}"
fi
"$orchard" batch merge "$out" -o "$out/table"
