#include "apps/io/detail/gltf_node_transform.hpp"

namespace halflit::io::detail {

namespace {

Affine rotation_of(double x, double y, double z, double w) {
    const double length2 = ((x * x + y * y) + z * z) + w * w;
    if (!(length2 > 1e-200 && length2 < 1e200)) return {};
    const double s = 2.0 / length2;
    return {{{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
             {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
             {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)},
             {0, 0, 0}}};
}

}  // namespace

Affine node_transform(std::span<const double> matrix, std::span<const double> translation, std::span<const double> rotation,
                      std::span<const double> scale) {
    Affine m;
    if (!matrix.empty()) {  // the last row of an affine transform is 0 0 0 1
        for (std::size_t j = 0; j < 4; ++j) m.c[j] = {matrix[4 * j], matrix[4 * j + 1], matrix[4 * j + 2]};
        return m;
    }
    if (!rotation.empty()) m = rotation_of(rotation[0], rotation[1], rotation[2], rotation[3]);
    if (!scale.empty())
        for (std::size_t j = 0; j < 3; ++j) m.c[j] = m.c[j] * scale[j];
    if (!translation.empty()) m.c[3] = {translation[0], translation[1], translation[2]};
    return m;
}

}  // namespace halflit::io::detail
