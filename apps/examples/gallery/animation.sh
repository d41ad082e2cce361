# An animation with a skin
# Frame N shows the pose at N / fps seconds: here two seconds, as the frames of one moving picture.
halflit render "$HALFLIT_ASSETS/models/RiggedSimple/RiggedSimple.glb" --frames 0-23 --fps 12 --size 240x180 --ground -o animation.apng
