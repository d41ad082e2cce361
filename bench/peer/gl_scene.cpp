#include "bench/peer/gl_scene.hpp"

#include "bench/peer/labelled_mesh.hpp"
#include "raster/view/projection.hpp"
#include "shading/environment.hpp"
#include "shading/reference/reference.hpp"
#include "shading/reflection_map.hpp"
#include "tests/peer/mesa_program.hpp"

#include <GLES3/gl3.h>

#include <cmath>
#include <cstddef>

namespace halflit::peer {
namespace {

constexpr GLenum kRgba16 = 0x805B;  // GL_RGBA16_EXT of EXT_texture_norm16

/// Vertices as position, normal and, for textured scenes, tangent and coordinates, side by side: those of the mesh, or labelled copies. The
/// codes and labels of copies are in a buffer of their own.
void upload_vertices(const Mesh& mesh, bool textured, const LabelledMesh* labelled) {
    const std::size_t floats = textured ? 12 : 6, count = labelled == nullptr ? mesh.positions.size() : labelled->source.size();
    const std::vector<std::uint32_t>& indices = labelled == nullptr ? mesh.indices : labelled->indices;
    std::vector<float> vertices;
    vertices.reserve(count * floats);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = labelled == nullptr ? k : labelled->source[k];
        const Vec3f p = mesh.positions[i], n = mesh.normals[i];
        vertices.insert(vertices.end(), {p.x, p.y, p.z, n.x, n.y, n.z});
        if (!textured) continue;
        const Vec4f t = mesh.tangents[i];
        vertices.insert(vertices.end(), {t.x, t.y, t.z, t.w, mesh.uv0[i].x, mesh.uv0[i].y});
    }
    GLuint buffers[2];
    glGenBuffers(2, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(float)), vertices.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(), GL_STATIC_DRAW);
    const auto attribute = [&](GLuint location, GLint size, std::size_t first) {
        glEnableVertexAttribArray(location);
        glVertexAttribPointer(location, size, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(floats * sizeof(float)),
                              reinterpret_cast<const void*>(first * sizeof(float)));
    };
    attribute(0, 3, 0);
    attribute(1, 3, 3);
    if (textured) attribute(2, 4, 6), attribute(3, 2, 10);
    if (labelled == nullptr) return;
    struct Labels {
        std::uint32_t code;
        std::uint8_t weights[4];  // 255 for the copy's label
    };
    std::vector<Labels> labels(count);
    for (std::size_t k = 0; k < count; ++k) labels[k].code = labelled->code[k], labels[k].weights[labelled->label[k]] = 255;
    glGenBuffers(1, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(labels.size() * sizeof(Labels)), labels.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(4);
    glVertexAttribIPointer(4, 1, GL_UNSIGNED_INT, sizeof(Labels), nullptr);
    glEnableVertexAttribArray(5);
    glVertexAttribPointer(5, 3, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Labels), reinterpret_cast<const void*>(offsetof(Labels, weights)));
}

std::uint8_t to_8_bits(std::uint16_t value, bool srgb) {
    const double linear = value / 65535.0;
    return static_cast<std::uint8_t>(std::lround(srgb ? shading::reference::srgb_code(linear) : 255 * linear));
}

/// Uploads halflit's own mip levels, so that filtering begins with the same texels.
void upload_texture(const Texture& texture, TextureStorage storage, bool srgb) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    GLint number = 0;
    for (const TextureLevel& level : texture.levels()) {
        const std::size_t count = static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height) * 4;
        const auto texels = texture.data().subspan(static_cast<std::size_t>(level.offset) * 4, count);
        if (storage == TextureStorage::rgba16) {
            glTexImage2D(GL_TEXTURE_2D, number++, kRgba16, level.width, level.height, 0, GL_RGBA, GL_UNSIGNED_SHORT, texels.data());
            continue;
        }
        std::vector<std::uint8_t> bytes(count);
        for (std::size_t i = 0; i < count; ++i) bytes[i] = to_8_bits(texels[i], srgb && i % 4 != 3);
        glTexImage2D(GL_TEXTURE_2D, number++, srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, level.width, level.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     bytes.data());
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

/// Uploads the maps of reflections one below the other, as 16-bit floats, which every driver filters.
void upload_reflections(unsigned program, const Environment& environment, GLint unit) {
    const shading::ReflectionPlan plan(environment.light->reflections(shading::in_turn), environment.light, environment.rotate_rad);
    const shading::ReflectionMap& map = *plan.map;
    const int width = 2 * map.rows[0] + 1;
    float rows[shading::kReflectionLevels], first[shading::kReflectionLevels];
    int height = 0;
    for (int k = 0; k < shading::kReflectionLevels; ++k) {
        rows[k] = static_cast<float>(map.rows[k]), first[k] = static_cast<float>(height);
        height += map.rows[k] + 1;
    }
    GLuint name = 0;
    glGenTextures(1, &name);
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
    for (int k = 0; k < shading::kReflectionLevels; ++k)
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, static_cast<GLint>(first[k]), 2 * map.rows[k] + 1, map.rows[k] + 1, GL_RGBA, GL_FLOAT,
                        map.rgba[static_cast<std::size_t>(map.first[k])].data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glUniform1i(glGetUniformLocation(program, "around_map"), unit);
    glUniform1f(glGetUniformLocation(program, "around_turned"), plan.turned);
    glUniform1fv(glGetUniformLocation(program, "kRows"), shading::kReflectionLevels, rows);
    glUniform1fv(glGetUniformLocation(program, "kFirst"), shading::kReflectionLevels, first);
}

/// The camera's matrix for OpenGL. y is turned over, so that the lowest row of the target is the picture's top. z / w runs from -1 at the
/// near plane to 1.
Mat4 gl_clip_from_world(const Camera& camera, float aspect) {
    Mat4 m = raster::clip_from_world(camera, aspect);
    for (Vec4f& column : m.c) column.y = -column.y, column.z = column.w - 2 * column.z;
    return m;
}

void set_lamps(unsigned program, const Scene& scene) {
    std::vector<Vec3f> positions, colors;
    for (const Light& light : scene.lights) {
        if (light.type != LightType::point) continue;
        positions.push_back(light.position_ws);
        colors.push_back(light.color_linear);
    }
    const auto count = static_cast<GLsizei>(positions.size());
    glUniform3fv(glGetUniformLocation(program, "lamp_position"), count, &positions[0].x);
    glUniform3fv(glGetUniformLocation(program, "lamp_color"), count, &colors[0].x);
}

}  // namespace

bool GlScene::Program::make(const std::string& vertex, const std::string& fragment, std::string& reason) {
    name = linked_program(vertex, fragment, reason);
    clip_from_world = glGetUniformLocation(name, "clip_from_world");
    eye = glGetUniformLocation(name, "eye");
    return name != 0;
}

bool GlScene::make(const BenchScene& bench, const GlSceneOptions& options, GlScene& out, std::string& reason) {
    const Scene& scene = bench.scene;
    const ShaderSources sources = shader_sources(scene, options.outputs, options.shader == PeerShader::special);
    if (!out.program_.make(sources.vertex, sources.fragment, reason)) return false;
    if (!out.depth_program_.make(sources.vertex, sources.depth_fragment, reason)) return false;

    glGenVertexArrays(1, &out.vertex_array_);
    glBindVertexArray(out.vertex_array_);
    const bool textured = !scene.textures.empty();
    if (options.outputs == PeerOutputs::colour) {
        upload_vertices(scene.meshes[0], textured, nullptr);
    } else {
        const LabelledMesh labelled = label_corners(scene.meshes[0]);
        upload_vertices(scene.meshes[0], textured, &labelled);
    }
    out.corner_count_ = static_cast<int>(scene.meshes[0].indices.size());
    if (options.outputs != PeerOutputs::planes) {
        for (std::size_t i = 0; i < scene.textures.size(); ++i) {
            glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + i));
            upload_texture(scene.textures[i], options.storage, i == 0);
        }
        const unsigned program = out.program_.name;
        glUseProgram(program);
        set_lamps(program, scene);
        upload_reflections(program, *scene.environment, 2);
        if (textured) {
            glUniform1i(glGetUniformLocation(program, "base_color_texture"), 0);
            glUniform1i(glGetUniformLocation(program, "normal_texture"), 1);
        }
    }
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR) reason = "OpenGL error " + std::to_string(error);
    return error == GL_NO_ERROR;
}

void GlScene::look(const Camera& camera, float aspect, Vec2f sample) const {
    Mat4 clip_from_world = gl_clip_from_world(camera, aspect);
    for (Vec4f& column : clip_from_world.c) column.x -= sample.x * column.w, column.y -= sample.y * column.w;
    const Vec4f eye = camera.world_from_camera.c[3];
    for (const Program& program : {depth_program_, program_}) {
        glUseProgram(program.name);
        glUniformMatrix4fv(program.clip_from_world, 1, GL_FALSE, &clip_from_world.c[0].x);
        glUniform3f(program.eye, eye.x, eye.y, eye.z);
    }
}

void GlScene::draw(bool depth_first) const {
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glFrontFace(GL_CW);  // y is turned over
    glDisable(GL_DITHER);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glBindVertexArray(vertex_array_);
    const auto draw_all = [&](const Program& program) {
        glUseProgram(program.name);
        glDrawElements(GL_TRIANGLES, corner_count_, GL_UNSIGNED_INT, nullptr);
    };
    if (depth_first) {
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        draw_all(depth_program_);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glDepthMask(GL_FALSE);
        glDepthFunc(GL_EQUAL);
    }
    draw_all(program_);
}

}  // namespace halflit::peer
