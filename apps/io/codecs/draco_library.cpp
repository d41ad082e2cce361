// The part of Draco meshes that calls the library. What it uses of halflit is in headers, so that it can lie in a module.
#include "apps/io/codecs/codec_libraries.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <optional>

#if HALFLIT_HAS_DRACO
#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

namespace halflit::io::detail {

namespace {

constexpr int kMaxAttributes = 32;  // each costs tables of some megabytes while it is decoded

/// Memory that a decoder may take, from counts that the stream tells before the library allocates for them.
struct Allowance {
    std::uint64_t bytes = 0;
    std::optional<Error> error;

    bool holds(std::uint64_t wanted) {
        if (wanted <= bytes) return true;
        error = Error{ErrorCode::limit, fmt::format("Draco: decoding would take {} MB, the limit is {} MB", wanted >> 20, bytes >> 20)};
        return false;
    }
};

/// A decoder of the library that looks at counts before it decodes what they count.
template <class Decoder>
class Guarded : public Decoder {
public:
    explicit Guarded(Allowance& allowance) : allowance_(allowance) {}

protected:
    bool DecodeConnectivity() override {
        constexpr std::uint64_t kBytesPerFace = 64, kBytesPerFaceOfAttribute = 40;  // corner tables, and maps of vertices
        draco::DecoderBuffer ahead = *this->buffer();
        std::uint32_t vertices = 0, faces = 0;
        std::uint8_t attribute_data = 0;
        if constexpr (std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder>) {
            if (!draco::DecodeVarint(&vertices, &ahead) || !draco::DecodeVarint(&faces, &ahead) || !ahead.Decode(&attribute_data))
                return false;
        } else {
            if (!draco::DecodeVarint(&faces, &ahead) || !draco::DecodeVarint(&vertices, &ahead)) return false;
        }
        if (!allowance_.holds(faces * (kBytesPerFace + kBytesPerFaceOfAttribute * attribute_data) + std::uint64_t{vertices} * 8))
            return false;
        return Decoder::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override {
        const draco::PointCloud& cloud = *this->point_cloud();
        if (cloud.num_attributes() > kMaxAttributes) {
            allowance_.error =
                Error{ErrorCode::limit, fmt::format("Draco: {} attributes, the limit is {}", cloud.num_attributes(), kMaxAttributes)};
            return false;
        }
        std::uint64_t bytes = 0;
        for (int i = 0; i < cloud.num_attributes(); ++i) {
            const draco::PointAttribute& attribute = *cloud.attribute(i);
            // Values, their portable form in 32-bit integers, and the map from vertices.
            const auto size = static_cast<std::uint64_t>(draco::DataTypeLength(attribute.data_type()) + 4);
            bytes += std::uint64_t{cloud.num_points()} * (attribute.num_components() * size + 4);
        }
        return allowance_.holds(bytes) && Decoder::DecodeAllAttributes();
    }

private:
    Allowance& allowance_;
};

draco::DecoderOptions integer_options() {
    draco::DecoderOptions options;
    for (int type = 0; type < draco::GeometryAttribute::NAMED_ATTRIBUTES_COUNT; ++type)
        options.SetAttributeBool(static_cast<draco::GeometryAttribute::Type>(type), "skip_attribute_transform", true);
    return options;
}

template <class T>
void store(std::vector<std::byte>& out, std::size_t at, T value) {
    const auto bits =
        std::bit_cast<std::conditional_t<sizeof(T) == 1, std::uint8_t, std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint32_t>>>(
            value);
    for (std::size_t i = 0; i < sizeof(T); ++i) out[at + i] = static_cast<std::byte>(bits >> 8 * i & 255u);
}

/// Direction of a point of the unfolded octahedron, both coordinates from 0 to 2^bits - 2.
void octahedral_direction(const std::int32_t* from, int bits, float* out) {
    const float scale = 2.0f / static_cast<float>((std::int64_t{1} << bits) - 2);
    float y = static_cast<float>(from[0]) * scale - 1.0f, z = static_cast<float>(from[1]) * scale - 1.0f;
    const float x = (1.0f - std::fabs(y)) - std::fabs(z);
    const float fold = x < 0.0f ? -x : 0.0f;  // the other half lies in the corners
    y += y < 0.0f ? fold : -fold;
    z += z < 0.0f ? fold : -fold;
    const float square = (x * x + y * y) + z * z;
    const float scale_to_1 = square < 1e-6f ? 0.0f : 1.0f / std::sqrt(square);
    out[0] = x * scale_to_1, out[1] = y * scale_to_1, out[2] = z * scale_to_1;
}

/// Reads values as floats.
class FloatReader {
public:
    explicit FloatReader(const draco::PointAttribute& attribute) : attribute_(attribute) {
        const draco::AttributeTransformData* const transform = attribute.GetAttributeTransformData();
        if (transform == nullptr) return;
        if (transform->transform_type() == draco::ATTRIBUTE_QUANTIZATION_TRANSFORM) good_ = quantization_.InitFromAttribute(attribute);
        if (transform->transform_type() == draco::ATTRIBUTE_OCTAHEDRON_TRANSFORM) good_ = octahedron_.InitFromAttribute(attribute);
        if (quantization_.is_initialized())
            good_ = good_ && quantization_.quantization_bits() >= 1 && quantization_.quantization_bits() <= 30 &&
                    quantization_.min_values().size() >= attribute.num_components();
        if (octahedron_.is_initialized())
            good_ =
                good_ && octahedron_.quantization_bits() >= 2 && octahedron_.quantization_bits() <= 30 && attribute.num_components() == 2;
    }
    [[nodiscard]] bool good() const { return good_; }
    [[nodiscard]] bool is_transformed() const { return quantization_.is_initialized() || octahedron_.is_initialized(); }
    [[nodiscard]] int components() const { return octahedron_.is_initialized() ? 3 : attribute_.num_components(); }

    /// Requires: good(), and at most 16 components.
    bool read(draco::AttributeValueIndex index, float* out) const {
        const int count = attribute_.num_components();
        if (!is_transformed()) return attribute_.ConvertValue(index, static_cast<std::int8_t>(count), out);
        std::int32_t integers[16];
        if (!attribute_.ConvertValue(index, static_cast<std::int8_t>(count), integers)) return false;
        if (octahedron_.is_initialized()) {
            octahedral_direction(integers, octahedron_.quantization_bits(), out);
            return true;
        }
        const float step = quantization_.range() / static_cast<float>((std::int64_t{1} << quantization_.quantization_bits()) - 1);
        for (int c = 0; c < count; ++c) out[c] = static_cast<float>(integers[c]) * step + quantization_.min_value(c);
        return true;
    }

private:
    const draco::PointAttribute& attribute_;
    draco::AttributeQuantizationTransform quantization_;
    draco::AttributeOctahedronTransform octahedron_;
    bool good_ = true;
};

template <class T, class Read>
bool store_all(const draco::PointAttribute& attribute, std::size_t vertices, const DracoRequest& request, std::vector<std::byte>& out,
               const Read& read) {
    T values[16] = {};
    for (std::size_t v = 0; v < vertices; ++v) {
        const draco::AttributeValueIndex index = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(v)));
        if (index.value() >= attribute.size() || !read(index, values)) return false;
        for (std::size_t c = 0; c < static_cast<std::size_t>(request.components); ++c)
            store(out, v * request.stride + c * sizeof(T), values[c]);
    }
    return true;
}

class Mesh final : public DracoMesh {
public:
    [[nodiscard]] std::size_t vertices() const override { return mesh.num_points(); }
    [[nodiscard]] std::size_t triangles() const override { return mesh.num_faces(); }
    [[nodiscard]] std::size_t attributes() const override { return static_cast<std::size_t>(mesh.num_attributes()); }
    [[nodiscard]] std::vector<std::byte> indices() const override;
    [[nodiscard]] Result<std::vector<std::byte>> values(const DracoRequest& request, bool* converted) const override;

    draco::Mesh mesh;
};

std::vector<std::byte> Mesh::indices() const {
    std::vector<std::byte> out(12 * triangles());
    for (std::uint32_t t = 0; t < mesh.num_faces(); ++t)
        for (std::size_t c = 0; c < 3; ++c) store(out, 12 * t + 4 * c, mesh.face(draco::FaceIndex(t))[c].value());
    return out;
}

Result<std::vector<std::byte>> Mesh::values(const DracoRequest& request, bool* converted) const {
    const auto wrong = [&](const std::string& what) {
        return fail(ErrorCode::bad_input, fmt::format("Draco: attribute {} {}", request.unique_id, what));
    };
    const draco::PointAttribute* const attribute = mesh.GetAttributeByUniqueId(request.unique_id);
    if (attribute == nullptr) return wrong("is not in the stream");
    const FloatReader floats(*attribute);
    if (!floats.good()) return wrong("has a damaged transform");
    if (floats.components() != request.components || attribute->num_components() > 16)
        return wrong(fmt::format("has {} components, expected {}", floats.components(), request.components));
    std::vector<std::byte> out(vertices() * request.stride);
    bool stored = false;
    const auto integers = [&]<class T>(T) {
        const auto count = static_cast<std::int8_t>(request.components);
        if (!floats.is_transformed() && draco::IsDataTypeIntegral(attribute->data_type()))
            return store_all<T>(*attribute, vertices(), request, out,
                                [&](draco::AttributeValueIndex index, T* to) { return attribute->ConvertValue(index, count, to); });
        if (converted == nullptr) return false;
        *converted = true;
        constexpr auto kLow = static_cast<double>(std::numeric_limits<T>::lowest()),
                       kHigh = static_cast<double>(std::numeric_limits<T>::max());
        return store_all<T>(*attribute, vertices(), request, out, [&](draco::AttributeValueIndex index, T* to) {
            float values[16] = {};
            if (!floats.read(index, values)) return false;
            for (std::size_t c = 0; c < 16; ++c) {
                const double value = double{values[c]} * (request.normalized ? kHigh : 1.0);
                to[c] =
                    value > kLow ? static_cast<T>(std::min(value + (value < 0.0 ? -0.5 : 0.5), kHigh)) : std::numeric_limits<T>::lowest();
            }
            return true;
        });
    };
    switch (request.component_type) {
        case 5120:
            stored = integers(std::int8_t{});
            break;
        case 5121:
            stored = integers(std::uint8_t{});
            break;
        case 5122:
            stored = integers(std::int16_t{});
            break;
        case 5123:
            stored = integers(std::uint16_t{});
            break;
        case 5125:
            stored = integers(std::uint32_t{});
            break;
        case 5126:
            stored = store_all<float>(*attribute, vertices(), request, out,
                                      [&](draco::AttributeValueIndex index, float* to) { return floats.read(index, to); });
            break;
        default:
            break;
    }
    if (!stored) return wrong(fmt::format("does not hold values of component type {}", request.component_type));
    return out;
}

}  // namespace

Result<std::unique_ptr<DracoMesh>> decode_draco_mesh(std::span<const std::byte> stream, std::uint64_t memory) {
    const auto damaged = [](const std::string& what) { return fail(ErrorCode::bad_input, fmt::format("Draco: {}", what)); };
    Allowance allowance{memory, {}};
    try {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
        draco::DecoderBuffer ahead = buffer;
        draco::DracoHeader header;
        if (const draco::Status status = draco::PointCloudDecoder::DecodeHeader(&ahead, &header); !status.ok())
            return damaged(status.error_msg_string());
        if (header.version_major != 2 || header.version_minor != 2)
            return damaged(fmt::format("expected a stream of version 2.2, found {}.{}", header.version_major, header.version_minor));
        if (header.encoder_type != draco::TRIANGULAR_MESH) return damaged("expected a mesh of triangles, found a cloud of points");
        auto made = std::make_unique<Mesh>();
        const draco::DecoderOptions options = integer_options();
        const auto run = [&](auto&& decoder) { return decoder.Decode(options, &buffer, &made->mesh); };
        const draco::Status status = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING
                                         ? run(Guarded<draco::MeshEdgebreakerDecoder>(allowance))
                                     : header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING
                                         ? run(Guarded<draco::MeshSequentialDecoder>(allowance))
                                         : draco::Status(draco::Status::DRACO_ERROR, "unknown method of encoding");
        if (allowance.error) return tl::unexpected(*std::move(allowance.error));
        if (!status.ok()) return damaged(status.error_msg_string());
        return made;
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::limit, "Draco: out of memory");
    } catch (const std::exception&) {
        return damaged("the stream is damaged");
    }
}

}  // namespace halflit::io::detail

#endif
