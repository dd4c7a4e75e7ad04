#!/usr/bin/env bash
# Laws of examples/figures.sh: a number that differs from the report in its last digit is found and can be written again, one
# that agrees stays as it is written, and a number or picture may name its run. figures.sh ROOT FOLDER
set -euo pipefail

folder=$2
mkdir -p -- "$folder"
# shellcheck disable=SC1090 # the function as it stands in the script
source <(sed -n '/^compare()/,/^}/p; /^pictures_of()/,/^}/p' "$1/examples/figures.sh")

cat >"$folder/values" <<'TEXT'
1 force 1234.56
1 error 7.53e-09
2 force 99.5
TEXT
page() { # the second number of its first row
  printf '<!-- figures: a.lua -->\n| %s<!-- force --> kN, %s<!-- force * 0.001 -->, %s<!-- error --> |\n' 1235 "$1" 7.5e-9
  printf '<!-- figures: b.lua -->\nforce 99.5<!-- force -->, %s<!-- 1:force -->\n' 1235
  printf '| ![A](pictures/a.png)<!-- 1:runs/1/a.png --> | ![B](pictures/b.png)<!-- b.png --> | ![C](pictures/c.png) |\n'
}

page 1.23 >"$folder/right.md"
compare "$folder/values" "$folder/right.md" >"$folder/out.md" || { echo "a page that agrees was refused" && exit 1; }
cmp -- "$folder/out.md" "$folder/right.md"

page 1.24 >"$folder/wrong.md"
if compare "$folder/values" "$folder/wrong.md" >"$folder/out.md" 2>"$folder/told"; then
  echo "a figure that differs was not found" && exit 1
fi
cmp -- "$folder/out.md" "$folder/right.md"
grep -q 'wrong.md:2: force is 1.23, the page says 1.24' "$folder/told"

[[ $(pictures_of "$folder/right.md") == $'1 runs/1/a.png pictures/a.png\n2 b.png pictures/b.png' ]] ||
  { echo "pictures are not found" && exit 1; }

sed 's/<!-- force -->/<!-- farce -->/' "$folder/right.md" >"$folder/unknown.md"
if compare "$folder/values" "$folder/unknown.md" >/dev/null 2>"$folder/told"; then
  echo "a figure that no report has was not found" && exit 1
fi
grep -q 'reports no number farce' "$folder/told"
