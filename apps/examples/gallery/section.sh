# A section with hatching
# A plane cuts a hollow ball; what it goes through gets a cap with lines, and the report has the caps' areas.
awk 'function vertex(r, i, j) {
        b = 3.14159265 * i / 24; a = 6.2831853 * j / 48
        return sprintf("v %.5f %.5f %.5f", r * sin(b) * cos(a), r * cos(b), r * sin(b) * sin(a)) }
    BEGIN {
        for (k = 0; k < 2; k++) for (i = 0; i <= 24; i++) for (j = 0; j < 48; j++) print vertex(k ? 0.72 : 1, i, j)
        for (k = 0; k < 2; k++) for (i = 0; i < 24; i++) for (j = 0; j < 48; j++) {
            a = 1 + k * 1200 + i * 48 + j; b = 1 + k * 1200 + i * 48 + (j + 1) % 48
            if (k) print "f", a, a + 48, b + 48, b; else print "f", a, b, b + 48, a + 48 } }' >ball.obj
halflit render ball.obj section.png --section z=20% --section-spacing 0.08 --azimuth 25 --size 480x360 --edges feature --report report.json
