# Under the built-in sky
# Spherical harmonics hold the light of the sky; directions all around tell how much of it reaches a surface.
halflit render "$HALFLIT_EXAMPLES/knot.glb" sky.png --size 480x360 --env sky --background environment --ground --sky-shadows 64
