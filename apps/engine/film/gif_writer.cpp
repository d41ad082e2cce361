// GIF with many frames, by giflib. Each frame has a palette of its own.
#include "apps/engine/film/film_writer.hpp"
#include "apps/engine/film/gif_palette.hpp"

#include <algorithm>
#include <new>
#include <string>
#include <utility>

#if HALFLIT_HAS_GIF
#include <gif_lib.h>
#endif

namespace halflit::film {

#if HALFLIT_HAS_GIF
namespace {

class GifWriter final : public FilmWriter {
public:
    explicit GifWriter(const FilmSettings& settings) : settings_(settings) {
        int error = 0;
        gif_ = EGifOpen(this, &GifWriter::append, &error);
        if (gif_ == nullptr) return;
        EGifSetGifVersion(gif_, true);
        constexpr unsigned char kForEver[] = {1, 0, 0};
        good_ = EGifPutScreenDesc(gif_, settings.width, settings.height, 8, 0, nullptr) == GIF_OK &&
                EGifPutExtensionLeader(gif_, APPLICATION_EXT_FUNC_CODE) == GIF_OK &&
                EGifPutExtensionBlock(gif_, 11, "NETSCAPE2.0") == GIF_OK &&
                EGifPutExtensionBlock(gif_, sizeof kForEver, kForEver) == GIF_OK && EGifPutExtensionTrailer(gif_) == GIF_OK;
    }
    ~GifWriter() override { close(); }

    Result<void> add(const Image& frame) override {
        try {
            if (!good_ || gif_ == nullptr) return failed();
            PalettePicture picture = with_palette(frame, settings_.dither);
            good_ = put(picture);
            if (!good_) return failed();
            ++added_;
            return {};
        } catch (const std::bad_alloc&) {
            return failed();
        }
    }

    Result<std::vector<std::uint8_t>> finish() override {
        good_ = close() && good_;
        if (!good_) return tl::unexpected(failed().error());
        return std::move(file_);
    }

private:
    struct FreeMap {
        void operator()(ColorMapObject* map) const { GifFreeMapObject(map); }
    };

    static Result<void> failed() { return fail(ErrorCode::limit, "out of memory while encoding a frame"); }

    /// giflib's callback; an exception may not pass through it.
    static int append(GifFileType* gif, const GifByteType* bytes, int size) {
        auto& file = static_cast<GifWriter*>(gif->UserData)->file_;
        try {
            file.insert(file.end(), bytes, bytes + size);
        } catch (const std::bad_alloc&) {
            return 0;
        }
        return size;
    }

    bool close() {
        if (gif_ == nullptr) return false;
        int error = 0;
        return EGifCloseFile(std::exchange(gif_, nullptr), &error) == GIF_OK;
    }

    bool put(PalettePicture& picture) {
        int bits = 1;  // of a colour's number
        while ((std::size_t{1} << bits) < picture.colors.size()) ++bits;
        const std::unique_ptr<ColorMapObject, FreeMap> map(GifMakeMapObject(1 << bits, nullptr));
        if (!map) return false;
        for (std::size_t i = 0; i < picture.colors.size(); ++i)
            map->Colors[i] = {picture.colors[i][0], picture.colors[i][1], picture.colors[i][2]};

        const bool transparent = picture.transparent >= 0;
        GraphicsControlBlock control{};
        // Where nothing was drawn, the next frame must not show this one.
        control.DisposalMode = settings_.opaque ? DISPOSE_DO_NOT : DISPOSE_BACKGROUND;
        constexpr std::int64_t kMostDelay = 65535;
        control.DelayTime = static_cast<int>(std::min(rounded_time(settings_.frame_time, added_, 100), kMostDelay));
        control.TransparentColor = transparent ? picture.transparent : NO_TRANSPARENT_COLOR;
        GifByteType packed[4];
        const std::size_t size = EGifGCBToExtension(&control, packed);
        if (EGifPutExtension(gif_, GRAPHICS_EXT_FUNC_CODE, static_cast<int>(size), packed) != GIF_OK ||
            EGifPutImageDesc(gif_, 0, 0, settings_.width, settings_.height, false, map.get()) != GIF_OK)
            return false;
        const auto width = static_cast<std::size_t>(settings_.width);
        for (std::size_t y = 0; y < static_cast<std::size_t>(settings_.height); ++y)
            if (EGifPutLine(gif_, picture.pixels.data() + y * width, settings_.width) != GIF_OK) return false;
        return true;
    }

    FilmSettings settings_;
    GifFileType* gif_ = nullptr;
    std::vector<std::uint8_t> file_;
    std::size_t added_ = 0;
    bool good_ = false;
};

}  // namespace

bool has_gif() { return true; }

std::unique_ptr<FilmWriter> make_gif_writer(const FilmSettings& settings) { return std::make_unique<GifWriter>(settings); }

#else

bool has_gif() { return false; }

std::unique_ptr<FilmWriter> make_gif_writer(const FilmSettings&) { return nullptr; }

#endif

}  // namespace halflit::film
