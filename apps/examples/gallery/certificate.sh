# A certificate that every triangle was seen
# Views are added until each triangle fills 40 pixels of one of them, or is proven hidden; the report lists the rest.
awk 'BEGIN { # a box without a lid, and a smaller box inside
    for (k = 0; k < 2; k++) for (i = 0; i < 8; i++) {
        s = k ? 0.4 : 1; print "v", s * (i % 2 * 2 - 1), (int(i / 2) % 2 ? (k ? 0 : 1) : -1), s * (int(i / 4) * 2 - 1) }
    split("1 3 4 2 5 6 8 7 1 5 7 3 2 4 8 6 1 2 6 5 3 7 8 4", f, " ")
    for (k = 0; k < 2; k++) for (i = 1; i <= (k ? 24 : 20); i += 4) {
        print "f", f[i] + 8 * k, f[i + 1] + 8 * k, f[i + 2] + 8 * k, f[i + 3] + 8 * k
        if (!k) print "f", f[i + 3], f[i + 2], f[i + 1], f[i] } }' >boxes.obj
halflit look boxes.obj --certify 40 --size 200x160 -o seen.png --json seen.json
