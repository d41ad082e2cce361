#include "apps/io/gltf/build/images.hpp"

#include "apps/io/files/in_parts.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/files/uri.hpp"
#include "apps/io/pictures/image_reader.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>
#include <new>
#include <system_error>

namespace halflit::io::detail {

namespace {

/// Memory of a texture: RGBA at 16 bits, and a third more for the smaller mip levels.
std::uint64_t texture_bytes(int width, int height) {
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * 32 / 3;
}

/// Pixels that may be decoded for each byte of max_texture_bytes, which bounds the time: 16 pictures of 8192 x 8192 for 1 GiB.
constexpr std::uint64_t kMostPixelsAByte = 1;

/// Memory that the textures may take: small files, whose pictures hold little, get less, so that there is room for 500 MB of triangles
/// (raster/passes/view_geometry.cpp) and the geometry in the 1 GB of files below kSmall.
std::uint64_t texture_limit(const Document& document) {
    constexpr std::uint64_t kFree = std::uint64_t{96} << 20, kByByte = 256, kSmall = 1'000'000, kByByteMore = 2000;
    const std::uint64_t most = document.options.limits.max_texture_bytes, bytes = document.file_bytes + document.named_bytes;
    return document.options.strict ? most : std::min(most, kFree + kByByte * bytes + kByByteMore * (std::max(bytes, kSmall) - kSmall));
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
    int added = 0;
    Texture palette;                 ///< 256 x 1 texels, once it is known
    std::vector<std::uint16_t> row;  ///< of colours of the palette

    TextureRows(TextureBuilder made, ColorSpace of) : builder(std::move(made)), space(of) {}
    void add_row(const std::uint8_t* rgba8) override {
        check_time();
        builder.add_row(rgba8, space);
        ++added;
    }
    void add_row(const std::uint16_t* rgba16) override {
        check_time();
        builder.add_row(rgba16);
        ++added;
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
    static constexpr std::string_view kTypes[] = {"image/png", "image/jpeg", "image/webp", "image/bmp", "image/tiff", "image/ktx2"};
    static_assert(std::size(kTypes) == static_cast<std::size_t>(ImageFormat::ktx2) + 1);
    return kTypes[static_cast<std::size_t>(format)];
}

std::string identity(const file::Image& entry) {
    return entry.buffer_view >= 0 ? fmt::format("bufferView {}", entry.buffer_view) : std::string(entry.uri.value_or(""));
}

}  // namespace

ImageStore::ImageStore(Document& document, std::vector<Texture>& textures) : document_(document), textures_(textures) {}

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
    } else if (entry.uri) {
        owned = document_.read_uri(*entry.uri, at_uri);
        bytes = owned;
        if (entry.place.empty() && !is_data_uri(*entry.uri)) where = fmt::format("{}: \"{}\"", at_uri, printable(*entry.uri, 120));
    } else {
        refuse(where, "expected a uri or a bufferView, found neither");
    }
    document_.encoded_images.take(bytes.size());

    const ImageLimits image_limits{limits.max_texture_side, limits.max_texture_pixels, limits.max_jpeg_scans};
    const ImageHeader header = take(read_image_header(bytes, image_limits), where);
    const std::string_view type = mime_type_of(header.format);
    if (!entry.mime_type.empty() && entry.mime_type != type)
        document_.warn(fmt::format("images[{}].mimeType: is \"{}\", but the picture is {}", image, printable(entry.mime_type, 40), type));
    const std::uint64_t bytes_of_all = texture_bytes_ + texture_bytes(header.width, header.height);
    pixels_ += static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height);
    if (pixels_ > kMostPixelsAByte * limits.max_texture_bytes)
        refuse(where,
               fmt::format("the textures have more than {} pixels, one for each byte of max_texture_bytes",
                           kMostPixelsAByte * limits.max_texture_bytes),
               ErrorCode::limit);
    if (bytes_of_all > limits.max_texture_bytes && document_.options.strict)
        refuse(where, fmt::format("the textures would take more than {} bytes, which is max_texture_bytes", limits.max_texture_bytes),
               ErrorCode::limit);
    texture_bytes_ = bytes_of_all;
    constexpr std::uint64_t kUnitsAPixel = 20;  // of a picture of one scan, with its smaller levels
    charge_work(kUnitsAPixel * static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height));
    return {.texture = texture,
            .space = space,
            .rule = rule,
            .where = std::move(where),
            .owned = std::move(owned),
            .bytes = bytes,
            .width = header.width,
            .height = header.height,
            .skip_levels = 0,
            .keep_16_bits = header.bits == 16 && space == ColorSpace::linear,
            .damage = {},
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

Texture ImageStore::make(Job& job) const {
    check_time();
    const LoadLimits& limits = document_.options.limits;
    const bool strict = document_.options.strict;
    TextureRows rows(take(TextureBuilder::make(job.width, job.height, job.rule, job.skip_levels), job.where), job.space);
    const ImageLimits image_limits{limits.max_texture_side, limits.max_texture_pixels, limits.max_jpeg_scans, !strict};
    if (const auto decoded = decode_rows(job.bytes, image_limits, job.keep_16_bits, rows); !decoded) {
        if (strict || decoded.error().code != ErrorCode::bad_input || rows.added == 0)
            refuse(job.where, decoded.error().message, decoded.error().code);
        job.damage = fmt::format("{}; drawn as far as it was read, the rest as its last row", decoded.error().message);
    }
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
    std::size_t pixels = 0, largest = 1;
    for (const Job& job : jobs_) {
        const std::size_t of_job = static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height);
        pixels += of_job, largest = std::max(largest, of_job);
    }
    // All pictures that are decoded at a time take no more than the textures may.
    constexpr std::size_t kBytesAPixel = 8;
    const std::size_t fitting = std::max<std::size_t>(1, texture_limit(document_) / kBytesAPixel / largest);
    return std::min({allowed_threads(document_.options.threads) - 1, fitting - 1, jobs_.size(), pixels / kPixelsAThread});
}

void ImageStore::run_jobs() {
    for (std::size_t i = next_job_++; i < jobs_.size(); i = next_job_++) run(jobs_[i]);
}

void ImageStore::fit_memory() {
    const std::uint64_t limit = texture_limit(document_);
    if (texture_bytes_ <= limit) return;
    const auto bytes_of = [](const Job& job) {
        return texture_bytes(std::max(1, job.width >> job.skip_levels), std::max(1, job.height >> job.skip_levels));
    };
    // The largest ones lose a level, until all fit.
    std::map<std::uint64_t, std::vector<std::size_t>> by_size;
    for (std::size_t i = 0; i < jobs_.size(); ++i) by_size[bytes_of(jobs_[i])].push_back(i);
    std::uint64_t bytes = texture_bytes_;
    while (bytes > limit && !by_size.empty()) {
        const auto largest = std::prev(by_size.end());
        const auto [before, jobs] = *largest;
        by_size.erase(largest);
        for (const std::size_t i : jobs) {
            check_time();
            if (std::max(jobs_[i].width, jobs_[i].height) >> jobs_[i].skip_levels <= 1) continue;
            ++jobs_[i].skip_levels;
            bytes = bytes - before + bytes_of(jobs_[i]);
            by_size[bytes_of(jobs_[i])].push_back(i);
        }
    }
    if (bytes > limit)
        refuse("", fmt::format("{} textures take more than {} bytes, which is max_texture_bytes", jobs_.size(), limit), ErrorCode::limit);
    std::size_t reduced = 0;
    int least = kMaxTextureLevels, most = 0;
    for (const Job& job : jobs_) {
        if (job.skip_levels == 0) continue;
        ++reduced;
        least = std::min(least, job.skip_levels), most = std::max(most, job.skip_levels);
    }
    const std::string share = least == most ? fmt::format("1/{}", 1 << most) : fmt::format("1/{} to 1/{}", 1 << least, 1 << most);
    const auto megabytes = [](std::uint64_t n) { return static_cast<double>(n) / 1e6; };
    document_.warn(fmt::format("the textures would take {:.3g} MB, the limit{} is {:.3g} MB: {} of {} are kept at {} of their sides",
                               megabytes(texture_bytes_),
                               limit == document_.options.limits.max_texture_bytes ? " (max_texture_bytes)" : " for a file of this size",
                               megabytes(limit), reduced, jobs_.size(), share));
}

void ImageStore::start() {
    fit_memory();
    const std::size_t count = other_threads();
    try {
        threads_.reserve(count);
        while (threads_.size() < count)
            threads_.emplace_back([this, bounds = TimeLimit::bounds()] {
                const TimeLimit limit(bounds);
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
        if (!job.damage.empty()) document_.warn(fmt::format("{}: {}", job.where, job.damage));
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
