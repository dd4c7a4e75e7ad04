#!/usr/bin/env bash
# Builds the site: build.sh ROOT. Stages the pages in build/site-source, adds the gallery and KaTeX, calls mkdocs.
set -euo pipefail

root=$1
staged=$root/build/site-source
katex=/usr/share/javascript/katex

# `title README.md`: the text of its first heading.
title() { sed -n 's/^# *//p' "$1" | head -n 1; }

# Copies what pages show or link to. Scripts are linked to, so they go along as text.
stage_pages() {
  rm -rf -- "$staged"
  mkdir -p -- "$staged"
  (cd -- "$root" && cp --parents -r -- docs examples README.md CHANGELOG.md CONTRIBUTING.md LICENSE CITATION.cff "$staged")
  (cd -- "$root" && find libgeom libcdem lua apps tests '(' -name '*.md' -o -name '*.hpp' ')' -exec cp --parents -t "$staged" {} +)
  rm -rf -- "$staged/docs/mkdocs.yml" "$staged/docs/site/build.sh" "$staged/docs/site/overrides" "$staged/docs/paper"
  # A checkout may hold results that somebody wrote beside an example.
  rm -rf -- "$staged"/examples/*/results
}

stage_katex() {
  mkdir -p -- "$staged/katex/contrib"
  cp -rL -- "$katex/katex.js" "$katex/katex.css" "$katex/fonts" "$staged/katex/"
  cp -L -- "$katex/contrib/auto-render.js" "$staged/katex/contrib/"
}

# Every picture that an example's README shows, under the example's name: ![words](pictures/name.png)
write_gallery() {
  printf '# Gallery\n\nEvery picture is drawn by the example it stands under. A click leads to the example.\n'
  local folder name
  for folder in "$root"/examples/*/; do
    [[ -f $folder/README.md ]] || continue
    name=$(basename -- "$folder")
    tr '\n' ' ' <"$folder/README.md" | grep -q '](pictures/' || continue
    printf '\n## %s\n\n<div class="gallery" markdown>\n' "$(title "$folder/README.md")"
    # The words of a picture may run over a line break.
    tr '\n' ' ' <"$folder/README.md" | grep -oE '!\[[^]]*\]\(pictures/[^)]+\)' |
      sed -E "s|^!\[([^]]*)\]\(([^)]+)\)|[![\1](examples/$name/\2)<span>\1</span>](examples/$name/README.md)|"
    printf '</div>\n'
  done
}

# The navigation's line "- EXAMPLES" becomes one line for each example, by title.
write_configuration() {
  local line folder name
  while IFS= read -r line; do
    if [[ $line == *"- EXAMPLES" ]]; then
      for folder in "$root"/examples/*/; do
        [[ -f $folder/README.md ]] || continue
        name=$(basename -- "$folder")
        printf '      - "%s": examples/%s/README.md\n' "$(title "$folder/README.md")" "$name"
      done
    else
      printf '%s\n' "$line"
    fi
  done <"$root/docs/mkdocs.yml" | sed -E 's|^(docs_dir: ).*|\1site-source|; s|^(site_dir: ).*|\1site|; s|^(  custom_dir: )|\1../docs/|'
}

stage_pages
bash "$root/examples/figures.sh" --mark "$staged/examples"
stage_katex
write_gallery >"$staged/gallery.md"
write_configuration >"$root/build/mkdocs.yml"
mkdocs build --quiet --strict --clean --config-file "$root/build/mkdocs.yml"
# The search index once more as a script, for pages opened from the disk.
index=$root/build/site/search/search_index
{ printf 'var __search = { index: Promise.resolve(' && cat "$index.json" && printf ') }\n'; } >"$index.js"
