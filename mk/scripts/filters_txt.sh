#!/bin/sh
# filters_txt.sh FILE FILTER...: the filters of an image into its filters.txt, which is left alone when it says so already.
set -eu
file=$1
shift
known=$(sed -n 's/^    X(\([a-z0-9_]*\)).*/\1/p' lib/filters/src/filter.h | tr '\n' ' ')
sets=$(sed -n 's/^FILTERS_\([a-z]*\) *:=.*/\1/p' mk/images.mk | tr '\n' ' ')
sets=${sets% }
for filter in "$@"; do
    case " $known" in
        *" $filter "*) ;;
        *) echo "FILTERS: there is no filter $filter; filters: ${known% }; sets of filters, each to stand alone: $sets" >&2; exit 2 ;;
    esac
done
[ $# -gt 0 ] || { echo "FILTERS is empty; filters: ${known% }; sets of filters: $sets" >&2; exit 2; }
twice=$(printf '%s\n' "$@" | sort | uniq -d | tr '\n' ' ')
[ -z "$twice" ] || { echo "FILTERS: named twice: ${twice% }" >&2; exit 2; }
mkdir -p "$(dirname "$file")"
[ "$(cat "$file" 2> /dev/null)" = "$*" ] || echo "$*" > "$file"
