# Two versions of a model
# Both are drawn by one camera; the sheet marks the pixels that changed, and the report has the distance of the surfaces.
part() { # BUMP: a plate with a bump of this height, as OBJ
    awk -v bump="$1" 'BEGIN {
        n = 40
        for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) { x = 2 * i / n - 1; z = 2 * j / n - 1
            r = 1 - 4 * ((x - 0.3) ^ 2 + (z + 0.2) ^ 2); printf "v %.4f %.4f %.4f\n", x, 0.15 * x * x + (r > 0 ? bump * r * r : 0), z }
        for (i = 0; i < n; i++) for (j = 0; j < n; j++) { a = i * (n + 1) + j + 1; print "f", a, a + 1, a + n + 2, a + n + 1 } }'
}
part 0.2 >old.obj
part 0.4 >new.obj
halflit compare old.obj new.obj -o changes --size 320x240 --markdown comment.md || echo "the versions differ"
