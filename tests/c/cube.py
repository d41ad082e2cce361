"""Draws a cube from arrays through the shared library and prints the picture's hash.   cube.py LIBHALFLIT.so"""
import struct, sys
from ctypes import *

lib = CDLL(sys.argv[1])
lib.halflit_last_error.restype, lib.halflit_pixel_hash.restype = c_char_p, c_uint64
scene, renderer, lighting, pixels = c_void_p(), c_void_p(), c_void_p(), create_string_buffer(320 * 240 * 4)
camera, settings, request = (create_string_buffer(1024) for _ in range(3))  # larger than any version's struct


def call(name, *arguments):
    if getattr(lib, "halflit_" + name)(*arguments):
        sys.exit(lib.halflit_last_error().decode())


corners = (c_float * 24)(*[2 * (i >> k & 1) - 1 for i in range(8) for k in range(3)])
indices = (c_uint32 * 36)(0,2,1, 1,2,3, 4,5,6, 5,7,6, 0,4,2, 2,4,6, 1,3,5, 3,7,5, 0,1,4, 1,5,4, 2,6,3, 3,6,7)
call("scene_create", byref(scene))
call("scene_add_mesh", scene, struct.pack("N8P2N4i", 104, 0, addressof(corners), 0, 0, 0, 0, 0, addressof(indices), 8, 36, -1, 0, 0, 0), None)
call("scene_add_instance", scene, 0, None, None)
call("camera_init", camera, c_size_t(1024))
call("settings_init", settings, c_size_t(1024))
call("picture_request_init", request, c_size_t(1024))
struct.pack_into("2i", request, 32, 320, 240)
call("choose_picture", scene, request, None, camera, settings, byref(lighting))
call("renderer_create", None, byref(renderer))
call("render", renderer, scene, lighting, camera, settings, struct.pack("N4iP17N", 168, 320, 240, 0, 0, addressof(pixels), *[0] * 17), None)
print(f"{lib.halflit_pixel_hash(pixels, c_size_t(len(pixels))):016x}")
