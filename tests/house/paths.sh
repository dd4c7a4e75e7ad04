#!/usr/bin/env bash
# Paths that comments of C++ and pages name exist: a source by its name or the end of its path, and whatever begins with a
# folder of the tree, with or without its ending. paths.sh ROOT
set -euo pipefail
cd -- "$1"

parts=(libgeom libcdem lua apps tests docs examples cmake)
invented='/power_strength\.|/test_power_strength\.|/columns\.|/test_columns\.|^examples/plate/' # of recipes and examples

{
  find "${parts[@]}" debian | sed 's/^/have /'
  grep -rnE --include='*.[ch]pp' --include='*.inc' '//' "${parts[@]}" | sed -E 's/^([^:]+:[0-9]+):.*\/\//\1 /'
  grep -nE '/|\.[ch]pp' ./*.md docs/*.md libcdem/*.md examples/*/*.md | grep -vE 'CHANGELOG|--full-history' | sed -E 's/^(\.\/)?([^:]+:[0-9]+):/\2 /'
} | awk -v parts="${parts[*]}" -v invented="$invented" '
  BEGIN { split(parts, names, " "); for (i in names) part[names[i]] = 1 }
  $1 == "have" { # every end of the path, with and without its ending
    for (path = $2; path != ""; path = sub(/^[^\/]*\//, "", path) ? path : "") {
      have[path] = 1
      stem = path
      if (sub(/\.[a-z]+$/, "", stem)) have[stem] = 1
    }
    next
  }
  {
    place = $1
    $1 = ""
    while (match($0, /[A-Za-z0-9_.*<>:~$-]*(\/[A-Za-z0-9_.*<>:~$-]*)+|[A-Za-z0-9_-]+\.([ch]pp|inc)/)) {
      path = substr($0, RSTART, RLENGTH)
      $0 = substr($0, RSTART + RLENGTH)
      sub(/^(\.\.\/)+/, "", path)
      sub(/[\/.:-]+$/, "", path)
      if (path ~ /[*<>:~$]/ || path ~ invented || path in have) continue
      first = path
      sub(/\/.*/, "", first)
      if (path ~ /.\.([ch]pp|inc)$/ || (first in part && path ~ /\//)) {
        print place ": names " path ", which is not there"
        found = 1
      }
    }
  }
  END { exit found }'
