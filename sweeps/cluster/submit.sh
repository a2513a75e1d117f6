#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A map by a Slurm array and a join that waits for it:
#   sh submit.sh SHARDS SPEC MAP.h5 [options of sbatch, such as --cpus-per-task=32 --time=4:00:00 --account=ME]
# The join has the same options, but one processor.
# AGAIN=3,5-7 runs these shards only, as leapmap join names them. LEAPMAP_SWEEP and LEAPMAP_JOIN: more words of leapmap sweep, such
# as --instruction-set=x86-64-v3 (of a build by the preset package), and of leapmap join, such as --virtual.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
shards=$1 spec=$2 map=$3
shift 3
array=$(sbatch --parsable --array="${AGAIN:-1-$shards}" "$@" "$here/shards.sbatch" "$shards" "$spec" "$map")
array=${array%%;*}  # where there are several clusters, which one
join=$(sbatch --parsable --dependency="afterany:$array" "$@" --cpus-per-task=1 "$here/join.sbatch" "$shards" "$map")
echo "array $array of $shards shards, then join $join; squeue shows their progress"
