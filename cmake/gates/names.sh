#!/usr/bin/env bash
# One class of one name: what two files define under one name in one namespace is two things to the compiler and one
# to the linker, which takes whichever it meets first (one-definition rule, [basic.def.odr]).  names.sh ROOT; exit 1
# where there are two. Of the tree's formatted code: a definition in a namespace begins at the line's start.
set -euo pipefail
gates=$(cd "$(dirname "$0")" && pwd)
cd "$1"
files=$("$gates/code_files.sh" .)
# NAMESPACE::NAME FILE, a line for each definition outside unnamed namespaces.
defined=$(xargs awk '
  FNR == 1 { depth = 0 }
  /^namespace( [A-Za-z_0-9:]+)? \{$/ { space[++depth] = NF == 3 ? $2 : "" ; next }
  /^}  \/\/ namespace/ { if (depth > 0) --depth; next }
  /^(class|struct|union|enum|enum class) [A-Za-z_0-9:]+( final)?( : .*)?( :$|[^;]*\{|$)/ {
    for (i = 1; i <= depth; ++i) if (space[i] == "") next
    name = $1 == "enum" && $2 == "class" ? $3 : $2
    whole = ""
    for (i = 1; i <= depth; ++i) whole = whole space[i] "::"
    print whole name, FILENAME
  }' <<<"$files" | sort -u)
if [[ -z $defined ]]; then
  echo "no class under $1: nothing was checked"
  exit 1
fi
twice=$(cut -d' ' -f1 <<<"$defined" | uniq -d)
if [[ -n $twice ]]; then
  while read -r name; do
    echo "$name is defined in" $(awk -v name="$name" '$1 == name { print $2 }' <<<"$defined")
  done <<<"$twice"
  exit 1
fi
echo "$(wc -l <<<"$defined") names of classes, each defined in one file"
