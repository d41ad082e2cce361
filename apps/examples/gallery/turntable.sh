# A turntable
# The camera turns once around a model; the name of the file chooses GIF, APNG or WebP.
model=$HALFLIT_EXAMPLES/knot.glb
for kind in gif apng webp; do
    halflit render "$model" --turntable 18 --size 240x180 --ground -o "turntable.$kind" || echo "this build writes no $kind"
done
