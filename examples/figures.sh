#!/usr/bin/env bash
# Checks the figures in the READMEs of the examples against the reports of their runs: figures.sh PROGRAM [--remake] [NAME...].
#
# A README says in comments which runs its figures come from, and which figure of the report a number is:
#
#   <!-- figures: case.lua --set runout=0 -->
#   | factor of safety | 1.203<!-- factor_of_safety --> |       a number that is followed by the name of its figure
#   | error | 0.12<!-- error * 100 --> % |                       shown in another unit
#   | error | 0.12<!-- 2:error --> |                             of the second run of the page; otherwise the last above
#   ![Slip](pictures/slip.png)<!-- slip.png -->                  a picture that the run has drawn
#   <!-- figures of code 0123456789ab -->                        written by this script: the code that gave them
#
# <!-- figures: none --> says that a page has no figures.
#
# Without names it runs nothing and tells which pages hold figures of older code. With names (or `all`) it runs what the
# pages say, into build/figures, and compares every marked number to its last digit; --remake writes those that differ.
# Pictures are copied, unless the page is of this code already.
# figures.sh --mark FOLDER adds a note to the pages of a copy of examples whose figures are older than the code.
set -euo pipefail

root=$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")
results=$root/build/figures

code_of() { # folder of an example -> hash of all that its figures depend on
  (cd -- "$root" && find libgeom libcdem lua "examples/$(basename -- "$1")" -type f \
    '(' -name '*.cpp' -o -name '*.hpp' -o -name '*.inc' -o -name '*.lua' -o -name '*.csv' ')' \
    -not -path 'lua/examples/*' -not -path '*/results/*' -print0 | LC_ALL=C sort -z | xargs -0 sha256sum) | sha256sum | cut -c 1-12
}

stamp_of() { # README -> the code that it says gave its figures
  sed -n 's/^<!-- figures of code \([0-9a-f]*\) -->$/\1/p' "$1" | tail -n 1
}

runs_of() { sed -n 's/^<!-- figures: \(.*\) -->$/\1/p' "$1"; }

pictures_of() { # README -> lines "RUN picture of the run, picture of the page"
  awk '/^<!-- figures: .* -->$/ { ++run }
       { while (match($0, /\(pictures\/[^)]+\)<!-- ([0-9]+:)?[^ ]+ -->/)) {
           split(substr($0, RSTART + 1, RLENGTH - 1), word, /\)<!-- | -->/); $0 = substr($0, RSTART + RLENGTH)
           at = match(word[2], /^[0-9]+:/) ? RLENGTH : 0
           print at ? word[2] + 0 : run, substr(word[2], at + 1), word[1]
         } }' "$1"
}

state_of() { # README -> current, older, none or unmarked
  if [[ -z $(runs_of "$1") ]]; then
    printf unmarked
  elif [[ $(runs_of "$1") == none ]]; then
    printf none
  elif [[ $(stamp_of "$1") == "$(code_of "$(dirname -- "$1")")" ]]; then
    printf current
  else
    printf older
  fi
}

# report.json -> lines "RUN name value"
values_of() {
  awk -v run="$2" '/^ *"name": / { gsub(/^ *"name": "|",?$/, ""); name = $0 }
                   /^ *"value": / { gsub(/^ *"value": |,$/, ""); print run, name, $0 }' "$1"
}

# values README -> README with what the values say; what differs on stderr. 1 as the code if anything does, 2 if a figure is
# missing.
compare() {
  awk -v page="$2" '
    FNR == NR { value[$1 " " $2] = $3; next }
    /^<!-- figures: .* -->$/ { ++run }
    {
      out = ""; rest = $0
      while (match(rest, /[-+]?[0-9][0-9.]*(e[-+]?[0-9]+)?<!-- ([0-9]+:)?[A-Za-z0-9_.]+( \* [0-9.e+-]+)? -->/)) {
        found = substr(rest, RSTART, RLENGTH)
        out = out substr(rest, 1, RSTART - 1); rest = substr(rest, RSTART + RLENGTH)
        shown = substr(found, 1, index(found, "<!--") - 1)
        split(substr(found, index(found, "<!--")), word, " ")
        of = run; name = word[2]; factor = word[3] == "*" ? word[4] : 1
        if (match(name, /^[0-9]+:/)) { of = name + 0; name = substr(name, RLENGTH + 1) }
        if (!((of " " name) in value) || value[of " " name] !~ /^[-+0-9]/) {
          printf "%s:%d: run %d reports no number %s\n", page, FNR, of, name > "/dev/stderr"; missing = 1
          out = out found; continue
        }
        now = value[of " " name] * factor
        exponent = match(shown, /e/) ? substr(shown, RSTART + 1) + 0 : 0
        mantissa = shown; sub(/e.*/, "", mantissa)
        digits = index(mantissa, ".") ? length(mantissa) - index(mantissa, ".") : 0
        unit = 10 ^ (exponent - digits)
        if (now - shown > 0.501 * unit || shown - now > 0.501 * unit) {
          text = shown ~ /e/ ? sprintf("%." digits "e", now) : sprintf("%." digits "f", now)
          sub(/e-0/, "e-", text); sub(/e\+0?/, "e", text)
          printf "%s:%d: %s is %s, the page says %s\n", page, FNR, name, text, shown > "/dev/stderr"; wrong = 1
          shown = text
        }
        out = out shown substr(found, index(found, "<!--"))
      }
      if ($0 !~ /^<!-- figures of code /) print out rest
    }
    END { exit missing ? 2 : wrong }' "$1" "$2"
}

check() { # folder of an example; runs what its page says, unless this code has run it already
  local page=$1/README.md name code number=0 folder script wrong=0 state run from to
  local -a arguments
  name=$(basename -- "$1")
  state=$(state_of "$page")
  case $state in
    none) printf '%s: the page has no figures\n' "$name" && return 0 ;;
    unmarked) printf '%s: the page marks no figures\n' "$name" && return 0 ;;
  esac
  code=$(code_of "$1")
  mkdir -p -- "$results/$name"
  : >"$results/$name/values"
  while IFS= read -r -u 9 line; do
    number=$((number + 1))
    folder=$results/$name/$number
    read -r -a arguments <<<"$line"
    script=${arguments[0]}
    if [[ ! -f $folder/report.json || $(cat -- "$folder/code" 2>/dev/null) != "$code $line" ]]; then
      printf '%s: %s\n' "$name" "$line"
      rm -rf -- "$folder"
      "$program" run "$1/$script" "${arguments[@]:1}" --quiet --output "$folder" </dev/null
      printf '%s %s' "$code" "$line" >"$folder/code"
    fi
    values_of "$folder/report.json" "$number" >>"$results/$name/values"
  done 9< <(runs_of "$page")
  compare "$results/$name/values" "$page" >"$results/$name/README.md" || wrong=$?
  if ((wrong == 2)) || { ((wrong)) && [[ $remake == false ]]; }; then
    printf '%s: figures %s\n' "$name" "$( ((wrong == 2)) && printf 'are missing' || printf 'differ; --remake writes them')"
    return 8
  fi
  while read -r run from to; do
    folder=$results/$name/$run
    if [[ ! -f $folder/$from ]]; then
      printf '%s: run %s draws no picture %s\n' "$name" "$run" "$from" && return 8
    fi
    [[ $remake == false && $state == current ]] || cmp -s -- "$folder/$from" "$1/$to" || cp -- "$folder/$from" "$1/$to"
  done < <(pictures_of "$page")
  printf '<!-- figures of code %s -->\n' "$code" >>"$results/$name/README.md"
  cmp -s -- "$results/$name/README.md" "$page" || cp -- "$results/$name/README.md" "$page"
  printf '%s: %s\n' "$name" "$( ((wrong)) && printf 'figures written' || printf 'figures are those of this code')"
}

mark() { # a copy of examples
  local page note
  for page in "$1"/*/README.md; do
    case $(state_of "$root/examples/$(basename -- "$(dirname -- "$page")")/README.md") in
      current | none) continue ;;
      older) note="The figures of this page come from older code." ;;
      unmarked) note="The figures of this page are not checked by machine and may come from older code." ;;
    esac
    sed -i "0,/^# .*/s//&\n\n*$note*/" "$page"
  done
}

if [[ ${1:-} == --mark ]]; then
  mark "$2"
  exit 0
fi
program=$1
shift
remake=false
names=()
for word; do
  case $word in
    --remake) remake=true ;;
    all) for page in "$root"/examples/*/README.md; do names+=("$(basename -- "$(dirname -- "$page")")"); done ;;
    *)
      [[ -f $root/examples/$word/README.md ]] || { printf 'figures: no example "%s"\n' "$word" >&2 && exit 2; }
      names+=("$word")
      ;;
  esac
done
if ((${#names[@]} == 0)); then
  for page in "$root"/examples/*/README.md; do
    printf '%-22s %s\n' "$(basename -- "$(dirname -- "$page")")" "$(state_of "$page")"
  done
  printf '\nolder: ./cdem figures NAME checks them, with --remake writes them. none: the page has none. %s\n' \
    'unmarked: no number says which figure it is.'
  exit 0
fi
result=0
for name in "${names[@]}"; do check "$root/examples/$name" || result=$?; done
exit "$result"
