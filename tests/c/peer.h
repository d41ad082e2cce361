// Functions of C++ for the test of the C interface: the same pictures by the C++ headers, and two threads.
#ifndef HALFLIT_TESTS_C_PEER_H
#define HALFLIT_TESTS_C_PEER_H

#include <halflit/halflit.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Draws the cube of c_api_test.c, `moves` along x, by the C++ headers, as auto_setup chooses. Returns the hash of its RGBA8 pixels.
uint64_t cube_by_cpp(const float* positions, size_t vertex_count, const uint32_t* indices, size_t index_count, float moves, int32_t width,
                     int32_t height);
/// The same for a file, and for the demo scene if path is null.
uint64_t scene_by_cpp(const char* path, int32_t width, int32_t height);
/// Draws `frames` frames by each of two threads with their own renderers. Returns how many succeeded and have the hash `expected`.
int32_t draw_by_two_threads(const halflit_scene* scene, const halflit_lighting* lighting, const halflit_camera* camera,
                            const halflit_settings* settings, int32_t width, int32_t height, int32_t frames, uint64_t expected);

#ifdef __cplusplus
}
#endif

#endif
