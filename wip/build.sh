set -e
cd /work/eq
[ old ] && gcc -std=c11 -O1 -I/work/oldlib old.c /work/oldlib/*.c -o old 
L=/work/laws/lib/filters/src
gcc -std=c11 -O1 -g -fsanitize=undefined,address -fno-sanitize-recover=all $1 -I$L new.c $L/*.c -o new
