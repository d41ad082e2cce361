# What made a pixel
# The story of the pixel in the middle of the picture: triangle, material, each light, and what stands in its way.
halflit render demo picture.png --size 480x360
halflit explain demo --size 480x360 --pixel 240,200
