# Parts inside of a model
# The wheels are highlighted, and the truck becomes a ghost through which they are seen.
halflit render "$HALFLIT_ASSETS/models/CesiumMilkTruck/CesiumMilkTruck.glb" wheels.png --ghost '*' --highlight 'Wheels*' --size 480x360
