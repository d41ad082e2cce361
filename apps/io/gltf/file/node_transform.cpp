#include "apps/io/gltf/file/node_transform.hpp"

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

Affine node_transform(const file::Transform& transform) {
    if (transform.matrix) return *transform.matrix;
    const double* const q = transform.rotation;
    Affine m = rotation_of(q[0], q[1], q[2], q[3]);
    for (std::size_t j = 0; j < 3; ++j) m.c[j] = m.c[j] * transform.scale[j];
    m.c[3] = {transform.translation[0], transform.translation[1], transform.translation[2]};
    return m;
}

Affine local_transform(const file::File& file, std::size_t node) {
    const int transform = file.nodes[node].transform;
    return transform < 0 ? Affine{} : node_transform(file.transforms[static_cast<std::size_t>(transform)]);
}

}  // namespace halflit::io::detail
