# A point cloud
# A PLY file of coloured points keeps its codes; their side follows from the distance between them.
awk 'BEGIN {
    n = 40000
    print "ply\nformat ascii 1.0\nelement vertex " n
    print "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header"
    for (i = 0; i < n; i++) { z = 1 - 2 * (i + 0.5) / n; a = 2.399963 * i; s = sqrt(1 - z * z)  # points of equal distance on a sphere
        x = s * cos(a); y = s * sin(a); r = 1 + 0.18 * sin(5 * x) * sin(5 * y) * sin(5 * z)
        printf "%.4f %.4f %.4f %d %d %d\n", r * x, r * y, r * z, 128 + 100 * x, 400 * (r - 0.85) + 60, 128 + 100 * z } }' >cloud.ply
halflit render cloud.ply cloud.png --size 480x360 --background '#101418'
