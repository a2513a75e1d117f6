#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A map by GNU parallel, on this machine or, with HOSTS=FILE of ssh logins that share the folder, on others:
#   sh parallel.sh SHARDS SPEC MAP.h5 [more words of leapmap sweep]
# Run again, it does what is missing. JOBS: at once on each host (1, as leapmap takes all cores). LEAPMAP_JOIN: more words of
# leapmap join, such as --virtual.
set -eu
shards=$1 spec=$(realpath "$2") map=$(realpath -m "$3")
shift 3
mkdir -p "$(dirname "$map")"
if "${LEAPMAP:-leapmap}" info "$map" > /dev/null 2>&1; then
  exec "${LEAPMAP:-leapmap}" sweep "$spec" -o "$map" --resume "$@"  # says that it is whole already, or of another spec
fi
seq "$shards" | parallel --quote ${HOSTS:+--sshloginfile "$HOSTS" --workdir "$PWD"} --jobs "${JOBS:-1}" --retries 3 --halt soon,fail=1 \
  "${LEAPMAP:-leapmap}" sweep "$spec" -o "$map" --shard "{}/$shards" --resume "$@"
"${LEAPMAP:-leapmap}" join "$map" --shards "$shards" ${LEAPMAP_JOIN:-}
