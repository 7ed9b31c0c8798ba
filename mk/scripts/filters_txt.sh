#!/bin/sh
# filters_txt.sh FILE FILTER...: writes the filters of an image to its filters.txt, which is left alone if unchanged; /dev/null: checks the names.
set -eu
file=$1
shift
known=$(sed -n 's/^    X(\([a-z0-9_]*\)).*/\1/p' lib/filters/src/filter.h | tr '\n' ' ')
sets=$(sed -n 's/^FILTERS_\([a-z]*\) *:=.*/\1/p' mk/images.mk | tr '\n' ' ')
sets=${sets% }
for filter in "$@"; do
    case " $known" in
        *" $filter "*) ;;
        *) echo "FILTERS: no filter $filter: choose from ${known% }, or one set: $sets" >&2; exit 2 ;;
    esac
done
[ $# -gt 0 ] || { echo "FILTERS is empty: choose from ${known% }, or one set: $sets" >&2; exit 2; }
twice=$(printf '%s\n' "$@" | sort | uniq -d | tr '\n' ' ')
[ -z "$twice" ] || { echo "FILTERS: named twice: ${twice% }: name it once" >&2; exit 2; }
mkdir -p "$(dirname "$file")"
[ "$(cat "$file" 2> /dev/null)" = "$*" ] || echo "$*" > "$file"
