#include "halflit/image.hpp"

#include "apps/io/files/atomic_file.hpp"
#include "apps/io/files/optional_libraries.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/pictures/exr_file.hpp"
#include "apps/io/pictures/pfm_file.hpp"
#include "apps/io/pictures/png_writer.hpp"
#include "apps/io/pictures/webp_encoder.hpp"
#include "apps/io/platform/files.hpp"
#include "sh/fp_environment.hpp"
#include "shading/out_of_memory.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <new>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wunused-function"
/// Memory of one encoder. stb's allocations are not checked by it, so a failed one throws; what it had is freed here.
class EncoderMemory {
public:
    EncoderMemory() : outer_(current_) { current_ = this; }
    ~EncoderMemory() {
        while (first_.next != &first_) give(first_.next + 1);
        current_ = outer_;
    }
    EncoderMemory(const EncoderMemory&) = delete;
    EncoderMemory& operator=(const EncoderMemory&) = delete;

    static void* take(std::size_t size) {
        auto* const block = static_cast<Block*>(std::malloc(sizeof(Block) + size));
        if (block == nullptr) throw std::bad_alloc();
        Block& first = current_->first_;
        block->next = first.next, block->previous = &first, block->size = size;
        first.next->previous = block, first.next = block;
        return block + 1;
    }
    static void give(void* memory) {
        if (memory == nullptr) return;
        Block* const block = static_cast<Block*>(memory) - 1;
        block->next->previous = block->previous, block->previous->next = block->next;
        std::free(block);
    }
    static void* resize(void* memory, std::size_t size) {
        void* const larger = take(size);
        if (memory != nullptr) std::memcpy(larger, memory, std::min(size, (static_cast<Block*>(memory) - 1)->size));
        give(memory);
        return larger;
    }

private:
    struct alignas(std::max_align_t) Block {
        Block *next, *previous;
        std::size_t size;
    };
    Block first_{&first_, &first_, 0};
    EncoderMemory* outer_;
    static thread_local EncoderMemory* current_;
};
thread_local EncoderMemory* EncoderMemory::current_ = nullptr;

#define STBIW_MALLOC(size) EncoderMemory::take(size)
#define STBIW_REALLOC(memory, size) EncoderMemory::resize(memory, size)
#define STBIW_FREE(memory) EncoderMemory::give(memory)
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace halflit {

using namespace io;
namespace {

constexpr int kJpegQuality = 95;
constexpr float kLargestRgbe = 1.69e38f;  // 255/256 * 2^127

/// Target of the encoder's C callback. An exception may not pass through C code, so it is kept here.
struct Sink {
    std::vector<std::uint8_t> bytes;
    std::exception_ptr failure;

    static void append(void* context, void* data, int size) {
        auto& sink = *static_cast<Sink*>(context);
        if (sink.failure) return;
        try {
            const auto* first = static_cast<const std::uint8_t*>(data);
            sink.bytes.insert(sink.bytes.end(), first, first + size);
        } catch (...) {
            sink.failure = std::current_exception();
        }
    }
};

std::vector<std::uint8_t> rgb8_over_black(const Image& image) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(image.rgba8.size() / 4 * 3);
    for (std::size_t i = 0; i < image.rgba8.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c) rgb.push_back(static_cast<std::uint8_t>((image.rgba8[i + c] * image.rgba8[i + 3] + 127) / 255));
    return rgb;
}

std::vector<float> rgb_linear_over_black(const Image& image) {
    std::vector<float> rgb;
    rgb.reserve(image.rgba_linear.size() / 4 * 3);
    for (std::size_t i = 0; i < image.rgba_linear.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c) {
            const float value = image.rgba_linear[i + c] * image.rgba_linear[i + 3];
            rgb.push_back(value > 0.0f ? std::min(value, kLargestRgbe) : 0.0f);  // NaN is not above 0
        }
    return rgb;
}

/// Light times alpha, as EXR demands it; over black, the picture is the same without alpha.
std::vector<float> premultiplied(const Image& image) {
    std::vector<float> rgba = image.rgba_linear;
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c) rgba[i + c] = rgba[i + 3] > 0.0f ? rgba[i + c] * rgba[i + 3] : 0.0f;
    return rgba;
}

std::vector<std::uint8_t> pfm_of(const Image& image) {
    const std::vector<float> rgba = premultiplied(image);
    std::vector<float> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4) rgb.insert(rgb.end(), &rgba[i], &rgba[i] + 3);
    return encode_pfm(image.width, image.height, 3, rgb);
}

/// An opaque picture is stored without alpha.
Result<std::vector<std::uint8_t>> exr_of(const Image& image) {
    const std::vector<float> rgba = premultiplied(image);
    bool opaque = true;
    for (std::size_t i = 3; i < rgba.size(); i += 4) opaque &= rgba[i] == 1.0f;
    const ExrChannel channels[] = {{"R", rgba.data(), 4}, {"G", rgba.data() + 1, 4}, {"B", rgba.data() + 2, 4}, {"A", rgba.data() + 3, 4}};
    return encode_exr(image.width, image.height, std::span(channels, opaque ? 3 : 4));
}

int bmp_of(const Image& image, Sink& sink) {
    return stbi_write_bmp_to_func(&Sink::append, &sink, image.width, image.height, 4, image.rgba8.data());
}

int tga_of(const Image& image, Sink& sink) {
    return stbi_write_tga_to_func(&Sink::append, &sink, image.width, image.height, 4, image.rgba8.data());
}

int jpg_of(const Image& image, Sink& sink) {
    return stbi_write_jpg_to_func(&Sink::append, &sink, image.width, image.height, 3, rgb8_over_black(image).data(), kJpegQuality);
}

int hdr_of(const Image& image, Sink& sink) {
    return stbi_write_hdr_to_func(&Sink::append, &sink, image.width, image.height, 3, rgb_linear_over_black(image).data());
}

using Encoded = Result<std::vector<std::uint8_t>>;

/// By one of stb's encoders, which fail only when memory runs out.
template <int (*encode)(const Image&, Sink&)>
Encoded by_stb(const Image& image) {
    const EncoderMemory memory;
    Sink sink;
    const int done = encode(image, sink);
    if (sink.failure) std::rethrow_exception(sink.failure);
    if (done == 0) throw std::bad_alloc();
    return std::move(sink.bytes);
}

/// A format of pictures: the one place that lists what is written.
struct FormatRow {
    std::string_view extension, also;  ///< of files, without the point
    int max_side;                      ///< pixels
    Encoded (*encode)(const Image& image);
    bool (*has)();             ///< whether this build can; null: always
    std::string_view lacking;  ///< what to say where it cannot
};

constexpr int kAnySide = std::numeric_limits<int>::max();

/// Indexed by OutputFormat.
constexpr FormatRow kFormats[] = {
    {"png", "", kAnySide, [](const Image& image) -> Encoded { return encode_png(image.width, image.height, image.rgba8); }, nullptr, ""},
    {"bmp", "", kAnySide, by_stb<bmp_of>, nullptr, ""},
    {"tga", "", 65535, by_stb<tga_of>, nullptr, ""},
    {"jpg", "jpeg", 65535, by_stb<jpg_of>, nullptr, ""},
    {"webp", "", 16383, encode_webp, has_webp, "WebP files need the library libwebp, which this build lacks"},
    {"hdr", "", kAnySide, by_stb<hdr_of>, nullptr, ""},
    {"pfm", "", kAnySide, [](const Image& image) -> Encoded { return pfm_of(image); }, nullptr, ""},
    {"exr", "", kAnySide, exr_of, has_exr, "EXR files need the library OpenEXR, which this build lacks (.pfm has the same floats)"},
};

const FormatRow& row_of(OutputFormat format) { return kFormats[static_cast<std::size_t>(format)]; }

}  // namespace

std::string_view output_format_name(OutputFormat format) { return row_of(format).extension; }

Result<OutputFormat> output_format_of(std::string_view path) {
    if (path == "-") return OutputFormat::png;
    const std::size_t slash = platform::last_separator(path);
    const std::string_view name = slash == std::string_view::npos ? path : path.substr(slash + 1);
    const std::size_t dot = name.rfind('.');
    std::string extension(dot == std::string_view::npos ? std::string_view() : name.substr(dot + 1));
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    std::string expected;
    for (std::size_t i = 0; i < std::size(kFormats); ++i) {
        const FormatRow& row = kFormats[i];
        expected.append(i == 0 ? "" : i + 1 == std::size(kFormats) ? " or " : ", ").append(".").append(row.extension);
        if (extension.empty() || (extension != row.extension && extension != row.also)) continue;
        if (row.has != nullptr && !row.has()) return fail(ErrorCode::usage, std::string(path) + ": " + std::string(row.lacking));
        return static_cast<OutputFormat>(i);
    }
    return fail(ErrorCode::usage, std::string(path) + ": unknown file extension, expected " + expected);
}

Result<std::vector<std::uint8_t>> encode_image(const Image& image, OutputFormat format) {
    const FpEnvironment environment_of_host;
    const int w = image.width, h = image.height;
    if (w < 1 || h < 1) return fail(ErrorCode::usage, "a picture needs at least one pixel");
    const std::int64_t pixels = std::int64_t{w} * h;
    if (pixels > kMaxImagePixels) return fail(ErrorCode::limit, "a picture of more than 2^28 pixels cannot be encoded");
    const std::size_t values = is_linear(format) ? image.rgba_linear.size() : image.rgba8.size();
    if (values != static_cast<std::size_t>(pixels) * 4)
        return fail(ErrorCode::usage, std::string(is_linear(format) ? "rgba_linear" : "rgba8") + ": " + std::to_string(values) +
                                          " values, expected " + std::to_string(pixels * 4));
    const FormatRow& row = row_of(format);
    if (std::max(w, h) > row.max_side)
        return fail(ErrorCode::limit, std::string(row.extension) + " holds at most " + std::to_string(row.max_side) + " pixels a side");

    try {
        return row.encode(image);
    } catch (const std::bad_alloc&) {
        return fail_out_of_memory([] { return std::string("out of memory while encoding the picture"); });
    }
}

Result<void> write_image(const std::string& path, const Image& image) {
    const FpEnvironment environment_of_host;
    const auto format = output_format_of(path);
    if (!format) return tl::unexpected(format.error());
    const auto bytes = encode_image(image, *format);
    if (!bytes) return fail(bytes.error().code, printable(path) + ": " + bytes.error().message);
    return write_file(path, *bytes);
}

}  // namespace halflit
