# A sheet of views with dimensions
# Front, right, top and iso at one scale, as a drawing has them; the report says what each view shows of each part.
halflit look "$HALFLIT_EXAMPLES/knot.glb" --size 320x240 --hidden-edges dashed -o look.png --json look.json
