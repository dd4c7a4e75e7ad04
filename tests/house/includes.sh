#!/usr/bin/env bash
# The laws of includes: libgeom <- libcdem <- lua <- apps one way, no cycle among the folders of a part, and headers
# that show the standard library and Eigen only.
#   includes.sh ROOT RULE        RULE: one_way, no_cycles, plain_headers
set -euo pipefail
cd -- "$1"

quoted() { # paths... -> "file header" for each #include "header"
  grep -rE --include='*.[ch]pp' '^ *#include +"' "$@" | sed -E 's/^([^:]+): *#include +"([^"]+)".*/\1 \2/'
}

one_way() {
  quoted libgeom libcdem lua apps | awk '
    BEGIN { level["libgeom"] = 1; level["libcdem"] = 2; level["lua"] = 3; level["apps"] = 4; level["tests"] = 5 }
    { split($1, file, "/"); split($2, header, "/") }
    level[header[1]] > level[file[1]] { print $1 ": includes " $2; found = 1 }
    END { exit found }' || {
    printf 'libgeom <- libcdem <- lua <- apps: a part includes itself and the ones before it only\n'
    return 1
  }
}

no_cycles() { # files that lie in a part itself count as one more folder
  local part failed=0
  for part in libgeom libcdem lua/binding apps/cdem; do
    no_cycle_in "$part" || failed=1
  done
  return $failed
}

no_cycle_in() { # part
  local includes cycle
  includes=$(quoted "$1" | awk -v part="$1/" '
    function folder(path, parts) { return split(substr(path, length(part) + 1), parts, "/") > 1 ? parts[1] : "." }
    index($2, part) == 1 && folder($1) != folder($2) { print folder($1), folder($2), $1, $2 }')
  # tsort names the folders of a cycle, each on a line of its own: each includes the next, the last the first.
  cycle=$(cut -d ' ' -f 1,2 <<<"$includes" | sort -u | tsort 2>&1 >/dev/null | awk '
    /contains a loop/ { if (++loops > 1) exit; next }
    { print $2 }') || true
  [[ -n $cycle ]] || return 0
  printf 'folders of %s include each other in a cycle:\n' "$1"
  awk 'NR == FNR { folders[++n] = $1; next }
       { for (i = 1; i <= n; ++i)
           if ($1 == folders[i] && $2 == folders[i % n + 1])
             print "  " $1 " -> " $2 ": " $3 " includes " $4 }' \
    <(printf '%s\n' "$cycle") <(sort <<<"$includes")
  return 1
}

plain_headers() { # a header of the standard library has neither a dot nor a slash in its name
  if grep -rnE --include='*.hpp' '^ *#include +<[^>]*[./]' libgeom libcdem lua apps | grep -vE '<Eigen/'; then
    printf 'the header of a third party stays in the .cpp that wraps it\n'
    return 1
  fi
}

case ${2:-} in
  one_way | no_cycles | plain_headers) "$2" ;;
  *)
    printf 'usage: includes.sh ROOT one_way|no_cycles|plain_headers\n' >&2
    exit 2
    ;;
esac
