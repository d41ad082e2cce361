# Draft quality, measured by probes
# Some pixels are drawn in full and in cheaper quality; the settings that hold for 95 % of the pixels draw the other frames.
import halflit

scene = halflit.Scene.demo()
found = None
cameras = [halflit.Camera.orbit(angle, 78, 9.5, target=(0, 1.6, 0), fov_y_rad=0.6) for angle in (-20, 0, 20)]
for camera in cameras[::2]:
    found = scene.measure((480, 270), "draft", found, camera=camera)
print(found["percent"], "% of the pixels are within 8 of 255 codes with", found["settings"])
for camera in cameras:
    picture = scene.render((480, 270), camera=camera, **found["settings"])
picture.save("draft.png")
