# Thumbnails of a folder
# One call draws a picture for each model of a folder, and another one a sheet with all of them and their names.
mkdir models
solid() { # NAME SIDES TOP: a prism or, with TOP 0, a pyramid, as OBJ
    awk -v n="$2" -v top="$3" 'BEGIN {
        for (i = 0; i < n; i++) { a = 6.283185 * i / n; c = cos(a); s = sin(a)
            printf "v %.5f -1 %.5f\nv %.5f 1 %.5f\n", c, -s, top * c, -top * s }
        print "v 0 -1 0\nv 0 1 0"
        for (i = 0; i < n; i++) { a = 2 * i + 1; b = 2 * ((i + 1) % n) + 1
            print "f", a, b, b + 1, a + 1; print "f", 2 * n + 1, b, a; print "f", 2 * n + 2, a + 1, b + 1 } }' >"models/$1.obj"
}
solid pyramid 4 0.001
solid cube 4 1
solid hexagon 6 1
solid bucket 24 1.4
solid cone 48 0.001
cp "$HALFLIT_EXAMPLES/knot.glb" models
halflit render models/* --out-dir thumbnails --size 160x120
halflit sheet models/* --size 200x150 -o sheet.png
