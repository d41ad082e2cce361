// JPEG by libjpeg-turbo, with the slow integer DCT, because its SIMD and plain versions give the same bits.
#include "apps/io/pictures/image_decoders.hpp"

#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <csetjmp>
#include <cstdio>
#include <string>

#include <jerror.h>
#include <jpeglib.h>

namespace halflit::io::detail {

namespace {

/// libjpeg reports errors by a callback that must not return. It jumps (longjmp) to the setjmp in the method that called libjpeg. The
/// frames between the two hold no object with a destructor: all objects live in the caller's frame, above setjmp.
struct Decoder {
    jpeg_decompress_struct info{};
    jpeg_error_mgr errors{};
    jpeg_progress_mgr progress{};
    std::jmp_buf escape{};
    char message[JMSG_LENGTH_MAX] = "";
    int max_scans = 0, scans = 1;
    bool keep_damaged = false, too_many_scans = false, out_of_memory = false, out_of_time = false, out_of_work = false;

    Decoder() {
        info.err = jpeg_std_error(&errors);
        errors.error_exit = [](j_common_ptr common) {
            auto* self = static_cast<Decoder*>(common->client_data);
            common->err->format_message(common, self->message);
            self->out_of_memory = common->err->msg_code == JERR_OUT_OF_MEMORY;
            std::longjmp(self->escape, 1);
        };
        errors.emit_message = [](j_common_ptr common, int level) {
            auto* self = static_cast<Decoder*>(common->client_data);
            // Extra bytes between segments are common and harmless; every other warning means wrong pixels.
            if (level >= 0 || common->err->msg_code == JWRN_EXTRANEOUS_DATA || common->err->msg_code == JWRN_ADOBE_XFORM) return;
            if (self->message[0] == '\0') common->err->format_message(common, self->message);
            // libjpeg would fill the rest with grey. Of a file of several scans the later ones may be missing: they only add detail.
            const bool in_first_scan = !jpeg_has_multiple_scans(&self->info) || self->info.input_scan_number < 2;
            if (!self->keep_damaged || in_first_scan) std::longjmp(self->escape, 1);
        };
        errors.output_message = [](j_common_ptr) {};
        info.client_data = this;
    }
    ~Decoder() { jpeg_destroy_decompress(&info); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    /// Each further scan is a pass over the picture. Exceptions do not pass through libjpeg.
    void charge_scan() {
        constexpr std::uint64_t kUnitsAPixel = 4;
        try {
            charge_work(kUnitsAPixel * info.image_width * info.image_height);
        } catch (const OutOfTime&) {
            out_of_work = true;
        }
    }

    bool read_header(std::span<const std::byte> file) {
        if (setjmp(escape) != 0) return false;
        jpeg_create_decompress(&info);
        info.client_data = this;
        jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(file.data()), static_cast<unsigned long>(file.size()));
        jpeg_read_header(&info, TRUE);
        return true;
    }

    /// Called after read_header. `row` and `inks` hold width * 4 bytes. False: an error, or a damage.
    bool read_pixels(std::uint8_t* row, std::uint8_t* inks, int scan_limit, RowSink& sink) {
        if (setjmp(escape) != 0) return false;
        max_scans = scan_limit;
        progress.progress_monitor = [](j_common_ptr common) {
            auto* self = static_cast<Decoder*>(common->client_data);
            self->too_many_scans = self->info.input_scan_number > self->max_scans;
            self->out_of_time = time_is_over();
            for (; self->scans < self->info.input_scan_number && !self->out_of_work; ++self->scans) self->charge_scan();
            if (!self->too_many_scans && !self->out_of_time && !self->out_of_work) return;
            std::longjmp(self->escape, 1);
        };
        info.progress = &progress;
        const bool four_inks = info.num_components == 4;
        info.dct_method = JDCT_ISLOW;
        info.do_fancy_upsampling = TRUE;
        info.out_color_space = four_inks ? JCS_CMYK : JCS_EXT_RGBA;
        jpeg_start_decompress(&info);
        const std::size_t width = info.output_width;
        while (info.output_scanline < info.output_height) {
            JSAMPROW target = four_inks ? inks : row;
            jpeg_read_scanlines(&info, &target, 1);
            for (std::size_t x = 0; four_inks && x < width; ++x) {
                const bool inverted = info.saw_Adobe_marker;  // Adobe stores 255 - ink
                const unsigned black = inverted ? inks[4 * x + 3] : 255u - inks[4 * x + 3];
                for (std::size_t c = 0; c < 3; ++c) {
                    const unsigned light = inverted ? inks[4 * x + c] : 255u - inks[4 * x + c];
                    row[4 * x + c] = static_cast<std::uint8_t>((light * black + 127u) / 255u);
                }
                row[4 * x + 3] = 255;
            }
            sink.add_row(row);
        }
        jpeg_finish_decompress(&info);
        return message[0] == '\0';
    }

    [[nodiscard]] tl::unexpected<Error> error() const {
        if (out_of_time) {
            check_time();
            throw OutOfTime{};
        }
        if (out_of_work) throw OutOfTime{.is_work = true};
        if (too_many_scans) return fail(ErrorCode::limit, fmt::format("JPEG: more than {} scans, which is max_jpeg_scans", max_scans));
        return fail(out_of_memory ? ErrorCode::limit : ErrorCode::bad_input, fmt::format("JPEG: {}", message));
    }
};

}  // namespace

Result<ImageHeader> read_jpeg_header(std::span<const std::byte> file, const ImageLimits& limits) {
    Decoder decoder;
    if (!decoder.read_header(file)) return decoder.error();
    const auto size = check_image_size(decoder.info.image_width, decoder.info.image_height, limits);
    if (!size) return tl::unexpected(size.error());
    return ImageHeader{ImageFormat::jpeg, static_cast<int>(decoder.info.image_width), static_cast<int>(decoder.info.image_height), 8};
}

Result<void> decode_jpeg_rows(std::span<const std::byte> file, const ImageLimits& limits, RowSink& sink) {
    Decoder decoder;
    if (!decoder.read_header(file)) return decoder.error();
    const auto size = check_image_size(decoder.info.image_width, decoder.info.image_height, limits);
    if (!size) return tl::unexpected(size.error());
    const std::size_t pixels = std::size_t{decoder.info.image_width} * decoder.info.image_height;
    // Huffman coding spends at least one bit on each block of 64 pixels; less than that is refused before memory is taken.
    if (!decoder.info.arith_code && pixels / 512 > file.size())
        return fail(ErrorCode::bad_input, fmt::format("JPEG: {} bytes cannot hold {} pixels", file.size(), pixels));
    const std::size_t values = std::size_t{4} * decoder.info.image_width;
    std::vector<std::uint8_t> row(values), inks(decoder.info.num_components == 4 ? values : 0);
    decoder.keep_damaged = limits.keep_damaged;
    if (!decoder.read_pixels(row.data(), inks.data(), limits.max_jpeg_scans, sink)) return decoder.error();
    return {};
}

}  // namespace halflit::io::detail
