# Two versions of a model
# Both are drawn by one camera; the sheet marks the pixels that changed, and the report has the distance of the surfaces.
part() { # RADIUS HEIGHT: a plate of six sides with a round boss of this size on it, as OBJ
    awk -v r="$1" -v h="$2" 'function prism(n, radius, low, high,    i, a, b) {
        for (i = 0; i < n; i++) { a = 6.2831853 * i / n
            printf "v %.5f %.5f %.5f\nv %.5f %.5f %.5f\n", radius * cos(a), low, radius * sin(a), radius * cos(a), high, radius * sin(a) }
        printf "v 0 %.5f 0\nv 0 %.5f 0\n", low, high
        for (i = 0; i < n; i++) { a = first + 2 * i; b = first + 2 * ((i + 1) % n)
            print "f", a, a + 1, b + 1, b; print "f", first + 2 * n, a, b; print "f", first + 2 * n + 1, b + 1, a + 1 }
        first += 2 * n + 2 }
    BEGIN { first = 1; prism(6, 1, 0, 0.3); prism(48, r, 0.3, 0.3 + h) }'
}
part 0.5 0.3 >old.obj
part 0.5 0.6 >new.obj
halflit compare old.obj new.obj -o changes --size 320x240 --markdown comment.md || echo "the versions differ"
