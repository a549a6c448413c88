#!/usr/bin/env bash
# Each source file of the host build through clang-tidy (.clang-tidy), and what is no test through clang's
# static analyzer too.  lint.sh BUILD [FILE...]; BUILD holds compile_commands.json; exit 1 if anything is found.
set -euo pipefail
build=$(cd "$1" && pwd)
shift
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
analyzer=clang-analyzer-core.*,clang-analyzer-cplusplus.*,clang-analyzer-deadcode.*,clang-analyzer-unix.*

known=$(sed -n 's/^ *"file": "\(.*\)".*$/\1/p' "$build/compile_commands.json" | sort -u |
  sed -n "s,^$PWD/,,p" | grep -v '^build/')
if (($#)); then
  known=$(printf '%s\n' "$@" | grep -xF "$known") || { echo "lint: the build knows none of these files"; exit 1; }
fi

# Quiet, and one after the other: what a file has to say comes in one piece.
check() {
  local said
  said=$(clang-tidy-14 --quiet -p "$1" "$2" "$3" 2>&1) && return 0
  grep -v 'warnings generated' <<<"$said" || true
  return 1
}
export -f check

failed=0
is_test='/(tests|bench)/'
{ grep -Ev "$is_test" <<<"$known" || true; } |
  xargs -r -P "$(nproc)" -I{} bash -c 'check "$@"' - "$build" "--checks=$analyzer" {} || failed=1
{ grep -E "$is_test" <<<"$known" || true; } |
  xargs -r -P "$(nproc)" -I{} bash -c 'check "$@"' - "$build" --checks= {} || failed=1
((failed == 0)) || exit 1
echo "$(wc -l <<<"$known") files linted"
