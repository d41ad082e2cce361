# A line drawing with hidden edges
# White surfaces, black edges, and dashes for the edges that lie behind; parallel rays, as on a drawing.
awk 'BEGIN {
    n = split("0 0 6 0 6 1 2 1 1 2 1 4 0 4", p, " ") / 2  # the outline of an angle bracket
    for (z = 0; z < 2; z++) for (i = 1; i <= n; i++) print "v", p[2 * i - 1], p[2 * i], 3 * z
    for (i = 1; i <= n; i++) { j = i % n + 1; print "f", i, i + n, j + n, j }
    split("1 2 3 1 3 4 1 4 5 1 5 6 1 6 7", t, " ")
    for (k = 1; k <= 15; k += 3) { print "f", t[k], t[k + 2], t[k + 1]; print "f", t[k] + n, t[k + 1] + n, t[k + 2] + n } }' |
    sed 's/^f \(.*\) \(.*\) \(.*\) \(.*\)/f \4 \3 \2 \1/; s/^f \([0-9]*\) \([0-9]*\) \([0-9]*\)$/f \1 \3 \2/' >bracket.obj
halflit render bracket.obj drawing.png --view iso --ortho --fit 30 --size 480x360 --background white --edges feature --hidden-edges dashed \
    --env none --no-scene-lights --ambient 1,1,1 --ks 0 --tonemap none --exposure 0
