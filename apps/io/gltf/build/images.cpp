#include "apps/io/gltf/build/images.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/files/uri.hpp"
#include "apps/io/pictures/image_reader.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <system_error>

namespace halflit::io::detail {

namespace {

/// Memory of a texture: RGBA at 16 bits, and a third more for the smaller mip levels.
std::uint64_t texture_bytes(const ImageHeader& header) {
    return static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height) * 32 / 3;
}

/// Takes a picture that is lost out of a material. A factor that scales what the picture has only here and there is off without it.
void leave_out(Material& material, TextureSlot slot) {
    material.textures[slot] = {};
    if (slot == TextureSlot::metallic_roughness) material.metallic = 0.0f;
    if (slot == TextureSlot::emissive) material.emissive = {};
    if (slot == TextureSlot::transmission) material.transmission = 0.0f;
}

/// Makes a texture from rows as they are decoded.
struct TextureRows : RowSink {
    TextureBuilder builder;
    ColorSpace space;
    Texture palette;                 ///< 256 x 1 texels, once it is known
    std::vector<std::uint16_t> row;  ///< of colours of the palette

    TextureRows(TextureBuilder made, ColorSpace of) : builder(std::move(made)), space(of) {}
    void add_row(const std::uint8_t* rgba8) override {
        check_time();
        builder.add_row(rgba8, space);
    }
    void add_row(const std::uint16_t* rgba16) override {
        check_time();
        builder.add_row(rgba16);
    }
    void add_indexed_row(std::span<const std::uint8_t> indices, const Palette& colors) override {
        if (palette.width() == 0) {
            palette = take(Texture::from_rgba8({colors[0].data(), sizeof(Palette)}, static_cast<int>(colors.size()), 1, space), "palette");
            row.resize(4 * indices.size());
        }
        const std::uint16_t* const texels = palette.data().data();
        for (std::size_t x = 0; x < indices.size(); ++x) std::memcpy(&row[4 * x], texels + std::size_t{4} * indices[x], 8);
        add_row(row.data());
    }
};

std::string_view mime_type_of(ImageFormat format) {
    switch (format) {
        case ImageFormat::png:
            return "image/png";
        case ImageFormat::jpeg:
            return "image/jpeg";
        case ImageFormat::webp:
            break;
    }
    return "image/webp";
}

std::string identity(const file::Image& entry) {
    return entry.buffer_view >= 0 ? fmt::format("bufferView {}", entry.buffer_view) : std::string(entry.uri.value_or(""));
}

}  // namespace

ImageStore::ImageStore(Document& document, std::vector<Texture>& textures)
    : document_(document), textures_(textures), texture_memory_("the textures", document.options.limits.max_texture_bytes) {}

ImageStore::Job ImageStore::prepare(int image, ColorSpace space, MipRule rule, int texture) {
    check_time();
    const file::Image& entry = document_.file.images[static_cast<std::size_t>(image)];
    const LoadLimits& limits = document_.options.limits;
    std::string where = entry.place.empty() ? fmt::format("images[{}]", image) : std::string(entry.place);
    const std::string at_uri = entry.place.empty() ? where + ".uri" : where;
    std::vector<std::byte> owned;
    std::span<const std::byte> bytes;
    if (entry.buffer_view >= 0 && entry.uri) refuse(where, "has both a uri and a bufferView, which exclude each other");
    if (entry.buffer_view >= 0) {
        bytes = document_.view_data(entry.buffer_view);
    } else if (entry.uri && is_data_uri(*entry.uri)) {
        owned = take(decode_data_uri(*entry.uri, limits.max_file_bytes), at_uri);
        bytes = owned;
    } else if (entry.uri) {
        owned = take(document_.read_named(take(decode_file_uri(*entry.uri), at_uri)), at_uri);
        bytes = owned;
        if (entry.place.empty()) where = fmt::format("{}: \"{}\"", at_uri, printable(*entry.uri, 120));
    } else {
        refuse(where, "expected a uri or a bufferView, found neither");
    }
    document_.encoded_images.take(bytes.size());

    const ImageLimits image_limits{limits.max_texture_side, limits.max_texture_pixels, limits.max_jpeg_scans};
    const ImageHeader header = take(read_image_header(bytes, image_limits), where);
    const std::string_view type = mime_type_of(header.format);
    if (!entry.mime_type.empty() && entry.mime_type != type)
        document_.warn(fmt::format("images[{}].mimeType: is \"{}\", but the picture is {}", image, printable(entry.mime_type, 40), type));
    if (texture_bytes(header) > texture_memory_.left())
        refuse(where, fmt::format("the textures would take more than {} MB, which is the limit", limits.max_texture_bytes >> 20),
               ErrorCode::limit);
    texture_memory_.take(texture_bytes(header));
    return {.texture = texture,
            .space = space,
            .rule = rule,
            .where = std::move(where),
            .owned = std::move(owned),
            .bytes = bytes,
            .width = header.width,
            .height = header.height,
            .keep_16_bits = header.bits == 16 && space == ColorSpace::linear,
            .failure = nullptr};
}

int ImageStore::texture_for(int image, ColorSpace space, MipRule rule) {
    const auto [found, is_new] = made_.try_emplace({identity(document_.file.images[static_cast<std::size_t>(image)]), space, rule},
                                                   static_cast<int>(textures_.size()));
    if (!is_new) return found->second;
    textures_.emplace_back();
    try {
        jobs_.push_back(prepare(image, space, rule, found->second));
    } catch (const LoadFailure& failure) {
        lose(found->second, failure);
    }
    return found->second;
}

void ImageStore::lose(int texture, const LoadFailure& failure) {
    if (document_.options.strict || failure.error.code != ErrorCode::bad_input) throw failure;
    document_.warn(failure.error.message + "; drawn without the picture");
    lost_.insert(texture);
}

Texture ImageStore::make(const Job& job) const {
    check_time();
    const LoadLimits& limits = document_.options.limits;
    TextureRows rows(take(TextureBuilder::make(job.width, job.height, job.rule), job.where), job.space);
    take(decode_rows(job.bytes, {limits.max_texture_side, limits.max_texture_pixels, limits.max_jpeg_scans}, job.keep_16_bits, rows),
         job.where);
    return rows.builder.finish();
}

void ImageStore::run(Job& job) {
    try {
        textures_[static_cast<std::size_t>(job.texture)] = make(job);
    } catch (...) {
        job.failure = std::current_exception();
    }
    job.owned = {};
}

std::size_t ImageStore::other_threads() const {
    // A thread costs some tens of microseconds, and its memory; so many pixels take a millisecond.
    constexpr std::size_t kPixelsAThread = 1 << 17;
    std::size_t pixels = 0;
    for (const Job& job : jobs_) pixels += static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height);
    const int wanted = document_.options.threads;
    const std::size_t most = wanted > 0 ? static_cast<std::size_t>(wanted) : std::max(1u, std::thread::hardware_concurrency());
    return std::min({most - 1, jobs_.size(), pixels / kPixelsAThread});
}

void ImageStore::run_jobs() {
    for (std::size_t i = next_job_++; i < jobs_.size(); i = next_job_++) run(jobs_[i]);
}

void ImageStore::start() {
    const std::size_t count = other_threads();
    try {
        threads_.reserve(count);
        while (threads_.size() < count)
            threads_.emplace_back([this, end = TimeLimit::end()] {
                const TimeLimit limit(end);
                run_jobs();
            });
    } catch (const std::system_error&) {  // no more threads: those that run do the work
    } catch (const std::bad_alloc&) {     // likewise
    }
}

ImageStore::~ImageStore() { next_job_ = jobs_.size(); }

void ImageStore::finish(std::vector<Material>& materials) {
    run_jobs();
    threads_.clear();
    // In order, so that what is reported does not depend on the threads.
    for (const Job& job : jobs_) {
        if (job.failure == nullptr) continue;
        try {
            std::rethrow_exception(job.failure);
        } catch (const LoadFailure& failure) {
            lose(job.texture, failure);
        }
    }
    jobs_.clear();
    for (Material& material : materials)
        for (std::size_t i = 0; i < kTextureSlots; ++i)
            if (const auto slot = static_cast<TextureSlot>(i); lost_.contains(material.textures[slot].texture)) leave_out(material, slot);
}

}  // namespace halflit::io::detail
