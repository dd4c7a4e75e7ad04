#!/bin/bash
# Solves the models of some tests by one process and by three: every stage must end with the same hash of its state, and the
# tests hold on every rank.
# usage: ranks.sh TEST_PROGRAM TESTS
set -euo pipefail

program=$1 tests=$2
command -v mpirun > /dev/null || exit 77
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

CDEM_NOTE_HASHES=$folder/one "$program" "$tests" > "$folder/log" || { cat "$folder/log"; exit 1; }
CDEM_NOTE_HASHES=$folder/three mpirun -q --oversubscribe --bind-to none --mca mpi_yield_when_idle 1 -n 3 \
  "$program" "$tests" > "$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
[[ -s $folder/one ]] || { echo "no stage was solved"; exit 1; }
diff "$folder/one" "$folder/three"
echo "$(wc -l < "$folder/one") stages end with the same hashes"
