#!/usr/bin/env bash
# The version stands in CMakeLists.txt; what other formats need says the same: version.sh SOURCE_FOLDER
set -euo pipefail
cd -- "$1"
version=$(sed -n 's/^project(cdem VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
[[ $version =~ ^[0-9]+\.[0-9]+\.[0-9]+$ ]] || { echo "FAILED: no version in CMakeLists.txt" && exit 1; }
minor=${version%.*}
failed=0
expect() { # what, text, file
  grep -qF -- "$2" "$3" || { echo "FAILED: $3: $1: expected '$2'" && failed=1; }
}
expect "version" "version: $version" CITATION.cff
expect "newest entry" "cdem ($version-" <(head -n 1 debian/changelog)
expect "a section" "## [$version]" CHANGELOG.md
expect "name of the shared libraries' package" "Package: libcdem$minor" debian/control
expect "version asked for" "find_package(cdem $minor REQUIRED)" examples/cpp/CMakeLists.txt
expect "version asked for" "find_package(cdem $minor REQUIRED)" docs/cpp.md
[[ -f debian/libcdem$minor.install ]] || { echo "FAILED: no debian/libcdem$minor.install" && failed=1; }
exit $failed
