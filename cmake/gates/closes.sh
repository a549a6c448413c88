#!/usr/bin/env bash
# Proves that a gate closes, and for the right reason.  closes.sh WORDS GATE ARGUMENT...: the gate must
# fail and say WORDS; a missing tool, or another offence, is not what the sample was made for.
set -uo pipefail
words=$1
shift
if said=$("$@" 2>&1); then
  printf 'let pass:\n%s\n' "$said"
  exit 1
fi
if ! grep -qF -- "$words" <<<"$said"; then
  printf 'refused for another reason than "%s":\n%s\n' "$words" "$said"
  exit 1
fi
