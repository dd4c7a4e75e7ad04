#!/usr/bin/env bash
# Writes the entries of gmsh's C++ interface as assembly: each jumps to where load_gmsh() has found it.
#   gmsh_entries.sh LIBRARY PROCESSOR
set -euo pipefail
library=$1 processor=$2
case $processor in
  x86_64 | AMD64) jump='jmp *slot_%s(%%rip)\n' ;;
  aarch64 | arm64) jump='adrp x16, slot_%s\nldr x16, [x16, #:lo12:slot_%s]\nbr x16\n' ;;
  *) exit 1 ;;
esac
name=$(readelf -d "$library" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p')
mapfile -t symbols < <(nm -D --defined-only "$library" | awk '$2 == "T" && $3 ~ /^_ZN4gmsh/ { print $3 }')
[[ -n $name ]] && ((${#symbols[@]} > 0))
printf '.text\n'
for s in "${symbols[@]}"; do
  printf '.globl %s\n.hidden %s\n.type %s,%%function\n%s:\n' "$s" "$s" "$s" "$s"
  # shellcheck disable=SC2059 # a format of ours
  printf "${jump//%s/$s}"
done
printf '.section .rodata\n.globl gmsh_library\n.hidden gmsh_library\ngmsh_library: .asciz "%s"\n' "$name"
for s in "${symbols[@]}"; do printf 'name_%s: .asciz "%s"\n' "$s" "$s"; done
printf '.data\n.balign 8\n'
for s in "${symbols[@]}"; do printf 'slot_%s: .quad 0\n' "$s"; done
printf '.section .data.rel.ro,"aw"\n.balign 8\n.globl gmsh_entries\n.hidden gmsh_entries\ngmsh_entries:\n'
for s in "${symbols[@]}"; do printf '.quad name_%s, slot_%s\n' "$s" "$s"; done
printf '.quad 0, 0\n.section .note.GNU-stack,"",%%progbits\n'
