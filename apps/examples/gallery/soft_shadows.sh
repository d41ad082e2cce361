# Soft shadows
# A sun with a radius of four degrees casts shadows that are sharp at the contact and soft far from it.
halflit render "$HALFLIT_EXAMPLES/knot.glb" soft.png --size 480x360 --ground --elevation 35 --zoom 0.8 --background '#cfd6de' --sun-size 4 \
    --light directional:dir=1.2,-1,-0.8:intensity=1.6 --ambient 0.25,0.27,0.3
