"""Draws a cube from arrays through the shared library and prints the picture's hash.   cube.py LIBHALFLIT.so"""
import struct, sys
from ctypes import *

lib = CDLL(sys.argv[1])
lib.halflit_last_error.restype, lib.halflit_pixel_hash.restype = c_char_p, c_uint64
scene, renderer, pixels = c_void_p(), c_void_p(), create_string_buffer(320 * 240 * 4)
camera, settings = create_string_buffer(1024), create_string_buffer(1024)  # larger than any version's struct


def call(name, *arguments):
    if getattr(lib, "halflit_" + name)(*arguments):
        sys.exit(lib.halflit_last_error().decode())


corners = (c_float * 24)(*[2 * (i >> k & 1) - 1 for i in range(8) for k in range(3)])
indices = (c_uint32 * 36)(0,2,1, 1,2,3, 4,5,6, 5,7,6, 0,4,2, 2,4,6, 1,3,5, 3,7,5, 0,1,4, 1,5,4, 2,6,3, 3,6,7)
call("scene_create", byref(scene))
call("scene_add_mesh", scene, struct.pack("N8P2N2i", 96, 0, addressof(corners), 0, 0, 0, 0, 0, addressof(indices), 8, 36, -1, 0), None)
call("scene_add_instance", scene, 0, None, None)
call("camera_init", camera, c_size_t(1024))
call("settings_init", settings, c_size_t(1024))
call("auto_setup", scene, 320, 240, camera, settings)
call("renderer_create", None, byref(renderer))
call("render", renderer, scene, camera, settings, struct.pack("NP9N4i", 104, addressof(pixels), *[0] * 9, 320, 240, 0, 0), None)
print(f"{lib.halflit_pixel_hash(pixels, c_size_t(len(pixels))):016x}")
