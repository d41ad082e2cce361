# The same pixels by any number of threads
# Threads, tiles and instruction sets change the time of a frame and nothing else: the hash of the pixels says so.
import halflit

scene = halflit.Scene.demo()
camera = halflit.Camera.orbit(35, 75, 9.5, target=(0, 1.6, 0), fov_y_rad=0.6)
pictures = [
    scene.render((480, 270), camera=camera, threads=threads, tile_size=tile, isa=isa)
    for threads, tile, isa in ((1, 64, "scalar"), (2, 32, "scalar"), (3, 16, "scalar"))
]
pictures.append(scene.render((480, 270), camera=camera))  # all cores, the best instruction set
hashes = {picture.pixel_hash for picture in pictures}
print(hashes)
assert len(hashes) == 1
pictures[0].save("same.png")
