#!/usr/bin/env bash
# The matrix test: random models (case.lua), each run in many ways. All ways must end with the same bits.
#
#   run.sh PROGRAM FIRST_SEED LAST_SEED [WAYS]
#
# WAYS, separated by spaces; all of them when left out:
#   empty1 empty3 empty40  a callback that does nothing, every so many steps
#   divided                each run in two
#   read files             a callback that reads the model, or writes files and a picture
#   ranks2 ranks3          several processes
#   threads2               two threads
#   baseline avx2          another instruction set than the widest
#   stop stop_ranks2       stopped by a signal in a callback, then resumed; with another number of ranks
#   stranger               a body that touches nothing stands far away: each body ends as it does alone
#   breaking_stranger      the same with a body that is torn there, while it does not shorten the time step
# A difference names seed and way, and is minimised: features that can be left out while the difference stays are named.
set -u
program=$1 first=$2 last=$3
ways=${4:-empty1 empty3 empty40 divided read files ranks2 ranks3 threads2 baseline avx2 stop stop_ranks2 stranger breaking_stranger}
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
features="softening weibull rate zones rigid_floor restitution velocity spin traction flow water waves gas probe relax make_rigid
make_deformable remove gradual moved"

grep -q avx2 /proc/cpuinfo || ways=${ways//avx2/}

run() { # folder, arguments... -> the lines that must not differ
  local folder=$1
  shift
  mkdir -p -- "$folder"
  (cd -- "$folder" && timeout 300 "$program" run "$here/case.lua" --output out "$@") >"$folder/log" 2>&1
  grep -aE '^(MODEL|REFUSED|STATE|ENERGY|BODY|END)' "$folder/log"
}

stopped() { # folder, ranks to resume with, arguments...
  local folder=$1 ranks=$2
  shift 2
  mkdir -p -- "$folder/out"
  (
    cd -- "$folder" || exit
    timeout 300 "$program" run "$here/case.lua" --output out --threads 1 --set way=stop "$@" >log 2>&1 &
    local child=$!
    while kill -0 $child 2>/dev/null; do
      if [[ -e out/stopped_once ]]; then
        kill -INT $child
        break
      fi
      sleep 0.02
    done
    wait $child
    [[ ! -e out/stopped_once ]] || timeout 300 "$program" resume out --threads 1 --ranks "$ranks" >>log 2>&1
  )
  grep -aE '^(MODEL|REFUSED|STATE|ENERGY|END)' "$folder/log"
}

one_way() { # seed, way, folder, more...
  local seed=$1 way=$2 folder=$3
  shift 3
  rm -rf -- "$folder"
  local common=(--set "seed=$seed" "$@")
  case $way in
    plain) run "$folder" --threads 1 "${common[@]}" ;;
    empty*) run "$folder" --threads 1 --set way=empty --set "callback_every=${way#empty}" "${common[@]}" ;;
    read | files | divided) run "$folder" --threads 1 --set "way=$way" "${common[@]}" ;;
    ranks*) run "$folder" --threads 1 --ranks "${way#ranks}" "${common[@]}" ;;
    threads2) run "$folder" --threads 2 "${common[@]}" ;;
    baseline | avx2) CDEM_INSTRUCTION_SET=$way run "$folder" --threads 1 "${common[@]}" ;;
    stop) stopped "$folder" 1 --set "stop_at=$((3 + seed % 30))" "${common[@]}" ;;
    stop_ranks2) stopped "$folder" 2 --set "stop_at=$((2 + seed * 7 % 40))" "${common[@]}" ;;
    *stranger) run "$folder" --threads 1 --set "way=$way" "${common[@]}" ;;
  esac
}

same() { # seed, way, more... : the way gives what the plain one gives
  local seed=$1 way=$2
  shift 2
  one_way "$seed" plain "$work/plain" "$@" >"$work/a"
  one_way "$seed" "$way" "$work/way" "$@" >"$work/b"
  compare "$way"
}

compare() {
  local lines='^(MODEL|REFUSED|STATE|ENERGY|END)' a=$work/a b=$work/b
  [[ $1 != *stranger ]] || lines='^(MODEL|BODY|END)'
  # A stranger as soft as the bodies may shorten the step when it cracks: bodies are compared at equal times.
  if [[ $1 == breaking_stranger ]]; then
    at_times_of "$b" "$work/a" >"$work/a_then"
    at_times_of "$a" "$work/b" >"$work/b_then"
    a=$work/a_then b=$work/b_then
  fi
  # A run that was stopped prints lines again when it goes on: each counts once.
  diff <(grep -E "$lines" "$a" | awk '!seen[$0]++') <(grep -E "$lines" "$b" | awk '!seen[$0]++') \
    >"$work/difference"
}

at_times_of() { # other, file -> its lines without those of bodies at a stage and time that the other does not have
  awk '$1 != "BODY" { if (NR > FNR) print; next } NR == FNR { has[$2, $3]; next } ($2, $3) in has' "$1" "$2"
}

failures=0 cases=0 runs=0
for ((seed = first; seed <= last; ++seed)); do
  one_way "$seed" plain "$work/plain" >"$work/a"
  cases=$((cases + 1))
  if ! grep -q '^END' "$work/a"; then
    printf 'seed %d: the plain run does not end: %s\n' "$seed" "$(tail -n 1 "$work/plain/log")"
    failures=$((failures + 1))
    continue
  fi
  for way in $ways; do
    one_way "$seed" "$way" "$work/way" >"$work/b"
    runs=$((runs + 1))
    if compare "$way"; then continue; fi
    failures=$((failures + 1))
    printf 'seed %d, %s: differs from the plain run: %s\n' "$seed" "$way" "$(head -n 3 "$work/difference" | tr '\n' ' ')"
    if [[ -n ${MINIMISE:-} ]]; then
      without=""
      for feature in $features; do
        if ! same "$seed" "$way" --set "without=${without:+$without,}$feature"; then without=${without:+$without,}$feature; fi
      done
      printf '  still so without %s\n' "${without:-nothing}"
      one_way "$seed" plain "$work/plain" >"$work/a"
    fi
  done
done
printf '%d cases, %d runs beside them, %d differences\n' "$cases" "$runs" "$failures"
((failures == 0))
