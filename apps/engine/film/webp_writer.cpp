// WebP with many frames, lossless, by libwebp's WebPAnimEncoder, which keeps of a frame only what differs from the one before.
#include "apps/engine/film/film_writer.hpp"

#include <algorithm>
#include <string>
#include <utility>

#if HALFLIT_HAS_WEBP_FILMS
#include <webp/encode.h>
#include <webp/mux.h>
#endif

namespace halflit::film {

#if HALFLIT_HAS_WEBP_FILMS
namespace {

class WebpWriter final : public FilmWriter {
public:
    explicit WebpWriter(const FilmSettings& settings) : settings_(settings) {
        WebPAnimEncoderOptions options;
        if (WebPAnimEncoderOptionsInit(&options) == 0 || WebPConfigInit(&config_) == 0) return;
        options.anim_params.loop_count = 0;  // for ever
        encoder_.reset(WebPAnimEncoderNew(settings.width, settings.height, &options));
        config_.lossless = 1;
        config_.exact = 1;  // keeps the colour of transparent pixels
        config_.quality = kEffort;
        config_.method = kMethod;
    }

    Result<void> add(const Image& frame) override {
        WebPPicture picture;
        if (!encoder_ || WebPPictureInit(&picture) == 0) return failed("");
        picture.width = settings_.width;
        picture.height = settings_.height;
        picture.use_argb = 1;
        const bool done = (settings_.opaque ? WebPPictureImportRGBX(&picture, frame.rgba8.data(), 4 * settings_.width)
                                            : WebPPictureImportRGBA(&picture, frame.rgba8.data(), 4 * settings_.width)) != 0 &&
                          WebPAnimEncoderAdd(encoder_.get(), &picture, static_cast<int>(start_ms_), &config_) != 0;
        WebPPictureFree(&picture);
        if (!done) return failed(WebPAnimEncoderGetError(encoder_.get()));
        start_ms_ += rounded_time(settings_.frame_time, added_++, 1000);
        return {};
    }

    Result<std::vector<std::uint8_t>> finish() override {
        WebPData data;
        WebPDataInit(&data);
        if (!encoder_ || WebPAnimEncoderAdd(encoder_.get(), nullptr, static_cast<int>(start_ms_), nullptr) == 0 ||
            WebPAnimEncoderAssemble(encoder_.get(), &data) == 0) {
            WebPDataClear(&data);
            return tl::unexpected(failed(encoder_ ? WebPAnimEncoderGetError(encoder_.get()) : "").error());
        }
        const std::unique_ptr<WebPData, Clear> owned(&data);
        return std::vector<std::uint8_t>(data.bytes, data.bytes + data.size);
    }

private:
    /// Effort of lossless compression: 75 and 4 are the library's usual ones, which take four times as long for files 3 % smaller.
    static constexpr float kEffort = 20;
    static constexpr int kMethod = 2;
    struct Delete {
        void operator()(WebPAnimEncoder* encoder) const { WebPAnimEncoderDelete(encoder); }
    };
    struct Clear {
        void operator()(WebPData* data) const { WebPDataClear(data); }
    };
    static Result<void> failed(const char* reason) {
        const std::string why = reason == nullptr ? "" : reason;
        return fail(ErrorCode::limit, "libwebp could not encode a frame: " + (why.empty() ? "out of memory" : why));
    }

    FilmSettings settings_;
    WebPConfig config_{};
    std::unique_ptr<WebPAnimEncoder, Delete> encoder_;
    std::int64_t start_ms_ = 0;
    std::size_t added_ = 0;
};

}  // namespace

bool has_webp() { return true; }

std::unique_ptr<FilmWriter> make_webp_writer(const FilmSettings& settings) { return std::make_unique<WebpWriter>(settings); }

#else

bool has_webp() { return false; }

std::unique_ptr<FilmWriter> make_webp_writer(const FilmSettings&) { return nullptr; }

#endif

}  // namespace halflit::film
