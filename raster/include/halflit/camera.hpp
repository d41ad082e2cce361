// Cameras. A camera sits at the origin of its own space, looks along -z, with +x to the right and +y up (glTF).
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/math.hpp"
#include "halflit/mesh.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit {

struct Scene;

/// The four sides of a picture, seen from the camera: tangents of the angles from its axis (perspective), or distances from it in world
/// units (orthographic). The axis need not meet the middle of the picture, nor the picture at all.
struct ViewSides {
    float left = -1, right = 1, bottom = -1, top = 1;  ///< left < right, bottom < top
    friend bool operator==(const ViewSides&, const ViewSides&) = default;
};

/// Calibration of a lens without distortion, in pixels of a picture of width x height: u = fx x / z + cx, v = fy y / z + cy,
/// with x to the right, y down and z ahead.
struct Intrinsics {
    double fx = 0, fy = 0;      ///< focal lengths, above 0
    double cx = 0, cy = 0;      ///< where the axis meets the picture
    int width = 0, height = 0;  ///< of the picture
    /// u and v in the middle of the upper left pixel: 0 for OpenCV, 0.5 for COLMAP and wherever pixels have their corners at whole numbers
    double first_pixel = 0;
};

/// A view of the world. Distances are world units; completed() chooses what is left to the scene.
struct Camera {
    std::string name;                ///< for messages and choices; may be empty
    Mat4 world_from_camera;          ///< rigid: rotation and translation, as look_at() makes
    bool orthographic = false;       ///< parallel rays; otherwise perspective
    float fov_y_rad = 0.785398163f;  ///< perspective: full vertical angle, in (0, pi)
    float aspect = 0.0f;             ///< perspective: width / height that the view is made for; 0: that of the picture
    float half_height = 1.0f;        ///< orthographic: half the height of the view, world units
    float half_width = 0.0f;         ///< orthographic: half its width; 0: from the picture's aspect
    float near_z = 0.0f;  ///< distance along -z, world units, from which on things are drawn; perspective: 0: chosen by the scene
    float far_z = 0.0f;   ///< distance up to which they are drawn; one that is not above near_z: no limit
    /// in place of fov_y_rad, aspect, half_height and half_width: the picture's sides, whatever its aspect, so pixels need not be square
    std::optional<ViewSides> sides{};

    /// Width / height that the view is made for; 0: any.
    [[nodiscard]] HALFLIT_API float made_for_aspect() const;
    /// A camera of computer vision: a point X of the world is at R X + t in the camera's space, x to the right, y down and z ahead.
    /// rotation: R, row by row. Each number of the camera is rounded once. Fails (usage) for intrinsics that are no lens, and for an R that
    /// is no rotation or mirrors: then two of its axes are usually swapped, or one has the wrong sign.
    [[nodiscard]] HALFLIT_API static Result<Camera> from_intrinsics(const Intrinsics& lens, const std::array<double, 9>& rotation,
                                                                    const std::array<double, 3>& translation);
    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Direction and lens of a framing camera.
struct ViewSettings {
    float azimuth_deg = 35.0f;    ///< around `up`; 0: seen from +z; positive: from the right
    float elevation_deg = 20.0f;  ///< above the horizon
    float zoom = 1.0f;            ///< 2 makes things twice as large
    float fov_y_deg = 35.0f;      ///< full vertical angle before the zoom
    bool orthographic = false;    ///< parallel rays: no perspective, and no fov_y_deg
    /// Far enough for every direction: the scene is seen from all sides at one distance and, by parallel rays, at one scale, with the
    /// middle of its box in the middle of the picture. Otherwise the view is as near as its own direction allows.
    bool any_side = false;
    double margin_x = 0.13, margin_y = 0.13;  ///< shares of half the picture's width and height that stay free at each side, in [0, 0.9]
    friend bool operator==(const ViewSettings&, const ViewSettings&) = default;
};

/// A direction to look from.
struct NamedView {
    std::string_view name;             ///< a lower-case word
    float azimuth_deg, elevation_deg;  ///< as in ViewSettings
};

/// The views of a technical drawing. `iso` sees a cube's three edges at equal angles: its elevation is the arc tangent of 1 / sqrt(2).
inline constexpr NamedView kNamedViews[] = {{"front", 0, 0}, {"back", 180, 0},   {"left", -90, 0},         {"right", 90, 0},
                                            {"top", 0, 90},  {"bottom", 0, -90}, {"iso", 45, 35.26438968f}};

/// Place of a camera (Camera::world_from_camera) at a distance from `target`, which it looks at. The angles are those of ViewSettings. From
/// straight above or below, the picture's up is that of nearby elevations. Angles that are not finite count as 0.
[[nodiscard]] HALFLIT_API Mat4 orbit(Vec3d target, double azimuth_deg, double elevation_deg, double distance);

/// The camera with what it leaves to the scene, whose box is `scene`: the near plane of a perspective camera whose near_z is 0 is half way
/// to the nearest corner of the box, or if that is more 1e-4 of the scene's size, but at most a quarter of the distance to the box; 0.1 for
/// an empty box. Frames are drawn by it.
[[nodiscard]] HALFLIT_API Camera completed(Camera camera, const Bounds& scene);

/// Fails (usage) for a camera whose world_from_camera mirrors, or whose sides are not in order: it would show things inside out.
[[nodiscard]] HALFLIT_API Result<void> check_camera(const Camera& camera);

/// Camera that sees all of `bounds` at the given aspect ratio, by default in a three-quarter view. In the tighter direction the
/// eight corners leave a margin of 13 % of the half picture. zoom changes the field of view, not the position. Empty bounds are
/// framed as a unit cube at the origin, a point as a small box. Angles that are not finite count as 0, the zoom as 1, the field of view as
/// 45 degrees.
[[nodiscard]] HALFLIT_API Camera frame_bounds(const Bounds& bounds, float aspect, const ViewSettings& view);

/// The same, but fitted to the vertices: tight and centred for any shape. Seen from above in perspective, with the usual margins, it has
/// room below for the contact shadow.
[[nodiscard]] HALFLIT_API Camera frame_scene(const Scene& scene, float aspect, const ViewSettings& view = {});
/// The same. bounds: scene_bounds(scene).
[[nodiscard]] HALFLIT_API Camera frame_scene(const Scene& scene, const Bounds& bounds, float aspect, const ViewSettings& view);
/// frame_scene() for each of several views: what is framed is found once.
[[nodiscard]] HALFLIT_API std::vector<Camera> frame_each(const Scene& scene, const Bounds& bounds, float aspect,
                                                         std::span<const ViewSettings> views);

/// Several views of one scene that can be compared: all have the middle of its box in the middle of the picture, and one distance and, by
/// parallel rays, one scale, which are the least that show the scene whole in each of them. Of the views, field of view, zoom, margin and
/// `orthographic` should be equal. bounds: scene_bounds(scene).
[[nodiscard]] HALFLIT_API std::vector<Camera> frame_views(const Scene& scene, const Bounds& bounds, float aspect,
                                                          std::span<const ViewSettings> views);

/// False if the camera shows nothing of the scene: all triangles, lines and points lie outside of its view, or turn a side to it that is
/// not drawn. Ends at the first one that it shows, so it is quick in all but odd scenes.
[[nodiscard]] HALFLIT_API bool shows_surface(const Scene& scene, const Camera& camera, float aspect);
/// Reason for which choose_view() takes a view.
enum class ViewReason : std::uint8_t {
    given,   ///< it was asked for
    usual,   ///< nothing speaks for another
    flat,    ///< most of the surface faces up or down: from farther above
    hollow,  ///< holes or pockets are open at the top: from farther above
    thin,    ///< upright and thin: nearly from the side that most of the surface faces
    backs    ///< from the usual side only backs are seen, which are not drawn
};

/// A view of a whole scene, and the camera that frame_scene() makes of it.
struct FramedView {
    ViewSettings view;                      ///< its direction, and how it is fitted
    Camera camera;                          ///< that shows the scene whole
    ViewReason reason = ViewReason::given;  ///< for the view
};

/// The view of a scene without a camera: `view`, or with the usual angles, one that suits the scene's shape, counted from the side that the
/// scene faces (Scene::faces_back): flat things and those that are hollow at the top from farther above, thin upright ones from the front.
/// It depends on the geometry alone and without jumps, so like scenes get like views. Where frame_scene() would show nothing by it, the
/// same from behind, from below, or from behind and below, whichever is the first that shows something. Seen from above in perspective,
/// with the usual margins, the scene is moved up and shown up to 6 % smaller where its contact shadow (Settings::contact_shadow) would
/// reach the picture's border. bounds: scene_bounds(scene).
[[nodiscard]] HALFLIT_API FramedView choose_view(const Scene& scene, const Bounds& bounds, float aspect, const ViewSettings& view);

}  // namespace halflit
